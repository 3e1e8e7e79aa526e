"""The rigid chair and user: geometry, loads, kinematics and Newton's second law, (18)–(23)."""

from __future__ import annotations

from typing import Any

import casadi as cs

from ..quantities import FRONT, HZ, KG, KG_M2, M_S, M_S2, N_M, N_S, ONE, PER_M, RAD, RAD_S, REAR, Input, M, N, Parameter, State
from .frames import moment, to_chair, to_room, velocity_at
from .stage import Row, define, stage

TABLE_1 = "Doria, Table 1"
PARAMETERS = (
    Parameter(
        "chair.m",
        KG,
        "total mass m of chair and user",
        default=80.0,
        lower=1.0,
        upper=1000.0,
        source=TABLE_1,
        uncertainty=0.025,
    ),
    Parameter(
        "chair.I_z",
        KG_M2,
        "moment of inertia I_z about the vertical axis through the CM",
        default=3.08,
        lower=0.01,
        upper=1000.0,
        source=TABLE_1,
        among_chairs=3.0,
    ),
    Parameter(
        "chair.a",
        M,
        "distance a from the CM forward to the casters' pivots",
        default=0.25,
        lower=0.01,
        upper=2.0,
        source=TABLE_1,
        known_to=0.01,
    ),
    Parameter(
        "chair.b",
        M,
        "distance b from the CM back to the rear axle",
        default=0.20,
        lower=0.0,
        upper=2.0,
        source=TABLE_1,
        known_to=0.01,
    ),
    Parameter("chair.t_r", M, "rear tread t_r", default=0.55, lower=0.05, upper=3.0, source=TABLE_1, known_to=0.008),
    Parameter("chair.t_f", M, "front tread t_f", default=0.45, lower=0.05, upper=3.0, source=TABLE_1),
    Parameter(
        "wheel.R",
        M,
        "rolling radius R of the rear wheels; an axle torque M pushes with M/R",
        default=0.31,
        lower=0.05,
        upper=1.0,
        source="common 24 in wheel",
    ),
    Parameter(
        "wheel.R_rim",
        M,
        "radius of the pushrims; hands push R/R_rim as hard as the tyre",
        default=0.275,
        lower=0.05,
        upper=1.0,
        source="common 24 in wheel",
    ),
    Parameter(
        "rider.m",
        KG,
        "mass that moves with rider.s; zero where only rider.momentum is given",
        default=0.0,
        lower=0.0,
        upper=500.0,
        nominal=50.0,
        source="of the whole person, or of the part whose position is measured",
        symbol="rider_m",
    ),
    Parameter(
        "rider.scale",
        ONE,
        "factor from the body motion that is given to all that there is: a few markers see a part of it",
        default=1.0,
        lower=0.0,
        upper=10.0,
        source="1: all of it is given",
        uncertainty=0.5,
        symbol="rider_scale",
    ),
    Parameter("g", M_S2, "acceleration due to gravity g", default=9.81, lower=0.0, upper=30.0, source="standard"),
    Parameter(
        "speed.mode",
        ONE,
        "free: the pushes move the chair by (20); prescribed: u stays at speed.u and push.total_needed says what that takes",
        default=1,
        lower=1,
        upper=2,
        choices=("free", "prescribed"),
        fixed=True,
        symbol="speed_mode",
    ),
    Parameter(
        "speed.u",
        M_S,
        "the forward speed u held when speed.mode is prescribed",
        default=1.0,
        lower=-20.0,
        upper=20.0,
        symbol="speed_u",
    ),
    Parameter(
        "start.x", M, "x of the CM in the room at the start", mirror="+", lower=-1e6, upper=1e6, fixed=True, symbol="start_x"
    ),
    Parameter(
        "start.y",
        M,
        "y of the CM in the room at the start, to the right of x",
        mirror="-",
        lower=-1e6,
        upper=1e6,
        fixed=True,
        symbol="start_y",
    ),
    Parameter(
        "start.psi",
        RAD,
        "yaw angle ψ at the start, clockwise from above",
        mirror="-",
        lower=-1e5,
        upper=1e5,
        fixed=True,
        symbol="start_psi",
    ),
    Parameter(
        "start.u",
        M_S,
        "forward speed u at the start (free speed)",
        default=1.0,
        lower=-20.0,
        upper=20.0,
        fixed=True,
        symbol="start_u",
    ),
    Parameter(
        "start.v",
        M_S,
        "lateral speed v at the start, to the right",
        mirror="-",
        lower=-20.0,
        upper=20.0,
        fixed=True,
        symbol="start_v",
    ),
    Parameter(
        "start.psi_dot",
        RAD_S,
        "yaw rate ψ' at the start, clockwise from above",
        mirror="-",
        lower=-50.0,
        upper=50.0,
        fixed=True,
        symbol="start_psi_dot",
    ),
)
DEFAULTS = {p.name: p.default for p in PARAMETERS}  # for whoever needs a size before there is a model

