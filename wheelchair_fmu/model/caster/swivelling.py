"""Casters that swing: the contact patch, a trail behind the pivot, rolls without side slip.

With the trail c along the caster's heading δ, the patch has no sideways velocity when

    c δ' = v_y cos δ − v_x sin δ − c ψ'          (v_x, v_y of the pivot, as in (9), (10))

which tends to the ideal caster as c → 0 and swings round by itself when the chair backs up. The
trail is 1 mm here, so that this law alone changes nothing; the effect `caster_trail` adds the real
one. The moments about the pivot balance as in (8) with the swivel inertia left out: a torque on the
caster needs a lateral force at the patch, whose lever is that same c. With another lever the bearing
would make energy.

A torque M_w over 1 mm would be an absurd force. That trail stands for a caster that is ideal but for
this torque, and so passes on c / `caster.trail` of it: its lateral force is M_w / `caster.trail`, that of
the real lever, and still no energy is made. From 20 mm on, which is about the shortest that casters
have, c is a real trail and the lever itself; between the two, the lever goes over from one to the other.
"""

from __future__ import annotations

import casadi as cs

from ...quantities import FRONT, M_S, N_M, RAD, RAD_S, M, N, Parameter, State
from ..chassis import per_wheel
from ..smooth import speed
from ..stage import Alternative, Row, define, stage
from . import ideal

SLOW = 0.05  # m/s of a pivot, above which its caster trails it as a chair starts
SHORTEST = 20  # least trails, that casters have in their shortest one
ASIDE = 1e-3  # rad by which casters stand apart at rest, so that none is in line with its way exactly

PARAMETERS: tuple[Parameter, ...] = (
    *ideal.PARAMETERS,
    Parameter(
        "regularisation.trail",
        M,
        "trail of a caster without the effect caster_trail; shorter is too quick to matter and too stiff to solve",
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

STARTS = tuple(
    Parameter(
        f"start.caster_{side}",
        RAD,
        f"how far the {word} caster is turned at the start from trailing its pivot, or from straight behind where that rests",
        mirror=f"-start_caster_{other}",
        lower=-3.2,
        upper=3.2,
        fixed=True,
        symbol=f"start_caster_{side}",
        source="as it was left",
    )
    for side, other, word in (("l", "r", "left"), ("r", "l", "right"))
)
PARAMETERS = (*PARAMETERS, *STARTS)

SWIVEL = State("swivel", RAD, "caster angles", mirror="-swap", components=FRONT, usual=0.1)


@stage(define("c", M, "caster trail, by which it swings", "+swap", FRONT))
def kinematic_trail(least_trail):
    return per_wheel(least_trail)


@stage(define("lever", M, "lever between a torque on each caster and its lateral force", "+swap", FRONT))
def leverage(c, trail, least_trail):
    """`caster.trail` at the least trail, c from the shortest real one on."""
    real = (c - least_trail) / ((SHORTEST - 1) * least_trail)  # 0 at the least trail, 1 at the shortest real one
    return cs.fmax(c, trail + (SHORTEST * least_trail - trail) * real)


@stage(
    define("swivel_slip", M_S, "sideways velocity the patch would have if the caster did not swivel", "-swap", FRONT),
    define("swivel_rate", RAD_S, "caster swivel rate δ'", "-swap", FRONT),
)
def swivelling(v_xf, v_yf, psi_dot, swivel, c):
    slip = v_yf * cs.cos(swivel) - v_xf * cs.sin(swivel) - c * psi_dot
    return slip, slip / c


@stage(
    define("turning", RAD_S, "rate at which each caster's patch turns on the floor", "-swap", FRONT),
    define("rolling", M_S, "speed at which each caster rolls along its heading", "+swap", FRONT),
)
def patches(v_xf, v_yf, psi_dot, swivel, swivel_rate):
    return psi_dot + swivel_rate, v_xf * cs.cos(swivel) + v_yf * cs.sin(swivel)


@stage(define("delta", RAD, "caster angles", "-swap", FRONT))
def turned(swivel):
    return swivel


@stage(
    define("F_xf", N, "force of each caster on the chair along x_m", "+swap", FRONT),
    define("F_yf", N, "force of each caster on the chair along y_m", "-swap", FRONT),
    define("M_f", N_M, "moment of each caster's bearing on the chair", "-swap", FRONT),
)
def casters(delta, rolling, D_f, d_f, M_w, M_p, c, lever, drag_eps, v_onset):
    """(6), (7) without the casters' mass: rolling resistance along the heading, torque / lever across it."""
    forward, right = cs.cos(delta), cs.sin(delta)
    drag = -(D_f / speed(rolling * rolling, drag_eps + v_onset) + d_f) * rolling
    lateral = (M_w + M_p) / lever  # (8)
    return drag * forward - lateral * right, drag * right + lateral * forward, -(c / lever) * M_w


def trailing(v_xf, v_yf, start_caster_l, start_caster_r):
    """Each caster trails its pivot at the start, whatever the speed is that holds; a chair at rest has it straight behind.

    A speed that is hardly any, as of a start that is known to a few centimetres per second, does not turn it. A caster
    exactly in line would stay so when the chair backs up straight, as a pencil on its tip. So at rest they stand apart by a
    thousandth, the left caster to the left as its mirror image to the right. To that comes how somebody left them.
    """
    share = (v_xf * v_xf + v_yf * v_yf) / (SLOW * SLOW)
    rests = 1 / (1 + share * share)
    aside = v_yf * (1 - rests) + SLOW * ASIDE * rests * cs.DM([-1.0, 1.0])
    return cs.atan2(aside, v_xf * (1 - rests) + SLOW * rests) + cs.vertcat(start_caster_l, start_caster_r)


LAW = Alternative(
    "swivelling",
    (kinematic_trail, leverage, swivelling, patches, turned, ideal.torques, casters),
    PARAMETERS,
    (Row(SWIVEL, mass=lambda c: c, rate=lambda swivel_slip: swivel_slip, start=trailing),),
)
