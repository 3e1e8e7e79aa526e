"""The contact patch, not the pivot, sets the caster's angle:  c δ' = v_y cos δ − v_x sin δ − c ψ'."""

from ...quantities import M, Parameter
from ..signs import Shows
from ..sketch import Length, Spot, Wheel, from_the_side
from ..stage import Effect, adds

TRAIL = Parameter(
    "c",
    M,
    "caster trail c, from the pivot back to the contact patch",
    off=0.0,
    smallest_interesting=0.03,
    lower=0.0,
    upper=0.3,
    symbol="more_trail",
    known_to=0.005,
    source="Doria, (8)",
)

EFFECT = Effect(
    "caster_trail",
    "casters whose contact patch sets their angle",
    parameters=(TRAIL,),
    contributions=(adds("c", lambda more_trail: more_trail),),
    needs={"caster": "swivelling"},
    signs=(Shows("steady-turn", "chair.curvature", more=True),),
    sketches=(from_the_side(Wheel("front"), Spot((0.25, 0.3), "pivot"), Length((0.25, -0.08), (0.2, -0.08), "c")),),
)
