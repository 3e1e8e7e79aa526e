"""The recorded pushes come late or early against the other instruments. It shifts the record, not the chair.

The push that acts at the time t is the one that was recorded at  t − τ.
"""

from math import pi, sin

from ...quantities import Parameter, S
from ..signs import Shows
from ..sketch import Curve, graph
from ..stage import Effect

TAU = Parameter(
    "tau",
    S,
    "how much earlier the record is than the push that acts",
    off=0.0,
    smallest_interesting=0.01,
    lower=-1.0,
    upper=1.0,
    source="instrument",
)


def _stroke(t: float) -> float:
    return 0.8 * sin(pi * t / 0.55) if 0 < t < 0.55 else 0.0


EFFECT = Effect(
    "push_force_delay",
    "recorded pushes that are early or late",
    parameters=(TAU,),
    delays_record=True,
    signs=(Shows("start-stop", "chair.u", more=False, seconds=1.0),),
    sketches=(
        graph(
            "time",
            "push",
            Curve(lambda x: _stroke(x - 0.1), "", before=True),
            Curve(lambda x: _stroke(x - 0.3), "acts later by τ"),
        ),
    ),
)
