"""Casters with a tyre, inertia and friction: the patch lies a trail c behind the pivot, and slips sideways under load.

A caster turns in the room with Ω = δ' + ψ' under the torque M_w of its bearing, M_p of its patch and its side force F there:

    I Ω' = M_w + M_p − c F,    M_w = −M sign(δ') − d δ'

Its tyre is deflected by σ z, which grows with the patch's sideways way and fades with the way it goes, as in the string model:

    σ z' = −v_s − |v| z,    F = C z / √(1 + (C z/μN)²)

where v_s is the patch's velocity across its heading, and v all of it. Rolling on, z is the sine of the slip angle; a patch that
slides aside has z = ±1 and a force that friction limits, and one that stands is a spring. The tyre gives back no more than it
was given: F v_s + F σ z' = −|v| F z. A standing tyre is damped by its carcass, F of z + τ z', with τ from 10 ms at rest to
nothing at walking pace; nothing else would end its ringing.

So casters swing round when the chair backs up, and kick it as they do. Where σ is longer than c they shimmy, if the bearing
damps little: a chair that goes straight ahead at u keeps them quiet as long as (see `tests/model/test_shimmy.py`)

    (d/σ) u² + (d²/I − C c (1 − c/σ)) u + d c² C/I > 0

The floor carries the casters at their patches, a trail behind the pivots and so nearer to the CM, or before them after backing
up: the front axle's load changes with the mean of both cosines of δ.
"""

from __future__ import annotations

from dataclasses import replace

import casadi as cs

from ...quantities import FRONT, KG_M2, M_S, N_M, N_M_S, N_RAD, ONE, RAD, RAD_S, REAR, M, N, Parameter, S, State
from ..chassis import per_wheel
from ..resistance import LIGHTEST
from ..smooth import grip, speed
from ..stage import Alternative, Row, define, stage
from . import swivelling

PARAMETERS = (
    *(
        replace(p, among_chairs=0.01) if p.name == "caster.trail" else p
        for p in swivelling.PARAMETERS
        if p.name != "regularisation.trail"
    ),
    Parameter(
        "caster.I",
        KG_M2,
        "moment of inertia I of each caster about its pivot",
        default=0.003,
        lower=1e-5,
        upper=0.5,
        symbol="I_caster",
        among_chairs=1.5e-3,
        source="chosen: half a kilogram about 0.08 m",
    ),
    Parameter(
        "caster.M",
        N_M,
        "dry friction torque M of each caster's bearing",
        default=0.01,
        lower=0.0,
        upper=5.0,
        symbol="M_bearing",
        among_chairs=0.01,
        source="chosen: a clean ball bearing",
        dry=True,
    ),
    Parameter(
        "caster.d",
        N_M_S,
        "viscous friction d of each caster's bearing",
        default=0.002,
        lower=0.0,
        upper=5.0,
        symbol="d_bearing",
        source="chosen: grease",
    ),
    Parameter(
        "caster.C_lambda",
        N_RAD,
        "cornering stiffness C of each caster's tyre",
        default=2500.0,
        lower=10.0,
        upper=1e5,
        symbol="C_caster",
        among_chairs=750.0,
        source="chosen: half a rear tyre's",
    ),
    Parameter(
        "caster.sigma",
        M,
        "relaxation length σ of each caster's tyre; where it is longer than the trail, casters may shimmy",
        default=0.01,
        lower=1e-3,
        upper=0.5,
        symbol="sigma_caster",
        source="chosen: half a patch",
    ),
    Parameter(
        "caster.mu",
        ONE,
        "friction coefficient μ of the side force of each caster's tyre",
        default=0.8,
        lower=0.05,
        upper=5.0,
        symbol="mu_caster",
        source="chosen: rubber on a smooth floor",
    ),
    Parameter(
        "regularisation.carcass",
        S,
        "time constant by which a standing tyre's carcass is damped",
        default=0.01,
        lower=1e-4,
        upper=0.02,
        symbol="T_carcass",
        source="chosen",
    ),
    Parameter(
        "regularisation.carcass_speed",
        M_S,
        "speed of the patch by which that damping has faded",
        default=0.05,
        lower=1e-3,
        upper=0.2,
        symbol="v_quiet",
        source="chosen",
    ),
)

TURNING = State("turning_rate", RAD_S, "turning rate of each caster in the room", "-swap", FRONT, nominal=10.0, usual=0.1)
DEFLECTED = State("deflection", RAD, "deflection of each caster's tyre over its relaxation length", "-swap", FRONT, usual=0.01)


@stage(define("c", M, "caster trail, by which it swings", "+swap", FRONT))
def one_trail(trail):
    return per_wheel(trail)


