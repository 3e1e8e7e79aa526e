"""Rear wheels whose spin is a state: they lock under a brake, spin under a push, and both cost side grip.

With w = ωR the speed of a wheel's rim, I its moment of inertia, F_t the push and F_x what its patch pulls with,

    (I/R²) w' = F_t − (D + B) sign(w) − d w − F_x

where D and d are its rolling resistance, dry and per speed, and B the brake. The chair feels F_x and nothing else of these. The
patch slides along the wheel with s = w − v_x, and pulls with P = C_κ s/|v_x| as long as that is little beside μN. Within the
friction circle it uses β = |P/μN| / (1 + |P/μN|⁸)^⅛ of μN, and keeps √(1 − β²) of its side force. Beyond it slides: its
friction is then against the way that the patch slides on the floor, (−s, v_y), whether its wheel stands or spins. Between the
two it is some of each, as (P/μN)⁸ says, so that no force jumps.

It only loses energy: of what the rim gives, w F_x, the hub gets v_x F_x, and s F_x is never below zero. With a light wheel, a
stiff patch, and no push or brake near friction, it is the law `rolling`; a heavy wheel is its effect `wheel_inertia` there, and
a soft patch its `longitudinal_slip`. Here that inertia is the wheel's own, to which `wheel_inertia` would add, and so is the
slip of its patch, to which `longitudinal_slip` adds nothing.
"""

from __future__ import annotations

import casadi as cs

from ...quantities import KG_M2, M_S, REAR, N, Parameter, State
from ..resistance import LIGHTEST
from ..smooth import magnitude, speed
from ..stage import Alternative, Row, define, stage
from .rolling import ALONG, FRICTION, SLIDING

PARAMETERS = (
    Parameter(
        "wheel.I",
        KG_M2,
        "moment of inertia I of each rear wheel about its axle",
        default=0.14,
        lower=1e-3,
        upper=5.0,
        symbol="I_wheel",
        source="published wheelchair models: 0.14 kg m²",
    ),
    Parameter(
        "tyre.C_kappa",
        N,
        "longitudinal slip stiffness C_κ of each rear tyre, its force per share by which the rim is faster than the hub",
        default=1e4,
        lower=100.0,
        upper=1e6,
        symbol="C_kappa",
        source="chosen: twice C_λ",
    ),
)
SPIN = State("rim", M_S, "speed of each rear wheel's rim about its axle, ωR", "+swap", REAR, symbol="rim_speed", usual=1.0)


@stage(
    define("slid", M_S, "how much faster each rear wheel's rim is than its hub", "+swap", REAR),
    define("pull", N, "pull of each rear wheel's patch, as if friction had no limit", "+swap", REAR),
)
def creep(rim_speed, v_xw, C_kappa, v_eps):
    slid = rim_speed - v_xw
    return slid, C_kappa * slid / magnitude(v_xw, v_eps)


@stage(*FRICTION, define("held", N, "pull of each rear wheel's patch, as far as friction holds it", "+swap", REAR))
def friction_circle(pull, mu, N_r):
    limit = mu * cs.fmax(N_r, LIGHTEST)
    P2 = (pull / limit) ** 2
    P4 = P2 * P2
    whole = 1 + P4 * P4
    root = cs.sqrt(cs.sqrt(whole))  # P²/β²
    left = 1 / cs.sqrt(root * (root + P2) * (root * root + P4))  # √(1 − β²), without a difference of what is nearly equal
    held = pull / cs.sqrt(root)
    return 1 - 1 / whole, cs.fabs(held), left / whole, held


@stage(SLIDING)
def patches(slid, v_yw, locked, drag_eps):
    return speed(slid * slid + locked * v_yw * v_yw, drag_eps)


@stage(*ALONG, define("turned_by", N, "what turns each rear wheel about its axle, over R", "+swap", REAR))
def rear_longitudinal(F_t, D_w, d_r, brake_rl, brake_rr, F_max, held, sliding, slid, rim_speed, drag_eps, v_onset):
    """The patch's force has its share along the wheel; the brake and what resists rolling are against the spin."""
    F_w = held * speed(slid * slid, drag_eps) / sliding
    squared = rim_speed * rim_speed
    brake = F_max * cs.vertcat(brake_rl, brake_rr) / speed(squared, drag_eps)
    against = D_w / speed(squared, drag_eps + v_onset) + brake + d_r
    return F_w, rim_speed, 0 * F_t, F_t - against * rim_speed - F_w


def spun(rim_speed, turned_by):
    """Power that turns the wheels."""
    return cs.sum1(rim_speed * turned_by)


LAW = Alternative(
    "spinning",
    (creep, friction_circle, patches, rear_longitudinal),
    PARAMETERS,
    (Row(SPIN, lambda I_wheel, R: cs.vertcat(I_wheel, I_wheel) / R**2, lambda turned_by: turned_by, lambda v_xw: v_xw),),
    absorbs=spun,
)
