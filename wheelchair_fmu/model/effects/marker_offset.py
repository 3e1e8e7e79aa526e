"""A marker tracked away from the CM: position and speed are those of its own point on the frame.

With the point x before and y to the right of the CM it is x cos ψ − y sin ψ and x sin ψ + y cos ψ away in the room, and moves
along the chair with u − y ψ' and v + x ψ'.
"""

from typing import Any

from ...quantities import M, Parameter
from ..frames import to_room, velocity_at
from ..signs import Shows
from ..sketch import Length, Spot, from_above
from ..stage import Effect, adds

COMMON: dict[str, Any] = dict(off=0.0, smallest_interesting=0.01, lower=-2.0, upper=2.0, source="rigid-body kinematics")
X = Parameter("x", M, "how far the marker lies before the CM", symbol="point_x", **COMMON)
Y = Parameter("y", M, "how far the marker lies to the right of the CM", symbol="point_y", mirror="-", **COMMON)

EFFECT = Effect(
    "marker_offset",
    "a marker tracked away from the CM",
    parameters=(X, Y),
    contributions=(
        adds("read_x", lambda point_x, point_y, psi: to_room(point_x, point_y, psi)[0]),
        adds("read_y", lambda point_x, point_y, psi: to_room(point_x, point_y, psi)[1]),
        adds("read_u", lambda point_x, point_y, psi_dot: velocity_at(point_x, point_y, 0, 0, psi_dot)[0]),
        adds("read_v", lambda point_x, point_y, psi_dot: velocity_at(point_x, point_y, 0, 0, psi_dot)[1]),
    ),
    signs=(Shows("coast-down", "sensor.x", more=True), Shows("coast-down", "sensor.y", more=True)),
    sketches=(from_above(Spot((0.19, 0.18)), Length((0, 0), (0, 0.18), "x"), Length((0, 0.18), (0.19, 0.18), "y")),),
)