@stage(define("lever", M, "lever between a torque on each caster and its lateral force", "+swap", FRONT))
def leverage(c):
    return c


@stage(
    define("N_f", N, "vertical load of each caster", "+swap", FRONT),
    define("N_r", N, "vertical load of each rear wheel", "+swap", REAR),
)
def loads(m, g_z, x_f, x_r, c, swivel):
    """(18), (19) with the front axle where the patches are in the mean."""
    ahead = x_f - cs.dot(c, cs.cos(swivel)) / 2
    weight = m * g_z / (2 * (ahead - x_r))
    return per_wheel(-x_r * weight), per_wheel(ahead * weight)


@stage(
    define("swivel_slip", M_S, "sideways velocity of each caster's patch", "-swap", FRONT),
    define("swivel_rate", RAD_S, "caster swivel rate δ'", "-swap", FRONT),
    define("turning", RAD_S, "rate at which each caster's patch turns on the floor", "-swap", FRONT),
    define("rolling", M_S, "speed at which each caster rolls along its heading", "+swap", FRONT),
)
def patches(v_xf, v_yf, psi_dot, swivel, turning_rate, c):
    along, aside = cs.cos(swivel), cs.sin(swivel)
    slip = v_yf * along - v_xf * aside - c * turning_rate
    return slip, turning_rate - psi_dot, turning_rate, v_xf * along + v_yf * aside


@stage(
    define("deflecting", M_S, "rate at which each caster's tyre is deflected, σ z'", "-swap", FRONT),
    define("F_caster", N, "side force of each caster's tyre", "-swap", FRONT),
)
def tyres(swivel_slip, rolling, deflection, N_f, C_caster, sigma_caster, mu_caster, T_carcass, v_quiet, drag_eps):
    squared = rolling * rolling + swivel_slip * swivel_slip
    rate = -swivel_slip - cs.sqrt(squared + drag_eps * drag_eps) * deflection
    share = squared / (v_quiet * v_quiet)
    felt = C_caster * (deflection + T_carcass / (1 + share * share) * rate / sigma_caster)
    limit = mu_caster * cs.fmax(N_f, LIGHTEST)
    return rate, felt / cs.sqrt(1 + (felt / limit) ** 2)


@stage(
    define("M_w", N_M, "torque of the bearing on each caster", "-swap", FRONT),
    define("M_p", N_M, "torque on each caster that its bearing does not feel", "-swap", FRONT),
)
def torques(swivel_rate, swivel_eps, M_bearing, d_bearing):
    return -M_bearing * grip(swivel_rate, swivel_rate * swivel_rate, swivel_eps) - d_bearing * swivel_rate, per_wheel(0.0)


@stage(
    define("turning_torque", N_M, "torque that turns each caster, I Ω'", "-swap", FRONT),
    define("F_xf", N, "force of each caster on the chair along x_m", "+swap", FRONT),
    define("F_yf", N, "force of each caster on the chair along y_m", "-swap", FRONT),
    define("M_f", N_M, "moment of each caster's bearing on the chair", "-swap", FRONT),
)
def casters(swivel, rolling, D_f, d_f, M_w, M_p, F_caster, c, drag_eps, v_onset):
    """(6), (7), (8) without the casters' mass: rolling resistance along the heading, the tyre's force across it."""
    forward, right = cs.cos(swivel), cs.sin(swivel)
    drag = -(D_f / speed(rolling * rolling, drag_eps + v_onset) + d_f) * rolling
    return M_w + M_p - c * F_caster, drag * forward - F_caster * right, drag * right + F_caster * forward, -M_w


def turned_and_wound(turning_rate, turning_torque, C_caster, deflection, mu_caster, N_f, deflecting):
    """Power that turns the casters, and that winds their tyres without what the carcass damps."""
    wound = C_caster * deflection
    spring = wound / cs.sqrt(1 + (wound / (mu_caster * cs.fmax(N_f, LIGHTEST))) ** 2)
    return cs.sum1(turning_rate * turning_torque + spring * deflecting)


LAW = Alternative(
    "slipping",
    (leverage, patches, swivelling.turned, tyres, torques, casters),
    PARAMETERS,
    (
        Row(swivelling.SWIVEL, lambda: 1.0, lambda swivel_rate: swivel_rate, swivelling.trailing),
        Row(
            TURNING,
            lambda I_caster: per_wheel(I_caster),
            lambda turning_torque: turning_torque,
            lambda psi_dot: per_wheel(psi_dot),
        ),
        Row(DEFLECTED, lambda sigma_caster: per_wheel(sigma_caster), lambda deflecting: deflecting),
    ),
    loads=(one_trail, loads),
    serves=(swivelling.LAW.name,),
    absorbs=turned_and_wound,
)
