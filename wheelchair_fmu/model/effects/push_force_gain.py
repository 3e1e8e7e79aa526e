"""Force sensors with a wrong scale: each record is (1 + its error) times the push that acts.

The mean of both errors is a wrong scale of what drives the chair, the difference turns it when the hands push alike.
"""

from typing import Any

from ...quantities import ONE, Parameter
from ..alike import WHOLE_SCALE
from ..sides import difference_of, mean_of, of_mean
from ..signs import Shows
from ..sketch import REAR_LEFT, REAR_RIGHT, Arrow, Curve, Wheel, from_above, graph
from ..stage import Effect, scales

COMMON: dict[str, Any] = dict(off=0.0, smallest_interesting=0.02, source="instrument")
FORMER = ("r", "l")
MEAN = Parameter(
    "mean",
    ONE,
    "mean scale error of both force sensors, positive when they read too much",
    symbol="gain_mean",
    mirror="+",
    lower=-0.5,
    upper=1.0,
    formerly=mean_of(*FORMER),
    **COMMON,
)
DIFFERENCE = Parameter(
    "difference",
    ONE,
    "scale error of the right force sensor less the left one's, positive when the right one reads more",
    symbol="gain_difference",
    mirror="-",
    lower=-0.9,
    upper=0.9,
    formerly=difference_of(*FORMER),
    **COMMON,
)

EFFECT = Effect(
    "push_force_gain",
    "force sensors with a wrong scale",
    parameters=(MEAN, DIFFERENCE),
    contributions=(scales("F_t", lambda gain_mean, gain_difference: 1 / (1 + of_mean(gain_mean, gain_difference))),),
    alike=(WHOLE_SCALE,),
    signs=(Shows("start-stop", "chair.u", more=False), Shows("start-stop", "chair.psi", more=True)),
    sketches=(
        graph(
            "push that acts",
            "recorded push",
            Curve(lambda x: 0.7 * x, "", before=True),
            Curve(lambda x: 0.95 * x, "mean above 0"),
            of="mean",
        ),
        from_above(
            Wheel("rl"),
            Wheel("rr"),
            Arrow(REAR_LEFT, (-0.275, 0.02), "record"),
            Arrow(REAR_RIGHT, (0.275, 0.14), "record"),
            of="difference",
        ),
    ),
)
