"""A slope fixed in the room, of the angles x and y:  m g sin x  pulls along the room's x,  m g sin y  along its y."""

from typing import Any

from ...quantities import RAD, Parameter
from ..signs import Shows
from ..sketch import Arrow, from_behind, from_the_side
from ..stage import Effect, adds

COMMON: dict[str, Any] = dict(off=0.0, smallest_interesting=0.001, lower=-0.3, upper=0.3, source="Richter2007")
X = Parameter("x", RAD, "slope along the room's x, positive where the floor falls towards +x", symbol="tilt_x", **COMMON)
Y = Parameter(
    "y", RAD, "slope along the room's y, positive where the floor falls towards +y", symbol="tilt_y", mirror="-", **COMMON
)

EFFECT = Effect(
    "floor_slope",
    "a slope of the floor, fixed in the room",
    parameters=(X, Y),
    contributions=(adds("fall_x", lambda tilt_x: tilt_x), adds("fall_y", lambda tilt_y: tilt_y)),
    signs=(Shows("coast-down", "chair.u", more=True), Shows("coast-down", "chair.y", more=True)),
    sketches=(
        from_the_side(Arrow((0, 0.6), (0.3, 0.6), "x"), tilt=7, of="x"),
        from_behind(Arrow((0, 0.6), (0.24, 0.6), "y"), tilt=7, of="y"),
    ),
)
