"""Wheel speed sensors with a wrong radius: each reads (1 + its error) times the speed.

The mean of both errors is a wrong scale of the chair's speed, the difference a yaw rate that is not there.
"""

from typing import Any

from ...quantities import ONE, Parameter
from ..sides import difference_of, mean_of, of_mean
from ..signs import Shows
from ..sketch import REAR_LEFT, REAR_RIGHT, Arrow, Length, Turn, Wheel, from_above, from_the_side
from ..stage import Effect, scales

COMMON: dict[str, Any] = dict(off=0.0, smallest_interesting=0.01, source="instrument")
FORMER = ("r", "l")
MEAN = Parameter(
    "mean",
    ONE,
    "mean scale error of both wheel speeds, positive when they read too much",
    symbol="scale_mean",
    mirror="+",
    lower=-0.5,
    upper=1.0,
    formerly=mean_of(*FORMER),
    **COMMON,
)
DIFFERENCE = Parameter(
    "difference",
    ONE,
    "scale error of the right wheel speed less the left one's, positive when the right one reads more",
    symbol="scale_difference",
    mirror="-",
    lower=-0.9,
    upper=0.9,
    formerly=difference_of(*FORMER),
    **COMMON,
)

EFFECT = Effect(
    "wheel_radius_error",
    "wheel speed sensors with a wrong radius",
    parameters=(MEAN, DIFFERENCE),
    contributions=(scales("read_wheel_speed", lambda scale_mean, scale_difference: 1 + of_mean(scale_mean, scale_difference)),),
    signs=(Shows("coast-down", "sensor.wheel_speed_r", more=True), Shows("coast-down", "sensor.wheel_speed_r", more=True)),
    sketches=(
        from_the_side(
            Wheel("rear"), Length((-0.2, 0.31), (-0.2, 0), "R"), Turn((-0.2, 0.31), "reads more", radius=0.13), of="mean"
        ),
        from_above(
            Wheel("rl"),
            Wheel("rr"),
            Arrow(REAR_LEFT, (-0.275, 0.02), "reads"),
            Arrow(REAR_RIGHT, (0.275, 0.14), "reads"),
            of="difference",
        ),
    ),
)
