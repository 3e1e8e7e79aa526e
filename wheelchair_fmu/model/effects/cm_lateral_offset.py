"""The CM beside the symmetry plane: wheels lie y further to its left, and  ΔN = ± m_axle g y / t  at each axle."""

import casadi as cs

from ...quantities import M, Parameter
from ..signs import Shows
from ..sketch import Length, Spot, from_above
from ..stage import Effect, adds

Y = Parameter(
    "y",
    M,
    "how far the CM lies to the right of the symmetry plane",
    off=0.0,
    smallest_interesting=0.004,
    lower=-0.2,
    upper=0.2,
    mirror="-",
    symbol="y_cm",
    source="rigid-body statics",
)

RIGHT_LESS_LEFT = cs.DM([-1.0, 1.0])


def rear(y_cm, m, g_z, x_f, x_r, t_r):
    return RIGHT_LESS_LEFT * (m * x_f / (x_f - x_r) * y_cm / t_r * g_z)


def front(y_cm, m, g_z, x_f, x_r, t_f):
    return RIGHT_LESS_LEFT * (m * -x_r / (x_f - x_r) * y_cm / t_f * g_z)


EFFECT = Effect(
    "cm_lateral_offset",
    "centre of mass beside the symmetry plane",
    parameters=(Y,),
    contributions=(adds("y_r", lambda y_cm: -y_cm), adds("y_f", lambda y_cm: -y_cm), adds("N_r", rear), adds("N_f", front)),
    signs=(Shows("start-stop", "chair.psi", more=True),),
    sketches=(from_above(Spot((0.13, 0), "CM"), Length((0, 0.06), (0.13, 0.06), "y")),),
)
