"""Casters as in the paper to the letter: (9), (10) with small angles and forward motion only."""

from __future__ import annotations

from ...quantities import FRONT, N_M, RAD, N
from ..stage import Alternative, define, stage


@stage(
    define("delta", RAD, "caster angles", "-swap", FRONT),
    define("F_xf", N, "force of each caster on the chair along x_m", "+swap", FRONT),
    define("F_yf", N, "force of each caster on the chair along y_m", "-swap", FRONT),
    define("M_f", N_M, "moment of each caster's bearing on the chair", "-swap", FRONT),
)
def casters(v_xf, v_yf, D_f, d_f):
    delta = v_yf / v_xf  # (9), (10)
    drag = D_f + d_f * v_xf
    return delta, -drag, -drag * delta, 0 * D_f  # the drag terms of (20), (21)


LAW = Alternative("paper", (casters,))
