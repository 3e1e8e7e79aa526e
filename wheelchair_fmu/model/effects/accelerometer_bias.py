"""An accelerometer with constant offsets: it reads a_x + x and a_y + y."""

from typing import Any

from ...quantities import M_S2, Parameter
from ..alike import READING_OFFSET
from ..signs import Shows
from ..sketch import Arrow, Spot, from_above
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
    signs=(Shows("coast-down", "sensor.a_x", more=True), Shows("coast-down", "sensor.a_y", more=True)),
    sketches=(from_above(Spot((0, 0), box=True), Arrow((0, 0), (0, 0.2), "x"), Arrow((0, 0), (0.2, 0), "y")),),
)
