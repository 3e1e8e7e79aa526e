"""An accelerometer mounted askew: gravity leaks in, and its axes mix.

At rest it reads  g cos(roll) sin(pitch)  forward and  −g sin(roll)  to the right: positive roll lowers its right side,
positive pitch raises its front.
"""

from typing import Any

import casadi as cs

from ...quantities import RAD, Parameter
from ..alike import READING_OFFSET
from ..signs import Shows
from ..sketch import Spot, Turn, from_behind, from_the_side
from ..stage import Effect, adds

COMMON: dict[str, Any] = dict(off=0.0, smallest_interesting=0.005, lower=-0.5, upper=0.5, source="rigid-body kinematics")
ROLL = Parameter("roll", RAD, "roll of the sensor, positive with its right side down", mirror="-", **COMMON)
PITCH = Parameter("pitch", RAD, "pitch of the sensor, positive with its front up", **COMMON)


def forward(roll, pitch, a_x, a_y, g_x, g_y, g_z):
    f_x, f_y = a_x - g_x, a_y - g_y
    return f_x * (cs.cos(pitch) - 1) + (f_y * cs.sin(roll) + g_z * cs.cos(roll)) * cs.sin(pitch)


def right(roll, a_y, g_y, g_z):
    return (a_y - g_y) * (cs.cos(roll) - 1) - g_z * cs.sin(roll)


EFFECT = Effect(
    "accelerometer_tilt",
    "accelerometer mounted askew",
    parameters=(ROLL, PITCH),
    contributions=(adds("read_a_x", forward), adds("read_a_y", right)),
    alike=(READING_OFFSET,),
    signs=(Shows("coast-down", "sensor.a_y", more=False), Shows("coast-down", "sensor.a_x", more=True)),
    sketches=(
        from_behind(Spot((0, 0.7), box=True, turned=15), Turn((0, 0.7), "roll"), of="roll"),
        from_the_side(Spot((0, 0.7), box=True, turned=-15), Turn((0, 0.7), "pitch", clockwise=False), of="pitch"),
    ),
)
