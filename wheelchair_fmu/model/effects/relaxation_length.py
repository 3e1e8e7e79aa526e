"""Lateral force follows slip over a distance:  σ z' = −v_y − |v_x| z  at each rear wheel, and λ_F = atan z.

The tyre's deflection σ z grows with the patch's sideways way and fades with the way rolled, as in the string model. Rolling on,
z becomes −v_y / |v_x|, the tangent of (11) and (12), and σ = 0 leaves λ_F = λ exactly. Written with the tangent, the deflection
moves as fast as the hub slides, so the tyre is a spring that gives back no more than it was given, however large its slip:
with W' = C λ_F σ z' the power C λ_F v_y + W' is −|v_x| C λ_F z, never above zero.
"""

from math import exp

import casadi as cs

from ...quantities import RAD, REAR, M, Parameter, State
from ..chassis import per_wheel
from ..signs import Shows
from ..sketch import Curve, graph
from ..smooth import magnitude
from ..stage import Effect, Row, adds

SIGMA = Parameter(
    "sigma",
    M,
    "relaxation length σ of the rear tyres",
    off=0.0,
    smallest_interesting=0.05,
    lower=0.0,
    upper=1.0,
    source="DellOrto2023",
)
LAGGED = State(
    "lagged_slip",
    RAD,
    "slip that the tyre's deflection has reached, as the tangent of its angle",
    mirror="-swap",
    components=REAR,
    nominal=0.1,
    usual=0.01,
)
SHARE = 0.005  # of the energy with which the chair rolls as it starts, at most, is in the deflection of a tyre


def deflected(lagged_slip, v_xw, v_yw, v_eps):
    """λ_F − λ of the hub's own slip: what else adds to λ does not lag."""
    return cs.atan(lagged_slip) + cs.atan2(v_yw, magnitude(v_xw, v_eps))


def rolling(lagged_slip, v_xw, v_yw, v_eps):
    return -v_yw - magnitude(v_xw, v_eps) * lagged_slip


def rolled_slip(v_xw, v_yw, v_eps, drag_eps, sigma, C_lambda, m):
    """The chair has rolled as it starts for long enough: the lag is over.

    Not so one that starts with a slide, nearly at rest or spinning. The lag of this would be over with more energy in the
    tyres, ½ σ C_λ z² each, than the chair has; it starts with what rolling can have put there, ½ SHARE m v_x².
    """
    slip = -v_yw / magnitude(v_xw, v_eps)
    excess = sigma * C_lambda * slip * slip / (SHARE * m * (v_xw * v_xw + drag_eps * drag_eps))
    return slip / cs.sqrt(cs.sqrt(cs.sqrt(1 + excess**4)))


def wound(F_lam, side, lagged_slip, v_xw, v_yw, v_eps):
    """Force times the rate of the deflection σ z, as far as a brake leaves the force to the chair."""
    return cs.sum1(side * F_lam * rolling(lagged_slip, v_xw, v_yw, v_eps))


EFFECT = Effect(
    "relaxation_length",
    "lateral tyre force that follows slip over a distance",
    parameters=(SIGMA,),
    contributions=(adds("lam_F", deflected),),
    rows=(Row(LAGGED, mass=lambda sigma: per_wheel(sigma), rate=rolling, start=rolled_slip),),
    absorbs=wound,
    signs=(Shows("steady-turn", "slip.rr", more=True, seconds=0.5),),
    sketches=(
        graph(
            "way rolled",
            "side force",
            Curve(lambda x: 0.85, "", before=True),
            Curve(lambda x: 0.85 * (1 - exp(-x / 0.3)), "σ = 0.3 of the way"),
        ),
    ),
)
