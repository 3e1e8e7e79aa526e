"""Dry friction in the swivel bearings: M_w = −M sign(δ'), smooth within a small swivel rate.

The bearing holds back a caster that its trail swings, and a lateral force at the patch, whose lever is that trail, holds it.
"""

from ...quantities import N_M, Parameter
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
)


def friction(M_s, swivel_rate, swivel_eps):
    return -M_s * grip(swivel_rate, swivel_rate * swivel_rate, swivel_eps)


EFFECT = Effect(
    "caster_friction",
    "dry friction in the casters' swivel bearings",
    parameters=(FRICTION,),
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
