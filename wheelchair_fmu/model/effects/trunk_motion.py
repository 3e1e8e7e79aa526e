"""The user leans into the push: the CM moves forward against the frame by `amplitude` per 80 N, lagged.

The push F passes a short filter, F_f' = (F − F_f)/τ, then  s' = (amplitude F_f / 80 N − s)/T. The CM lies
a − s behind the pivots and b + s before the axle, and the frame recoils at −s'. Instruments are on the
frame: what reads the CM in a chair without this effect is s behind it. Its way is r − s e_x, so beside the
CM's own acceleration it has

    −s'' + s ψ'²  along x_m,    −2 s' ψ' − s ψ''  along y_m

The filter is there because s'' needs F' and pushes may jump.
"""

import casadi as cs

from ...quantities import M, N, Parameter, S, State
from ..stage import Effect, Row, adds

AMPLITUDE = Parameter(
    "amplitude",
    M,
    "forward motion of the CM against the frame per 80 N of total push",
    off=0.0,
    smallest_interesting=0.01,
    lower=0.0,
    upper=0.3,
    source="chosen; Fuss2024 measured what arms do to the frame",
)
CONSTANTS = (
    Parameter(
        "push",
        N,
        "total push that moves the CM by the amplitude",
        default=80.0,
        lower=1.0,
        upper=1e4,
        symbol="F_lean",
        source="chosen",
    ),
    Parameter(
        "lag",
        S,
        "time by which the trunk follows the push",
        default=0.15,
        lower=0.01,
        upper=5.0,
        symbol="T_lag",
        source="chosen",
    ),
    Parameter(
        "filter",
        S,
        "time constant that smooths the push",
        default=0.003,
        lower=1e-4,
        upper=1.0,
        symbol="T_filter",
        source="chosen",
    ),
)


def felt_rate(F_t, felt, T_filter):
    return (cs.sum1(F_t) - felt) / T_filter


def lean_rate(amplitude, felt, F_lean, lean, T_lag):
    return (amplitude * felt / F_lean - lean) / T_lag


def recoil(amplitude, felt, F_lean, lean, T_lag):
    return -lean_rate(amplitude, felt, F_lean, lean, T_lag)


def felt_ahead(amplitude, F_t, felt, T_filter, F_lean, lean, T_lag, psi_dot):
    rate = amplitude * felt_rate(F_t, felt, T_filter) / F_lean
    return -(rate - lean_rate(amplitude, felt, F_lean, lean, T_lag)) / T_lag + lean * psi_dot * psi_dot


def felt_aside(amplitude, felt, F_lean, lean, T_lag, psi_dot, M_z, inertia):
    return -2 * lean_rate(amplitude, felt, F_lean, lean, T_lag) * psi_dot - lean * M_z / inertia


def muscles(amplitude, felt, F_lean, lean, T_lag, F_xr, F_xf):
    """Less the work of the user who moves against the frame that the wheels hold."""
    return recoil(amplitude, felt, F_lean, lean, T_lag) * (cs.sum1(F_xr) + cs.sum1(F_xf))


EFFECT = Effect(
    "trunk_motion",
    "a trunk that leans into the push",
    parameters=(AMPLITUDE,),
    constants=CONSTANTS,
    contributions=(
        adds("x_f", lambda lean: -lean),
        adds("x_r", lambda lean: -lean),
        adds("v_xf", recoil),
        adds("v_xr", recoil),
        adds("read_a_x", felt_ahead),
        adds("read_a_y", felt_aside),
        adds("read_x", lambda lean, psi: -lean * cs.cos(psi)),
        adds("read_y", lambda lean, psi: -lean * cs.sin(psi)),
        adds("read_u", recoil),
        adds("read_v", lambda lean, psi_dot: -lean * psi_dot),
    ),
    rows=(
        Row(
            State("felt_push", N, "total push as the trunk follows it", nominal=80.0, symbol="felt"),
            lambda: 1.0,
            felt_rate,
            lambda F_t: cs.sum1(F_t),
        ),
        Row(State("lean", M, "how far the CM has moved forward against the frame", nominal=0.01), lambda: 1.0, lean_rate),
    ),
    absorbs=muscles,
)
