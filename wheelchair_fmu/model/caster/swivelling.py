"""Casters that swing: the contact patch, a trail behind the pivot, rolls without side slip.

With the trail c along the caster's heading δ, the patch has no sideways velocity when

    c δ' = v_y cos δ − v_x sin δ − c ψ'          (v_x, v_y of the pivot, as in (9), (10))

which tends to the ideal caster as c → 0 and swings round by itself when the chair backs up. The
kinematic trail is 1 mm here, so that this law alone changes nothing; the effect `caster_trail` adds
the real one. The moments about the pivot balance as in (8) with the swivel inertia left out: a
torque M_w of the bearing on the caster needs a lateral force M_w / c at the patch, c now the lever
`caster.trail`.
"""

from __future__ import annotations

import casadi as cs

from ...quantities import FRONT, M_S, N_M, RAD, RAD_S, M, N, Parameter, State
from ..chassis import per_wheel
from ..smooth import grip
from ..stage import Alternative, Row, define, stage
from . import ideal

SLOWEST = 1e-9  # m/s; a chair that starts at rest has its casters trailing

PARAMETERS = (
    *ideal.PARAMETERS,
    Parameter(
        "regularisation.trail",
        M,
        "kinematic trail of a caster without the effect caster_trail; shorter is too quick to matter and too stiff to solve",
        default=1e-3,
        lower=1e-4,
        upper=0.01,
        symbol="least_trail",
        source="chosen",
    ),
    Parameter(
        "regularisation.swivel_rate",
        RAD_S,
        "swivel rate within which dry friction builds up; sharper is truer and stiffer",
        default=0.02,
        lower=1e-6,
        upper=10.0,
        symbol="swivel_eps",
        source="chosen",
    ),
)

SWIVEL = State("swivel", RAD, "caster angles", mirror="-swap", components=FRONT, usual=0.1)


@stage(define("c", M, "trail that sets the caster's motion", "+swap", FRONT))
def kinematic_trail(least_trail):
    return per_wheel(least_trail)


@stage(
    define("swivel_slip", M_S, "sideways velocity the patch would have if the caster did not swivel", "-swap", FRONT),
    define("swivel_rate", RAD_S, "caster swivel rate δ'", "-swap", FRONT),
)
def swivelling(v_xf, v_yf, psi_dot, swivel, c):
    slip = v_yf * cs.cos(swivel) - v_xf * cs.sin(swivel) - c * psi_dot
    return slip, slip / c


@stage(define("delta", RAD, "caster angles", "-swap", FRONT))
def turned(swivel):
    return swivel


@stage(
    define("F_xf", N, "force of each caster on the chair along x_m", "+swap", FRONT),
    define("F_yf", N, "force of each caster on the chair along y_m", "-swap", FRONT),
    define("M_f", N_M, "moment of each caster's bearing on the chair", "-swap", FRONT),
)
def casters(delta, v_xf, v_yf, D_f, M_w, trail, drag_eps):
    """(6), (7) without the casters' mass: rolling resistance along the heading, M_w / c across it."""
    forward, right = cs.cos(delta), cs.sin(delta)
    rolling = v_xf * forward + v_yf * right
    drag = -D_f * grip(rolling, rolling * rolling, drag_eps)
    lateral = M_w / trail  # (8)
    return drag * forward - lateral * right, drag * right + lateral * forward, -M_w


LAW = Alternative(
    "swivelling",
    (kinematic_trail, swivelling, turned, ideal.bearing, casters),
    PARAMETERS,
    (
        Row(
            SWIVEL,
            mass=lambda c: c,
            rate=lambda swivel_slip: swivel_slip,
            start=lambda start_v, start_psi_dot, start_u, a: per_wheel(
                cs.atan2(start_v + a * start_psi_dot, start_u + SLOWEST)
            ),
        ),
    ),
)
