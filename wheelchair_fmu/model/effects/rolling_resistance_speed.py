"""Rolling resistance that grows with speed, on each wheel by the share of the load that it carries:  k v N / ΣN.

Straight on that is k u in all; a chair that spins on the spot has some of it too, as its wheels roll.
"""

import casadi as cs

from ...quantities import N_S_M, Parameter
from ..alike import DRAG_SLOPE
from ..signs import Shows
from ..sketch import PIVOT_LEFT, PIVOT_RIGHT, REAR_LEFT, REAR_RIGHT, Arrow, from_above
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
LIGHTEST = 1.0  # N; a chair that weighs less is none


def rear(k, N_f, N_r):
    return k / carried(N_f, N_r) * pressed(N_r)


def front(k, N_f, N_r):
    return k / carried(N_f, N_r) * pressed(N_f)


def carried(N_f, N_r):
    return cs.fmax(cs.sum1(pressed(N_f)) + cs.sum1(pressed(N_r)), LIGHTEST)


def pressed(load):
    """A wheel off the ground has no load below zero."""
    return cs.fmax(load, 0)


EFFECT = Effect(
    "rolling_resistance_speed",
    "rolling resistance that grows with speed",
    parameters=(K,),
    contributions=(adds("d_r", rear), adds("d_f", front)),
    alike=(DRAG_SLOPE,),
    signs=(Shows("coast-down", "chair.u", more=False),),
    sketches=(
        from_above(
            Arrow(REAR_LEFT, (-0.275, -0.45)),
            Arrow(REAR_RIGHT, (0.275, -0.45), "k v N/ΣN"),
            Arrow(PIVOT_LEFT, (-0.225, 0.08)),
            Arrow(PIVOT_RIGHT, (0.225, 0.08)),
            Arrow((0, 0), (0, 0.22), "u", moves=True),
        ),
    ),
)
