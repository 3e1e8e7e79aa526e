"""Tyres at another pressure than stated: stiffness, trail and rolling resistance follow p + dp instead of p.

Each is multiplied by  (1 + dp/p)^n , with the exponents n of `tyre.pressure_F`, `tyre.pressure_M` and `tyre.pressure_D`.
"""

import casadi as cs

from ...quantities import BAR, Parameter
from ..alike import YAW_RESISTANCE
from ..signs import Shows
from ..sketch import Arrow, Wheel, from_the_side
from ..stage import Effect, scales

DP = Parameter(
    "dp",
    BAR,
    "how much the pressure lies above the stated tyre.pressure",
    off=0.0,
    smallest_interesting=0.3,
    lower=-3.0,
    upper=5.0,
    source="Doria, Fig. 6",
)
FLATTEST = 0.05  # of the stated pressure


def ratio(dp, pressure):
    return cs.fmax(1 + dp / pressure, FLATTEST)


def power(exponent, dp, pressure):
    return cs.exp(exponent * cs.log(ratio(dp, pressure)))


EFFECT = Effect(
    "inflation_pressure",
    "tyres at another pressure than stated",
    parameters=(DP,),
    contributions=(
        scales("q_F", lambda dp, pressure, pressure_F: power(pressure_F, dp, pressure)),
        scales("q_M", lambda dp, pressure, pressure_M: power(pressure_M, dp, pressure)),
        scales("q_D", lambda dp, pressure, pressure_D: power(pressure_D, dp, pressure)),
    ),
    alike=(YAW_RESISTANCE,),
    signs=(Shows("coast-down", "chair.u", more=True),),
    sketches=(
        from_the_side(
            Wheel("rear"),
            Arrow((-0.2, 0.31), (-0.2, 0.56), "p + dp"),
            Arrow((-0.2, 0.31), (-0.38, 0.14)),
            Arrow((-0.2, 0.31), (-0.02, 0.14)),
        ),
    ),
)
