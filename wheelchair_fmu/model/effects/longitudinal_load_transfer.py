"""Pushing loads the rear wheels:  ΔN = ± m a_x h / (2 (a + b))  at each wheel, by the height h of the CM.

Straight on only rolling resistance feels it, as h (f_f − f_r): h is as sure as what is known of that difference.
"""

from ...quantities import M, Parameter
from ..alike import EFFECTIVE_MASS
from ..signs import Shows
from ..sketch import Arrow, Length, from_the_side
from ..stage import Effect, adds

H = Parameter(
    "h",
    M,
    "height h of the CM that shifts load backward",
    off=0.0,
    smallest_interesting=0.3,
    lower=0.0,
    upper=2.0,
    source="rigid-body statics",
)


def shift(h, m, a_x, g_x, x_f, x_r):
    return m * (a_x - g_x) * h / (2 * (x_f - x_r))


EFFECT = Effect(
    "longitudinal_load_transfer",
    "load that shifts to the rear wheels under a push",
    parameters=(H,),
    contributions=(adds("N_r", shift), adds("N_f", lambda h, m, a_x, g_x, x_f, x_r: -shift(h, m, a_x, g_x, x_f, x_r))),
    alike=(EFFECTIVE_MASS,),
    signs=(Shows("start-stop", "chair.u", more=True),),
    sketches=(
        from_the_side(
            Length((0.05, 0), (0.05, 0.6), "h"),
            Arrow((-0.2, -0.16), (-0.2, 0), "more"),
            Arrow((0.22, -0.08), (0.22, 0), "less"),
            Arrow((0, 0.6), (0.25, 0.6), "a_x", moves=True),
        ),
    ),
)
