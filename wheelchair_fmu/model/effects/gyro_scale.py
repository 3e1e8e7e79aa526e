"""A yaw rate sensor with a wrong scale: it reads (1 + k) ψ'."""

from ...quantities import ONE, Parameter
from ..signs import Shows
from ..sketch import Curve, graph
from ..stage import Effect, scales

K = Parameter(
    "k",
    ONE,
    "scale error of the yaw rate sensor: it reads (1 + k) ψ'",
    off=0.0,
    smallest_interesting=0.01,
    lower=-0.5,
    upper=1.0,
    symbol="scale",
    source="instrument",
)

EFFECT = Effect(
    "gyro_scale",
    "yaw rate sensor with a wrong scale",
    parameters=(K,),
    contributions=(scales("read_yaw_rate", lambda scale: 1 + scale),),
    signs=(Shows("steady-turn", "sensor.yaw_rate", more=True),),
    sketches=(
        graph("yaw rate", "reading", Curve(lambda x: 0.7 * x, "ψ'", before=True), Curve(lambda x: 0.95 * x, "(1 + k) ψ'")),
    ),
)
