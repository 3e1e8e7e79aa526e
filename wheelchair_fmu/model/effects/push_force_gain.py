"""Force sensors with a wrong scale: the record is (1 + r) or (1 + l) times the push that acts."""

from typing import Any

import casadi as cs

from ...quantities import ONE, Parameter
from ..stage import Effect, scales

COMMON: dict[str, Any] = dict(off=0.0, smallest_interesting=0.02, lower=-0.5, upper=1.0, source="instrument")
RIGHT = Parameter(
    "r",
    ONE,
    "scale error of the right force sensor: it reads (1 + r) times the push",
    symbol="gain_r",
    mirror="+gain_l",
    **COMMON,
)
LEFT = Parameter(
    "l",
    ONE,
    "scale error of the left force sensor: it reads (1 + l) times the push",
    symbol="gain_l",
    mirror="+gain_r",
    **COMMON,
)

EFFECT = Effect(
    "push_force_gain",
    "force sensors with a wrong scale",
    parameters=(RIGHT, LEFT),
    contributions=(scales("F_t", lambda gain_l, gain_r: 1 / cs.vertcat(1 + gain_l, 1 + gain_r)),),
)
