"""Casters without mass, friction or trail: each trails its pivot at once, as (8) argues.

Extends (9), (10) to any motion: the drag opposes the pivot's velocity, whatever its direction.
"""

from __future__ import annotations

import casadi as cs

from ...quantities import FRONT, N_M, RAD, N
from ..smooth import grip
from ..stage import Alternative, define, stage


@stage(
    define("delta", RAD, "caster angles", "-swap", FRONT),
    define("F_xf", N, "force of each caster on the chair along x_m", "+swap", FRONT),
    define("F_yf", N, "force of each caster on the chair along y_m", "-swap", FRONT),
    define("M_f", N_M, "moment of each caster's bearing on the chair", "-swap", FRONT),
)
def casters(v_xf, v_yf, D_f, drag_eps):
    tiny = 1e-6 * drag_eps  # keeps the angle's slope finite at rest
    delta = cs.atan2(v_yf, v_xf + tiny)  # (9), (10)
    speed_squared = v_xf * v_xf + v_yf * v_yf
    F_xf, F_yf = -D_f * grip(v_xf, speed_squared, drag_eps), -D_f * grip(v_yf, speed_squared, drag_eps)
    return delta, F_xf, F_yf, 0 * D_f


LAW = Alternative("ideal", (casters,))
