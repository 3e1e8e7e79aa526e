"""Rolling resistance that grows with speed:  F_x = −k u  at the CM."""

from ...quantities import N_S_M, Parameter
from ..stage import Effect, adds

K = Parameter(
    "k",
    N_S_M,
    "viscous part of the rolling resistance",
    off=0.0,
    smallest_interesting=0.3,
    lower=0.0,
    upper=200.0,
    source="Chua2011",
)


def drag(u, k):
    return -k * u


EFFECT = Effect(
    "rolling_resistance_speed",
    "rolling resistance that grows with speed",
    parameters=(K,),
    contributions=(adds("F_x", drag, opposes="u"),),
)
