"""In a turn the outer wheels carry more:  ΔN = ± m_axle a_y h / t  at each axle, by the height h of the CM."""

import casadi as cs

from ...quantities import M, Parameter
from ..alike import YAW_RESISTANCE
from ..signs import Shows
from ..sketch import Arrow, Length, from_behind
from ..stage import Effect, adds

H = Parameter(
    "h",
    M,
    "height h of the CM that shifts load sideways",
    off=0.0,
    smallest_interesting=0.3,
    lower=0.0,
    upper=2.0,
    source="rigid-body statics",
)

LEFT_LESS_RIGHT = cs.DM([1.0, -1.0])  # a_y > 0, a turn to the right, loads the left wheels


def rear(h, m, x_f, x_r, t_r, a_y, g_y):
    return LEFT_LESS_RIGHT * (m * x_f / (x_f - x_r) * (a_y - g_y) * h / t_r)


def front(h, m, x_f, x_r, t_f, a_y, g_y):
    return LEFT_LESS_RIGHT * (m * -x_r / (x_f - x_r) * (a_y - g_y) * h / t_f)


EFFECT = Effect(
    "lateral_load_transfer",
    "load that shifts to the outer wheels in a turn",
    parameters=(H,),
    contributions=(adds("N_r", rear), adds("N_f", front)),
    alike=(YAW_RESISTANCE,),
    signs=(Shows("steady-turn", "chair.curvature", more=False),),
    sketches=(
        from_behind(
            Length((0.12, 0), (0.12, 0.6), "h"),
            Arrow((-0.275, -0.16), (-0.275, 0), "more"),
            Arrow((0.275, -0.08), (0.275, 0), "less"),
            Arrow((0, 0.6), (0.2, 0.6), "a_y", moves=True),
        ),
    ),
)
