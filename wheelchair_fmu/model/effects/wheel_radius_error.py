"""Wheel speed sensors with a wrong radius: they read (1 + r) or (1 + l) times the speed."""

from typing import Any

import casadi as cs

from ...quantities import ONE, Parameter
from ..stage import Effect, scales

COMMON: dict[str, Any] = dict(off=0.0, smallest_interesting=0.01, lower=-0.5, upper=1.0, source="instrument")
RIGHT = Parameter(
    "r",
    ONE,
    "scale error of the right wheel speed: it reads (1 + r) times the speed",
    symbol="scale_r",
    mirror="+scale_l",
    **COMMON,
)
LEFT = Parameter(
    "l",
    ONE,
    "scale error of the left wheel speed: it reads (1 + l) times the speed",
    symbol="scale_l",
    mirror="+scale_r",
    **COMMON,
)

EFFECT = Effect(
    "wheel_radius_error",
    "wheel speed sensors with a wrong radius",
    parameters=(RIGHT, LEFT),
    contributions=(scales("read_wheel_speed", lambda scale_l, scale_r: cs.vertcat(1 + scale_l, 1 + scale_r)),),
)
