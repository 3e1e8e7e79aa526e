"""The lateral force bends over: the Magic Formula law's own 1/μ, which is zero in the linear law:  D = μ N  in (1).

The linear law's self-aligning torque bends over with it, as the force stays as far behind the hub.
"""

from math import atan, sin

from ...quantities import ONE, Parameter
from ..signs import Shows
from ..sketch import Curve, graph
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
    signs=(Shows("steady-turn", "slip.rr", more=True),),
    sketches=(
        graph(
            "slip angle λ",
            "side force",
            Curve(lambda x: 0.95 * x, "", before=True),
            Curve(lambda x: 0.62 * sin(1.3 * atan(1.18 * x)), "at most μN"),
        ),
    ),
)
