"""The user leans into the push: the CM moves forward against the frame, by two laws that add up.

The first follows the push and stays while it lasts, by `amplitude` per 80 N: the push F passes a short filter,
F_f' = (F − F_f)/τ, then  s₁' = (amplitude F_f / 80 N − s₁)/T. The filter is there because s₁'' needs F' and pushes may jump.
The second swings, by `swing` per 80 N, and most of it after the push, as trunk and arms of a person do:

    s₂'' + 2 ζ ω s₂' + ω² s₂ = ω² swing F / 80 N,    ω = 2π frequency

Both are linear in their sizes. People swing at frequencies and with damping of their own, so a fit adjusts these two as well.

The CM lies a − s behind the pivots and b + s before the axle, s = s₁ + s₂, and the frame recoils at −s'. Instruments are on the
frame: what reads the CM in a chair without this effect is s behind it. Its way is r − s e_x, so beside the CM's own
acceleration it has

    −s'' + s ψ'²  along x_m,    −2 s' ψ' − s ψ''  along y_m
"""

import casadi as cs

from ...quantities import HZ, M_S, ONE, M, N, Parameter, S, State
from ..alike import MOVING_BODY
from ..signs import Shows
from ..sketch import Arrow, Length, Spot, from_the_side
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
SWING = Parameter(
    "swing",
    M,
    "forward motion of the CM against the frame per 80 N of total push, had it time to settle; it swings by more",
    off=0.0,
    smallest_interesting=0.005,
    lower=0.0,
    upper=0.3,
    source="chosen; of a person who pushed, this law explained two thirds of what the body's markers showed",
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
    Parameter(
        "frequency",
        HZ,
        "natural frequency at which trunk and arms swing",
        default=1.3,
        lower=0.1,
        upper=20.0,
        symbol="f_swing",
        source="fitted to the motion of a person who pushed",
        known_to=0.25,
    ),
    Parameter(
        "damping",
        ONE,
        "damping ratio of that swing",
        default=0.2,
        lower=0.01,
        upper=10.0,
        symbol="zeta_swing",
        source="fitted to the motion of a person who pushed",
        known_to=0.1,
    ),
)


def felt_rate(F_t, felt, T_filter):
    return (cs.sum1(F_t) - felt) / T_filter


def lean_rate(amplitude, felt, F_lean, lean, T_lag):
    return (amplitude * felt / F_lean - lean) / T_lag


def sway_rate(swing, F_t, F_lean, swung, sway, f_swing, zeta_swing):
    omega = 2 * cs.pi * f_swing
    return omega * omega * (swing * cs.sum1(F_t) / F_lean - swung) - 2 * zeta_swing * omega * sway


def recoil(amplitude, felt, F_lean, lean, T_lag, sway):
    return -lean_rate(amplitude, felt, F_lean, lean, T_lag) - sway


def felt_ahead(amplitude, swing, F_t, felt, T_filter, F_lean, lean, T_lag, swung, sway, f_swing, zeta_swing, psi_dot):
    rate = amplitude * felt_rate(F_t, felt, T_filter) / F_lean
    following = (rate - lean_rate(amplitude, felt, F_lean, lean, T_lag)) / T_lag
    swinging = sway_rate(swing, F_t, F_lean, swung, sway, f_swing, zeta_swing)
    return -following - swinging + (lean + swung) * psi_dot * psi_dot


def felt_aside(amplitude, felt, F_lean, lean, T_lag, swung, sway, psi_dot, M_z, inertia):
    return 2 * recoil(amplitude, felt, F_lean, lean, T_lag, sway) * psi_dot - (lean + swung) * M_z / inertia


def muscles(amplitude, felt, F_lean, lean, T_lag, sway, F_xr, F_xf):
    """Less the work of the user who moves against the frame that the wheels hold."""
    return recoil(amplitude, felt, F_lean, lean, T_lag, sway) * (cs.sum1(F_xr) + cs.sum1(F_xf))


EFFECT = Effect(
    "trunk_motion",
    "a trunk that leans into the push",
    parameters=(AMPLITUDE, SWING),
    constants=CONSTANTS,
    contributions=(
        adds("x_f", lambda lean, swung: -lean - swung),
        adds("x_r", lambda lean, swung: -lean - swung),
        adds("v_xf", recoil),
        adds("v_xr", recoil),
        adds("read_a_x", felt_ahead),
        adds("read_a_y", felt_aside),
        adds("read_x", lambda lean, swung, psi: -(lean + swung) * cs.cos(psi)),
        adds("read_y", lambda lean, swung, psi: -(lean + swung) * cs.sin(psi)),
        adds("read_u", recoil),
        adds("read_v", lambda lean, swung, psi_dot: -(lean + swung) * psi_dot),
    ),
    rows=(
        Row(
            State("felt_push", N, "total push as the trunk follows it", nominal=80.0, symbol="felt"),
            lambda: 1.0,
            felt_rate,
            lambda F_t: cs.sum1(F_t),
        ),
        Row(State("lean", M, "how far the CM has followed the push against the frame", nominal=0.01), lambda: 1.0, lean_rate),
        Row(State("swung", M, "how far the CM has swung forward besides", nominal=0.01), lambda: 1.0, lambda sway: sway),
        Row(State("sway", M_S, "how fast it swings", nominal=0.1), lambda: 1.0, sway_rate),
    ),
    absorbs=muscles,
    alike=(MOVING_BODY,),
    signs=(
        Shows("start-stop", "sensor.wheel_speed_r", more=False, seconds=0.3),
        Shows("start-stop", "sensor.wheel_speed_r", more=False, seconds=0.3),
    ),
    sketches=(
        from_the_side(
            Spot((0.16, 0.6), "CM"),
            Length((0, 0.66), (0.16, 0.66), "s"),
            Arrow((-0.2, -0.07), (0.05, -0.07), "push", moves=True),
        ),
    ),
)
