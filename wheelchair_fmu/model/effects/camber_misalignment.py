"""Rear wheels that lean, each by its camber angle φ, positive to the right:  C_φ φ  is added to the side force, (13) and (14).

It is the sum φ_r + φ_l that pushes the chair aside. The difference cancels from left to right as long as both wheels roll the
same way: only one that rolls backward while the other goes forward, as in a spin, shows it.
"""

from typing import Any

from ...quantities import RAD, Parameter
from ..alike import SIDE_PULL
from ..sides import difference_of, of_sum, sum_of
from ..signs import Shows
from ..sketch import Arrow, Length, Wheel, from_behind
from ..stage import Effect, adds

COMMON: dict[str, Any] = dict(off=0.0, smallest_interesting=0.005, lower=-0.6, upper=0.6, source="Doria, section 6.3")
FORMER = ("phi_r", "phi_l")
SUM = Parameter(
    "sum",
    RAD,
    "sum of both wheels' camber angles φ_r + φ_l, positive when both lean to the right: it pulls the chair to the right",
    symbol="phi_sum",
    mirror="-",
    formerly=sum_of(*FORMER),
    **COMMON,
)
DIFFERENCE = Parameter(
    "difference",
    RAD,
    "camber angle of the right wheel less the left wheel's φ_r − φ_l, positive when they stand further apart at the top",
    symbol="phi_difference",
    mirror="+",
    formerly=difference_of(*FORMER),
    **COMMON,
)

EFFECT = Effect(
    "camber_misalignment",
    "rear wheels that lean",
    parameters=(SUM, DIFFERENCE),
    contributions=(adds("phi", lambda phi_sum, phi_difference: of_sum(phi_sum, phi_difference)),),
    alike=(SIDE_PULL,),
    signs=(Shows("coast-down", "chair.psi", more=True), Shows("spin", "chair.psi_dot", more=False)),
    sketches=(
        from_behind(Wheel("rl", 9), Wheel("rr", 9), Arrow((-0.1, 0.72), (0.14, 0.72)), of="sum"),
        from_behind(Wheel("rl", -9), Wheel("rr", 9), Length((-0.36, 0.68), (0.36, 0.68)), of="difference"),
    ),
)