PUSH_LIMIT = 2000.0  # N per wheel: five times the strongest push on record; more is a slipped unit
HARDEST_SWING = 500.0  # N s: the whole of a heavy person at 5 m/s against the frame
UPRIGHT = 0.01  # square of the cosine of a slope: beyond what inputs and effects may have together, where a root has a slope
STEEPEST = 0.5  # rad, 1 in 1.8: far beyond what a chair stands on; a ramp has 0.08, and ISO 7176-2 tests up to 0.17
INPUTS = (
    Input(
        "push.F_rl",
        N,
        "push force F_rl on the left wheel, at the contact patch, forward",
        mirror="+F_rr",
        lower=-PUSH_LIMIT,
        upper=PUSH_LIMIT,
        nominal=50.0,
    ),
    Input(
        "push.F_rr",
        N,
        "push force F_rr on the right wheel, at the contact patch, forward",
        mirror="+F_rl",
        lower=-PUSH_LIMIT,
        upper=PUSH_LIMIT,
        nominal=50.0,
    ),
    Input(
        "push.M_rl",
        N_M,
        "axle torque on the left wheel, forward; adds M_rl/R to the push",
        mirror="+M_rr",
        lower=-PUSH_LIMIT,
        upper=PUSH_LIMIT,
        nominal=15.0,
    ),
    Input(
        "push.M_rr",
        N_M,
        "axle torque on the right wheel, forward; adds M_rr/R to the push",
        mirror="+M_rl",
        lower=-PUSH_LIMIT,
        upper=PUSH_LIMIT,
        nominal=15.0,
    ),
    Input(
        "rider.momentum",
        N_S,
        "momentum of the rider's body relative to the frame, forward; the frame recoils by it over chair.m",
        lower=-HARDEST_SWING,
        upper=HARDEST_SWING,
        nominal=20.0,
        symbol="rider_momentum",
        seldom=True,
    ),
    Input(
        "external.force",
        N,
        "force from outside at the CM along the chair's heading, as of an attendant, a rope or wind; no hand of the rider's",
        lower=-PUSH_LIMIT,
        upper=PUSH_LIMIT,
        nominal=50.0,
        symbol="F_ext",
        seldom=True,
    ),
    Input(
        "external.moment",
        N_M,
        "moment from outside about the vertical axis, positive clockwise from above",
        mirror="-",
        lower=-PUSH_LIMIT,
        upper=PUSH_LIMIT,
        nominal=15.0,
        symbol="M_ext",
        seldom=True,
    ),
    Input(
        "rider.s",
        M,
        "how far the mass rider.m has moved forward against the frame; it shifts the CM, and rider.momentum says how fast",
        lower=-2.0,
        upper=2.0,
        nominal=0.05,
        symbol="rider_s",
        seldom=True,
    ),
    Input(
        "rider.force",
        N,
        "rate of change of rider.momentum; only accelerometers feel it",
        lower=-PUSH_LIMIT,
        upper=PUSH_LIMIT,
        nominal=100.0,
        symbol="rider_force",
        seldom=True,
    ),
    Input(
        "stroke.phase",
        ONE,
        "strokes since the first, as a number that grows steadily from one to the next; for a body that moves with them",
        lower=-1e5,
        upper=1e5,
        symbol="stroke_phase",
        seldom=True,
    ),
    Input("stroke.rate", HZ, "rate of change of stroke.phase", lower=-20.0, upper=20.0, symbol="stroke_rate", seldom=True),
    Input(
        "brake.rl",
        ONE,
        "brake of the left wheel: 0 open, 1 fully applied",
        mirror="+brake_rr",
        lower=0.0,
        upper=1.0,
        symbol="brake_rl",
        seldom=True,
    ),
    Input(
        "brake.rr",
        ONE,
        "brake of the right wheel: 0 open, 1 fully applied",
        mirror="+brake_rl",
        lower=0.0,
        upper=1.0,
        symbol="brake_rr",
        seldom=True,
    ),
    Input(
        "floor.slope_x",
        RAD,
        "slope of the floor along the room's x, positive where it falls towards +x",
        lower=-STEEPEST,
        upper=STEEPEST,
        nominal=0.05,
        seldom=True,
    ),
    Input(
        "floor.slope_y",
        RAD,
        "slope of the floor along the room's y, positive where it falls towards +y",
        mirror="-",
        lower=-STEEPEST,
        upper=STEEPEST,
        nominal=0.05,
        seldom=True,
    ),
    Input(
        "floor.rolling_factor",
        ONE,
        "factor on both rolling resistance coefficients: 1 smooth, about 2 carpet",
        start=1.0,
        lower=0.0,
        upper=100.0,
        seldom=True,
    ),
)


