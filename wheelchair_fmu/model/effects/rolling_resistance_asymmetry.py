"""One rear wheel rolls harder than the other: D_rl − D_rr = D."""

import casadi as cs

from ...quantities import N, Parameter
from ..stage import Effect, adds

D = Parameter(
    "D",
    N,
    "rolling resistance of the left wheel less the right wheel's",
    off=0.0,
    smallest_interesting=0.4,
    lower=-50.0,
    upper=50.0,
    mirror="-",
    source="Sawatzky2005",
)

EFFECT = Effect(
    "rolling_resistance_asymmetry",
    "one rear wheel that rolls harder than the other",
    parameters=(D,),
    contributions=(adds("D_r", lambda D: cs.vertcat(D / 2, -D / 2)),),
)
