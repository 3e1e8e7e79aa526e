"""A marker tracked away from the CM: position and speed are those of its own point on the frame.

With the point x before and y to the right of the CM it is x cos ψ − y sin ψ and x sin ψ + y cos ψ away in the room, and moves
along the chair with u − y ψ' and v + x ψ'. Markers at the ends of the rear axle tell where its middle is, and not where the CM
is before it: x counts from there with `from_axle` = 1, and lies at x − b.
"""

from typing import Any

from ...quantities import ONE, M, Parameter
from ..frames import to_room, velocity_at
from ..signs import Shows
from ..sketch import Length, Spot, from_above
from ..stage import Effect, adds

COMMON: dict[str, Any] = dict(off=0.0, smallest_interesting=0.02, lower=-2.0, upper=2.0, source="rigid-body kinematics")
X = Parameter("x", M, "how far the marker lies before the CM", symbol="point_x", **COMMON)
Y = Parameter("y", M, "how far the marker lies to the right of the CM", symbol="point_y", mirror="-", **COMMON)
FROM_AXLE = Parameter(
    "from_axle",
    ONE,
    "from where x counts: 0, from the CM; 1, from the middle of the rear axle, b behind it",
    default=0.0,
    lower=0.0,
    upper=1.0,
    source="rigid-body kinematics",
)


def ahead(point_x, from_axle, b):
    return point_x - from_axle * b


def place(point_x, point_y, from_axle, b, psi):
    return to_room(ahead(point_x, from_axle, b), point_y, psi)


def speed(point_x, point_y, from_axle, b, psi_dot):
    return velocity_at(ahead(point_x, from_axle, b), point_y, 0, 0, psi_dot)


EFFECT = Effect(
    "marker_offset",
    "a marker tracked away from the CM",
    parameters=(X, Y),
    constants=(FROM_AXLE,),
    contributions=(
        adds("read_x", lambda point_x, point_y, from_axle, b, psi: place(point_x, point_y, from_axle, b, psi)[0]),
        adds("read_y", lambda point_x, point_y, from_axle, b, psi: place(point_x, point_y, from_axle, b, psi)[1]),
        adds("read_u", lambda point_x, point_y, from_axle, b, psi_dot: speed(point_x, point_y, from_axle, b, psi_dot)[0]),
        adds("read_v", lambda point_x, point_y, from_axle, b, psi_dot: speed(point_x, point_y, from_axle, b, psi_dot)[1]),
    ),
    signs=(Shows("coast-down", "sensor.x", more=True), Shows("coast-down", "sensor.y", more=True)),
    sketches=(from_above(Spot((0.19, 0.18)), Length((0, 0), (0, 0.18), "x"), Length((0, 0.18), (0.19, 0.18), "y")),),
)
