"""A yaw rate sensor with an offset: it reads ψ' + b."""

from ...quantities import RAD_S, Parameter
from ..signs import Shows
from ..sketch import Spot, Turn, from_above
from ..stage import Effect, adds

B = Parameter(
    "b",
    RAD_S,
    "offset of the yaw rate sensor, clockwise",
    off=0.0,
    smallest_interesting=0.003,
    lower=-1.0,
    upper=1.0,
    mirror="-",
    symbol="gyro_b",
    source="instrument",
)

EFFECT = Effect(
    "gyro_bias",
    "yaw rate sensor with an offset",
    parameters=(B,),
    contributions=(adds("read_yaw_rate", lambda gyro_b: gyro_b),),
    signs=(Shows("coast-down", "sensor.yaw_rate", more=True),),
    sketches=(from_above(Spot((0, 0), box=True), Turn((0, 0), "reads b more", radius=0.13)),),
)
