"""One rear wheel rolls harder than the other: D_rl − D_rr = D.

Their sum stays what it was while both have some drag left; a wheel that has none takes none off, and drives no chair: beyond,
all of D is on the other.
"""

import casadi as cs

from ...quantities import N, Parameter
from ..alike import SIDE_PULL
from ..signs import Shows
from ..sketch import REAR_LEFT, Arrow, Turn, Wheel, from_above
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

HALF_LEFT_LESS_RIGHT = cs.DM([0.5, -0.5])
ROUNDING = 1e-3  # of D, within which a wheel that runs out of drag is rounded off
NOTHING = 1e-9  # N, of a wheel off the ground


def uneven(D, D_r):
    """Half of D more on one side and less on the other, and on both as much as the lighter one would go below zero."""
    wanted = D_r + HALF_LEFT_LESS_RIGHT * D
    width = ROUNDING * D
    lacking = (cs.sqrt(wanted * wanted + width * width + NOTHING * NOTHING) - wanted) / 2
    return HALF_LEFT_LESS_RIGHT * D + cs.sum1(lacking)


EFFECT = Effect(
    "rolling_resistance_asymmetry",
    "one rear wheel that rolls harder than the other",
    parameters=(D,),
    contributions=(adds("D_w", uneven),),
    alike=(SIDE_PULL,),
    signs=(Shows("coast-down", "chair.psi", more=False),),
    sketches=(
        from_above(
            Wheel("rl"),
            Arrow(REAR_LEFT, (-0.275, -0.42), "D/2 more"),
            Arrow((0.275, -0.42), (0.275, -0.26), "D/2 less"),
            Turn((0, 0.05), "veers", clockwise=False, radius=0.07, moves=True),
        ),
    ),
)
