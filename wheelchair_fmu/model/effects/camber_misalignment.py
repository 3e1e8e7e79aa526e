"""Rear wheels that lean: a camber angle of the right and of the left wheel, positive to the right."""

from typing import Any

import casadi as cs

from ...quantities import RAD, Parameter
from ..stage import Effect, adds

COMMON: dict[str, Any] = dict(off=0.0, smallest_interesting=0.005, lower=-0.3, upper=0.3, source="Doria, section 6.3")
RIGHT = Parameter(
    "phi_r", RAD, "camber angle φ_r of the right wheel, positive when it leans to the right", mirror="-phi_l", **COMMON
)
LEFT = Parameter(
    "phi_l", RAD, "camber angle φ_l of the left wheel, positive when it leans to the right", mirror="-phi_r", **COMMON
)

EFFECT = Effect(
    "camber_misalignment",
    "rear wheels that lean",
    parameters=(RIGHT, LEFT),
    contributions=(adds("phi", lambda phi_l, phi_r: cs.vertcat(phi_l, phi_r)),),
)
