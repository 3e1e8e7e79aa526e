"""The lateral force bends over: the Magic Formula law's own 1/μ, which is zero in the linear law."""

from ...quantities import ONE, Parameter
from ..stage import Effect, adds

INV_MU = Parameter(
    "inv_mu",
    ONE,
    "inverse friction coefficient 1/μ of the lateral force",
    off=0.0,
    smallest_interesting=0.8,
    lower=0.0,
    upper=20.0,
    symbol="more_inv_mu",
    source="Doria, (1)",
)

EFFECT = Effect(
    "tyre_saturation",
    "lateral tyre force that bends over",
    parameters=(INV_MU,),
    contributions=(adds("inv_mu", lambda more_inv_mu: more_inv_mu),),
    even=True,
)
