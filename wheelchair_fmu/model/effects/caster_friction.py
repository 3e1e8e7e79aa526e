"""Dry friction in the swivel bearings: M_w = −M sign(δ'), which builds up within a small swivel rate.

The bearing holds back a caster that its trail swings, and a lateral force at the patch, whose lever is that trail, holds it.
"""

from ...quantities import N_M, RAD_S, Parameter
from ..signs import Shows
from ..sketch import PIVOT_LEFT, PIVOT_RIGHT, Turn, Wheel, from_above
from ..smooth import grip
from ..stage import Effect, adds

FRICTION = Parameter(
    "M",
    N_M,
    "dry friction torque M of each caster's swivel bearing",
    off=0.0,
    smallest_interesting=0.05,
    lower=0.0,
    upper=5.0,
    symbol="M_s",
    source="chosen",
    dry=True,
)
RATE = Parameter(
    "rate",
    RAD_S,
    "swivel rate within which the friction builds up, which no two bearings do alike",
    default=0.02,
    lower=2e-3,
    upper=1.0,
    symbol="M_s_rate",
    source="chosen: balls and grease yield before they slip",
    known_to=0.03,
    dry=True,
)


def friction(M_s, swivel_rate, M_s_rate):
    return -M_s * grip(swivel_rate, swivel_rate * swivel_rate, M_s_rate)


EFFECT = Effect(
    "caster_friction",
    "dry friction in the casters' swivel bearings",
    parameters=(FRICTION,),
    constants=(RATE,),
    contributions=(adds("M_w", friction, opposes="swivel_rate"),),
    needs={"caster": "swivelling"},
    through=("caster_trail",),
    signs=(Shows("steady-turn", "chair.curvature", more=False),),
    sketches=(
        from_above(
            Wheel("fl", 25),
            Wheel("fr", 25),
            Turn(PIVOT_LEFT, "", clockwise=False),
            Turn(PIVOT_RIGHT, "M", clockwise=False),
            Turn((0, -0.05), "δ'", radius=0.07, moves=True),
        ),
    ),
)