def per_wheel(value: Any) -> Any:
    """The same value for the left and the right wheel."""
    return cs.vertcat(value, value)


@stage(define("F_t", N, "traction at the rear contact patches", "+swap", REAR))
def traction(F_rl, F_rr, M_rl, M_rr, R):
    return cs.vertcat(F_rl + M_rl / R, F_rr + M_rr / R)


@stage(
    define("shift", M, "how far the CM has moved forward against the frame with the rider's body, as given"),
    define("recoil", M_S, "forward speed of the frame less the CM's, from that"),
    define("recoil_rate", M_S2, "how fast that changes"),
)
def rider(rider_s, rider_momentum, rider_force, rider_m, rider_scale, m):
    """Momentum m u = m u_frame + p_r: forces change u, whatever the body does; the frame's own speed is less by p_r/m.

    As u is the CM's speed, nothing that is measured is ever differentiated here.
    """
    share = rider_scale / m
    return share * rider_m * rider_s, -share * rider_momentum, -share * rider_force


@stage(
    define("x_f", M, "how far the casters' pivots lie before the CM"),
    define("x_r", M, "how far the rear axle lies before the CM (negative)"),
    define("y_f", M, "how far each pivot lies to the right of the CM", "-swap", FRONT),
    define("y_r", M, "how far each rear wheel lies to the right of the CM", "-swap", REAR),
)
def geometry(a, b, t_f, t_r, shift):
    return a - shift, -b - shift, cs.vertcat(-t_f / 2, t_f / 2), cs.vertcat(-t_r / 2, t_r / 2)


@stage(
    define("mass_u", KG, "mass that resists a change of u"),
    define("mass_v", KG, "mass that resists a change of v"),
    define("inertia", KG_M2, "moment of inertia that resists a change of ψ'"),
)
def inertias(m, I_z):
    return m, m, I_z


@stage(
    define("v_xf", M_S, "forward velocity of the casters' pivots", "+swap", FRONT),
    define("v_yf", M_S, "rightward velocity of the casters' pivots", "-swap", FRONT),
    define("v_xr", M_S, "forward velocity of the rear hubs", "+swap", REAR),
    define("v_yr", M_S, "rightward velocity of the rear hubs", "-swap", REAR),
)
def kinematics(u, v, psi_dot, x_f, y_f, x_r, y_r, recoil):
    """Numerators and denominators of (9)–(12)."""
    v_xf, v_yf = velocity_at(x_f, y_f, u + recoil, v, psi_dot)
    v_xr, v_yr = velocity_at(x_r, y_r, u + recoil, v, psi_dot)
    return v_xf, per_wheel(v_yf), v_xr, per_wheel(v_yr)


@stage(
    define("v_xw", M_S, "velocity of each rear hub along its wheel", "+swap", REAR),
    define("v_yw", M_S, "velocity of each rear hub across its wheel, to the right", "-swap", REAR),
)
def wheel_planes(v_xr, v_yr):
    """The rear wheels point straight ahead."""
    return v_xr, v_yr


@stage(
    define("fall_x", RAD, "slope under the chair along the room's x"),
    define("fall_y", RAD, "slope under the chair along the room's y", "-"),
)
def floor(slope_x, slope_y):
    return slope_x, slope_y


@stage(
    define("g_x", M_S2, "gravity along x_m"),
    define("g_y", M_S2, "gravity along y_m", "-"),
    define("g_z", M_S2, "gravity into the floor"),
)
def gravity(fall_x, fall_y, psi, g):
    """The room's axes lie in the floor, so that what the floor carries is what is left of g."""
    sin_x, sin_y = cs.sin(fall_x), cs.sin(fall_y)
    along_x, along_y = to_chair(g * sin_x, g * sin_y, psi)
    return along_x, along_y, g * cs.sqrt(cs.fmax(1 - sin_x * sin_x - sin_y * sin_y, UPRIGHT))


@stage(
    define("N_f", N, "vertical load of each caster", "+swap", FRONT),
    define("N_r", N, "vertical load of each rear wheel", "+swap", REAR),
)
def loads(m, g_z, x_f, x_r):
    """Static equilibrium about the axles; a = x_f and b = −x_r."""
    a, b = x_f, -x_r
    return (
        per_wheel(b * m / (2 * (a + b)) * g_z),  # (18)
        per_wheel(a * m / (2 * (a + b)) * g_z),  # (19)
    )


