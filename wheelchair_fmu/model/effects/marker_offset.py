"""A marker tracked away from the CM: position and speed are those of its own point on the frame.

With the point x before and y to the right of the CM it is x cos ψ − y sin ψ and x sin ψ + y cos ψ away in the room, and moves
along the chair with u − y ψ' and v + x ψ'. Markers at the ends of the rear axle tell where its middle is, and not where the CM
is before it: x counts from there with `from_axle` = 1, and lies at x − b. Where y, or a speed, is read by an instrument of its
own, constants say how far that is from the marker.
"""

from typing import Any

from ...quantities import ONE, M, Parameter
from ..frames import to_room, velocity_at
from ..mounting import FARTHEST, apart
from ..signs import Shows
from ..sketch import Length, Spot, from_above
from ..stage import Effect, adds

COMMON: dict[str, Any] = dict(
    off=0.0, smallest_interesting=0.02, lower=-FARTHEST, upper=FARTHEST, source="rigid-body kinematics"
)
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


OWN = tuple(p for channel in ("y", "u", "v") for p in apart("marker", channel, "the marker"))


def ahead(point_x, from_axle, b):
    return point_x - from_axle * b


def read_x(point_x, point_y, from_axle, b, psi):
    return to_room(ahead(point_x, from_axle, b), point_y, psi)[0]


def read_y(point_x, point_y, from_axle, b, psi, marker_y_ahead, marker_y_right):
    return to_room(ahead(point_x, from_axle, b) + marker_y_ahead, point_y + marker_y_right, psi)[1]


def read_u(point_y, psi_dot, marker_u_right):
    return velocity_at(0, point_y + marker_u_right, 0, 0, psi_dot)[0]


def read_v(point_x, from_axle, b, psi_dot, marker_v_ahead):
    return velocity_at(ahead(point_x, from_axle, b) + marker_v_ahead, 0, 0, 0, psi_dot)[1]


EFFECT = Effect(
    "marker_offset",
    "a marker tracked away from the CM",
    parameters=(X, Y),
    constants=(FROM_AXLE, *OWN),
    contributions=(adds("read_x", read_x), adds("read_y", read_y), adds("read_u", read_u), adds("read_v", read_v)),
    signs=(Shows("coast-down", "sensor.x", more=True), Shows("coast-down", "sensor.y", more=True)),
    sketches=(from_above(Spot((0.19, 0.18)), Length((0, 0), (0, 0.18), "x"), Length((0, 0.18), (0.19, 0.18), "y")),),
)
