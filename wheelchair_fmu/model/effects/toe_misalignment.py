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


def slip(tau_l, tau_r, s):
    return s * cs.vertcat(tau_l, tau_r)


def backward(tau_l, tau_r, F_s):
    """The lateral force stands across the wheel, so part of it points backward: drag like toe squared."""
    return -F_s * cs.sin(cs.vertcat(tau_l, tau_r))


EFFECT = Effect(
    "toe_misalignment",
    "rear wheels that do not point straight ahead",
    parameters=(RIGHT, LEFT),
    contributions=(adds("lam", slip), adds("F_xr", backward)),
    even=True,
)