@stage(
    define("F_x", N, "sum of all forces along x_m, gravity included"),
    define("F_y", N, "sum of all forces along y_m, gravity included", "-"),
    define("M_z", N_M, "sum of all moments about the vertical axis through the CM", "-"),
)
def forces(F_xr, F_yr, M_t, F_xf, F_yf, M_f, x_f, y_f, x_r, y_r, m, g_x, g_y, F_ext, M_ext):
    """Right-hand sides of (20), (21), (22), with what acts from outside."""
    F_x = cs.sum1(F_xr) + cs.sum1(F_xf) + m * g_x + F_ext  # (20)
    F_y = cs.sum1(F_yr) + cs.sum1(F_yf) + m * g_y  # (21)
    M_z = moment(x_r, y_r, F_xr, F_yr) + moment(x_f, y_f, F_xf, F_yf) + cs.sum1(M_t + M_f) + M_ext  # (22)
    return F_x, F_y, M_z


@stage(define("driving", N, "mass_u · u' where the speed is free"), define("v_rate", N, "mass_v · v'", "-"))
def momentum(F_x, F_y, m, u, v, psi_dot):
    """Newton's second law (20), (21)."""
    return F_x + m * v * psi_dot, F_y - m * u * psi_dot


@stage(
    define("u_rate", N, "mass_u · u'"),
    define("a_x", M_S2, "acceleration of the CM along x_m, u' − v ψ'"),
    define("a_y", M_S2, "acceleration of the CM along y_m, v' + u ψ'", "-"),
    define("needed", N, "total push F_rl + F_rr that keeps u constant"),
)
def balance(driving, v_rate, F_t, mass_u, mass_v, u, v, psi_dot, speed_mode):
    """With prescribed speed (20) says which push is needed."""
    u_rate = (2 - speed_mode) * driving
    return u_rate, u_rate / mass_u - v * psi_dot, v_rate / mass_v + u * psi_dot, cs.sum1(F_t) - driving


@stage(
    define("x_rate", M_S, "x'"),
    define("y_rate", M_S, "y'", "-"),
    define("psi_rate", RAD_S, "ψ'", "-"),
    define("psi_dot_rate", N_M, "inertia · ψ''", "-"),
)
def motion(u, v, psi, psi_dot, M_z):
    """Right-hand sides of the other four base rows of M x' = f."""
    x_rate, y_rate = to_room(u, v, psi)
    return x_rate, y_rate, psi_dot, M_z


def one() -> float:
    return 1.0


def start_speed(start_u, speed_u, speed_mode):
    """The free chair starts at start.u, the prescribed one at speed.u."""
    return (2 - speed_mode) * start_u + (speed_mode - 1) * speed_u


ROWS = (
    Row(State("x", M, "x of the CM in the room"), one, lambda x_rate: x_rate, lambda start_x: start_x),
    Row(State("y", M, "y of the CM in the room", "-"), one, lambda y_rate: y_rate, lambda start_y: start_y),
    Row(
        State("psi", RAD, "yaw angle ψ, clockwise from above", "-"), one, lambda psi_rate: psi_rate, lambda start_psi: start_psi
    ),
    Row(State("u", M_S, "forward speed u of the CM"), lambda mass_u: mass_u, lambda u_rate: u_rate, start_speed),
    Row(
        State("v", M_S, "lateral speed v of the CM, to the right", "-"),
        lambda mass_v: mass_v,
        lambda v_rate: v_rate,
        lambda start_v: start_v,
    ),
    Row(
        State("psi_dot", RAD_S, "yaw rate ψ', clockwise from above", "-"),
        lambda inertia: inertia,
        lambda psi_dot_rate: psi_dot_rate,
        lambda start_psi_dot: start_psi_dot,
    ),
)


@stage(
    define("curvature", PER_M, "curvature 1/R_c of the CM's path, positive to the right", "-"),
    define("lifted", ONE, "1 where a wheel has left the ground"),
    define("overdriven", ONE, "1 where a rear wheel is pushed beyond friction and rolls on all the same"),
    define("rim_needed", N, "total push at the rims that keeps u constant"),
)
def results(u, v, psi_dot, v_eps, N_f, N_r, mu, creeping, needed, R, R_rim):
    curvature = psi_dot / cs.sqrt(u * u + v * v + v_eps * v_eps)  # (23)
    lifted = cs.fmin(cs.mmin(N_f), cs.mmin(N_r)) <= 0
    overdriven = cs.mmin(mu * cs.fmax(N_r, 0) - cs.fabs(creeping)) < 0
    return curvature, lifted, overdriven, needed * R / R_rim
