"""An accelerometer with constant offsets."""

from typing import Any

from ...quantities import M_S2, Parameter
from ..alike import READING_OFFSET
from ..stage import Effect, adds

COMMON: dict[str, Any] = dict(off=0.0, smallest_interesting=0.03, lower=-5.0, upper=5.0, source="instrument")
X = Parameter("x", M_S2, "offset of the forward reading", symbol="bias_x", **COMMON)
Y = Parameter("y", M_S2, "offset of the reading to the right", symbol="bias_y", mirror="-", **COMMON)

EFFECT = Effect(
    "accelerometer_bias",
    "accelerometer with constant offsets",
    parameters=(X, Y),
    contributions=(adds("read_a_x", lambda bias_x: bias_x), adds("read_a_y", lambda bias_y: bias_y)),
    alike=(READING_OFFSET,),
)
