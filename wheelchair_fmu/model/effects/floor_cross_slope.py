"""A slope across the chair whatever its heading, as on a treadmill or along a corridor:  F_y = m g sin θ."""

import casadi as cs

from ...quantities import RAD, Parameter
from ..alike import SIDE_PULL
from ..signs import Shows
from ..sketch import Arrow, from_behind
from ..stage import Effect, adds, scales

THETA = Parameter(
    "theta",
    RAD,
    "slope across the chair, positive where the floor falls to the right",
    off=0.0,
    smallest_interesting=0.001,
    lower=-0.3,
    upper=0.3,
    mirror="-",
    source="Richter2007",
)

EFFECT = Effect(
    "floor_cross_slope",
    "a slope across the chair, whatever its heading",
    parameters=(THETA,),
    contributions=(adds("g_y", lambda theta, g: g * cs.sin(theta)), scales("g_z", lambda theta: cs.cos(theta))),
    alike=(SIDE_PULL,),
    signs=(Shows("coast-down", "chair.y", more=True),),
    sketches=(from_behind(Arrow((0, 0.6), (0.24, 0.6), "m g θ"), tilt=7),),
)
