"""Rear wheels that do not point straight ahead: each wheel's frame is turned clockwise by its toe angle τ.

With the sum τ_r + τ_l the chair goes aside by half of it, as a crab; with the difference the tyres work against each other,
which costs drag like its square, the same for toe-in and toe-out. With both the wheel that is turned more drags more.
"""

from typing import Any

import casadi as cs

from ...quantities import RAD, Parameter
from ..alike import SIDE_PULL
from ..sides import difference_of, of_sum, sum_of
from ..signs import Shows
from ..sketch import Arrow, Length, Wheel, from_above
from ..stage import Effect, adds

COMMON: dict[str, Any] = dict(off=0.0, smallest_interesting=0.005, lower=-0.4, upper=0.4, source="VanderWiel2016")
FORMER = ("tau_r", "tau_l")
SUM = Parameter(
    "sum",
    RAD,
    "sum of both wheels' toe angles τ_r + τ_l, positive when both point to the right: the chair goes aside by half of it",
    symbol="tau_sum",
    mirror="-",
    formerly=sum_of(*FORMER),
    **COMMON,
)
DIFFERENCE = Parameter(
    "difference",
    RAD,
    "toe angle of the right wheel less the left wheel's τ_r − τ_l, positive toe-out (further apart in front), negative toe-in",
    symbol="tau_difference",
    mirror="+",
    formerly=difference_of(*FORMER),
    **COMMON,
)


def turned(forward, right, tau):
    """What turning a vector's axes clockwise by τ adds to its components, along and across."""
    less = cs.cos(tau) - 1
    return less * forward + cs.sin(tau) * right, less * right - cs.sin(tau) * forward


def hub(v_xr, v_yr, tau_sum, tau_difference):
    """From the chair's axes into the wheel's, in which it rolls and slips."""
    return turned(v_xr, v_yr, of_sum(tau_sum, tau_difference))


def force(F_w, F_s, tau_sum, tau_difference):
    """And back: side force points backward in part, drag like toe squared; traction and drag point aside in part."""
    return turned(F_w, F_s, -of_sum(tau_sum, tau_difference))


EFFECT = Effect(
    "toe_misalignment",
    "rear wheels that do not point straight ahead",
    parameters=(SUM, DIFFERENCE),
    contributions=(
        adds("v_xw", lambda v_xr, v_yr, tau_sum, tau_difference: hub(v_xr, v_yr, tau_sum, tau_difference)[0]),
        adds("v_yw", lambda v_xr, v_yr, tau_sum, tau_difference: hub(v_xr, v_yr, tau_sum, tau_difference)[1]),
        adds("F_xr", lambda F_w, F_s, tau_sum, tau_difference: force(F_w, F_s, tau_sum, tau_difference)[0]),
        adds("F_yr", lambda F_w, F_s, tau_sum, tau_difference: force(F_w, F_s, tau_sum, tau_difference)[1]),
    ),
    even=True,
    alike=(SIDE_PULL,),
    signs=(Shows("coast-down", "chair.v", more=True), Shows("coast-down", "chair.u", more=False, either=True)),
    sketches=(
        from_above(Wheel("rl", 12), Wheel("rr", 12), Arrow((-0.12, 0.08), (0.12, 0.08)), of="sum"),
        from_above(Wheel("rl", -12), Wheel("rr", 12), Length((-0.34, 0.15), (0.34, 0.15)), of="difference"),
    ),
)
