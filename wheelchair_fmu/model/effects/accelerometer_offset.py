"""An accelerometer mounted away from the CM: it also feels the turn about it.

It reads  a_x − x ψ'² − y ψ''  and  a_y + x ψ'' − y ψ'². Where a_y is read by an instrument of its own, constants say how far
that is from the other.
"""

from typing import Any

from ...quantities import M, Parameter
from ..mounting import FARTHEST, apart
from ..signs import Shows
from ..sketch import Length, Spot, from_above
from ..stage import Effect, adds

COMMON: dict[str, Any] = dict(
    off=0.0, smallest_interesting=0.03, lower=-FARTHEST, upper=FARTHEST, source="rigid-body kinematics"
)
X = Parameter("x", M, "how far the sensor lies before the CM", symbol="lever_x", **COMMON)
Y = Parameter("y", M, "how far the sensor lies to the right of the CM", symbol="lever_y", mirror="-", **COMMON)


def forward(lever_x, lever_y, psi_dot, M_z, inertia):
    return -lever_x * psi_dot * psi_dot - lever_y * M_z / inertia


def right(lever_x, lever_y, psi_dot, M_z, inertia, lever_a_y_ahead, lever_a_y_right):
    return (lever_x + lever_a_y_ahead) * M_z / inertia - (lever_y + lever_a_y_right) * psi_dot * psi_dot


EFFECT = Effect(
    "accelerometer_offset",
    "accelerometer mounted away from the CM",
    parameters=(X, Y),
    constants=apart("lever", "a_y", "the accelerometer"),
    contributions=(adds("read_a_x", forward), adds("read_a_y", right)),
    signs=(Shows("steady-turn", "sensor.a_x", more=False), Shows("steady-turn", "sensor.a_y", more=False)),
    sketches=(from_above(Spot((0.19, 0.18), box=True), Length((0, 0), (0, 0.18), "x"), Length((0, 0.18), (0.19, 0.18), "y")),),
)
