"""Rear wheels that do not point straight ahead: each wheel's frame is turned clockwise by its toe angle."""

from typing import Any

import casadi as cs

from ...quantities import RAD, Parameter
from ..stage import Effect, adds

COMMON: dict[str, Any] = dict(off=0.0, smallest_interesting=0.005, lower=-0.2, upper=0.2, source="VanderWiel2016")
RIGHT = Parameter(
    "tau_r", RAD, "toe angle τ_r of the right wheel, positive when it points to the right", mirror="-tau_l", **COMMON
)
LEFT = Parameter(
    "tau_l", RAD, "toe angle τ_l of the left wheel, positive when it points to the right", mirror="-tau_r", **COMMON
)


def turned(forward, right, tau):
    """What turning a vector's axes clockwise by τ adds to its components, along and across."""
    less = cs.cos(tau) - 1
    return less * forward + cs.sin(tau) * right, less * right - cs.sin(tau) * forward


def hub(v_xr, v_yr, tau_l, tau_r):
    """From the chair's axes into the wheel's, in which it rolls and slips."""
    return turned(v_xr, v_yr, cs.vertcat(tau_l, tau_r))


def force(F_w, F_s, tau_l, tau_r):
    """And back: side force points backward in part, drag like toe squared; traction and drag point aside in part."""
    return turned(F_w, F_s, -cs.vertcat(tau_l, tau_r))


EFFECT = Effect(
    "toe_misalignment",
    "rear wheels that do not point straight ahead",
    parameters=(RIGHT, LEFT),
    contributions=(
        adds("v_xw", lambda v_xr, v_yr, tau_l, tau_r: hub(v_xr, v_yr, tau_l, tau_r)[0]),
        adds("v_yw", lambda v_xr, v_yr, tau_l, tau_r: hub(v_xr, v_yr, tau_l, tau_r)[1]),
        adds("F_xr", lambda F_w, F_s, tau_l, tau_r: force(F_w, F_s, tau_l, tau_r)[0]),
        adds("F_yr", lambda F_w, F_s, tau_l, tau_r: force(F_w, F_s, tau_l, tau_r)[1]),
    ),
    even=True,
)
