"""Casters as in the paper to the letter: (9), (10) with small angles and forward motion only; (8) for what effects add."""

from __future__ import annotations

from ...quantities import FRONT, M_S, N_M, RAD, RAD_S, N
from ..chassis import per_wheel
from ..stage import Alternative, define, stage
from . import ideal


@stage(
    define("turning", RAD_S, "rate at which each caster's patch turns on the floor", "-swap", FRONT),
    define("rolling", M_S, "speed at which each caster rolls along its heading", "+swap", FRONT),
)
def patches(v_xf, psi_dot):
    """As in a steady turn."""
    return per_wheel(psi_dot), v_xf


@stage(
    define("delta", RAD, "caster angles", "-swap", FRONT),
    define("F_xf", N, "force of each caster on the chair along x_m", "+swap", FRONT),
    define("F_yf", N, "force of each caster on the chair along y_m", "-swap", FRONT),
    define("M_f", N_M, "moment of each caster's bearing on the chair", "-swap", FRONT),
)
def casters(v_xf, v_yf, D_f, d_f, M_w, M_p, trail):
    delta = v_yf / v_xf  # (9), (10)
    drag = D_f + d_f * v_xf
    lateral = (M_w + M_p) / trail  # (8)
    return delta, -drag - lateral * delta, -drag * delta + lateral, -M_w  # the drag terms of (20), (21)


LAW = Alternative("paper", (patches, ideal.torques, casters))
