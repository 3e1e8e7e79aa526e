"""The contact patch, not the pivot, sets the caster's angle:  c δ' = v_y cos δ − v_x sin δ − c ψ'."""

from ...quantities import M, Parameter
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
    source="Doria, (8)",
)

EFFECT = Effect(
    "caster_trail",
    "casters whose contact patch sets their angle",
    parameters=(TRAIL,),
    contributions=(adds("c", lambda more_trail: more_trail),),
    needs={"caster": "swivelling"},
)
