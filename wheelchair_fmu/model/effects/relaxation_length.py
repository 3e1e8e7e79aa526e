"""Lateral force follows slip over a distance:  σ λ'_F + |v_x| λ_F = |v_x| λ  at each rear wheel."""

from ...quantities import RAD, REAR, M, Parameter, State
from ..chassis import per_wheel
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
    "slip angle that the tyre's deflection has reached",
    mirror="-swap",
    components=REAR,
    nominal=0.1,
    usual=0.01,
)


def rolling(lagged_slip, lam, v_xr, v_eps):
    return magnitude(v_xr, v_eps) * (lam - lagged_slip)


def rolled_slip(start_u, start_v, start_psi_dot, b, t_r, v_eps):
    """The chair has rolled as it starts for long enough: the lag is over."""
    return per_wheel(-(start_v - b * start_psi_dot) / magnitude(start_u, v_eps))


EFFECT = Effect(
    "relaxation_length",
    "lateral tyre force that follows slip over a distance",
    parameters=(SIGMA,),
    contributions=(adds("lam_F", lambda lagged_slip, lam: lagged_slip - lam),),
    rows=(Row(LAGGED, mass=lambda sigma: per_wheel(sigma), rate=rolling, start=rolled_slip),),
)
