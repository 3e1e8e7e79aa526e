"""Casters without mass, friction or trail: each trails its pivot at once, as (8) argues.

Extends (9), (10) to any motion: the drag opposes the pivot's velocity, whatever its direction.
"""

from __future__ import annotations

import casadi as cs

from ...quantities import FRONT, M_S, N_M, RAD, RAD_S, M, N, Parameter
from ..chassis import per_wheel
from ..smooth import speed
from ..stage import Alternative, define, stage

PARAMETERS = (
    Parameter(
        "caster.trail",
        M,
        "caster trail c in (8): the lever between a torque on the caster and its lateral force, unless caster_trail tells the "
        "real one",
        default=0.05,
        lower=1e-3,
        upper=0.5,
        source="chosen: common casters, 30 to 60 mm",
    ),
)


@stage(define("delta", RAD, "caster angles", "-swap", FRONT))
def angles(v_xf, v_yf, drag_eps):
    tiny = 1e-6 * drag_eps  # keeps the angle's slope finite at rest
    return cs.atan2(v_yf, v_xf + tiny)  # (9), (10)


@stage(
    define("turning", RAD_S, "rate at which each caster's patch turns on the floor", "-swap", FRONT),
    define("rolling", M_S, "speed at which each caster rolls along its heading", "+swap", FRONT),
)
def patches(v_xf, v_yf, psi_dot, drag_eps):
    """As in a steady turn: an ideal caster's angle jumps with its pivot's velocity and has no rate."""
    return per_wheel(psi_dot), cs.sqrt(v_xf * v_xf + v_yf * v_yf + drag_eps * drag_eps)


@stage(
    define("M_w", N_M, "torque of the bearing on each caster", "-swap", FRONT),
    define("M_p", N_M, "torque on each caster that its bearing does not feel", "-swap", FRONT),
)
def torques():
    """None: a caster without friction or inertia."""
    return per_wheel(0.0), per_wheel(0.0)


@stage(
    define("F_xf", N, "force of each caster on the chair along x_m", "+swap", FRONT),
    define("F_yf", N, "force of each caster on the chair along y_m", "-swap", FRONT),
    define("M_f", N_M, "moment of each caster's bearing on the chair", "-swap", FRONT),
)
def casters(v_xf, v_yf, D_f, d_f, M_w, M_p, rolling, trail, drag_eps, v_onset):
    """Rolling resistance against the pivot's velocity, torque / c across it."""
    speed_squared = v_xf * v_xf + v_yf * v_yf
    drag = D_f / speed(speed_squared, drag_eps + v_onset) + d_f  # per speed
    lateral = (M_w + M_p) / trail / rolling  # (8)
    return -drag * v_xf - lateral * v_yf, -drag * v_yf + lateral * v_xf, -M_w


LAW = Alternative("ideal", (angles, patches, torques, casters), PARAMETERS)
