"""Rolling resistance and brakes, (17) and the drag terms of (20)."""

from __future__ import annotations

import casadi as cs

from ..quantities import FRONT, M_S, N_S_M, ONE, REAR, N, Parameter
from .chassis import per_wheel
from .smooth import speed
from .stage import define, stage

PARAMETERS = (
    Parameter(
        "resistance.f_r",
        ONE,
        "rolling resistance coefficient f_r of the rear wheels",
        default=0.012,
        lower=0.0,
        upper=1.0,
        uncertainty=0.6,
        source="chosen: Hoffman2003 gives 0.012 in total; not in the paper's text",
    ),
    Parameter(
        "resistance.f_f",
        ONE,
        "rolling resistance coefficient f_f of the casters",
        default=0.020,
        lower=0.0,
        upper=1.0,
        uncertainty=0.6,
        source="chosen: smaller wheels than the rear; not in the paper's text",
    ),
    Parameter(
        "resistance.onset",
        M_S,
        "speed over which rolling resistance builds up from rest; 0: at once, so that a chair stands on a slope",
        lower=0.0,
        upper=0.1,
        nominal=0.01,
        symbol="v_onset",
        source="chosen: tyres that hold on at once; one that creeps as it lets go has some mm/s",
        known_to=0.01,
    ),
    Parameter(
        "brake.F_max",
        N,
        "braking force of one fully applied brake, as far as the tyre holds it: beyond tyre.mu times its load the wheel locks",
        default=300.0,
        lower=0.0,
        upper=5000.0,
        source="chosen: locks a wheel under the load of Table 1",
    ),
    Parameter(
        "regularisation.drag_speed",
        M_S,
        "speed within which dry resistance builds up; a chair it holds creeps no faster than about this",
        default=4e-5,
        lower=1e-7,
        upper=0.1,
        symbol="drag_eps",
        source="chosen",
    ),
)


LIGHTEST = 1.0  # N; a wheel that carries less is off the ground
ROUNDED = 1e-12  # keeps what a brake leaves of side force above zero, where rounding could take it below


@stage(
    define("locked", ONE, "0 where a rear wheel rolls, 1 where its brake has locked it", "+swap", REAR),
    define("braking", N, "friction that the brake of each rear wheel uses, μN where it is locked", "+swap", REAR),
    define("side", ONE, "share of its side force that braking leaves a rear wheel", "+swap", REAR),
)
def brakes(brake_rl, brake_rr, F_max, mu, N_r):
    """The friction circle: braking and side force together reach μN at most.

    With F the brake's force over μN, a wheel uses β = F / (1 + F⁸)^⅛ of μN and keeps √(1 − β²) of its side force. Beyond F = 1
    it locks: then it has no side force, and its friction is against the way that its patch slides. Between the two it is some
    of each, as F⁸ says, so that no force jumps; a light hand on the brake is passed on whole.
    """
    limit = mu * cs.fmax(N_r, LIGHTEST)
    F = F_max * cs.vertcat(brake_rl, brake_rr) / limit
    F2 = F * F
    rolling = 1 / (1 + F2 * F2 * F2 * F2)
    fourth = cs.sqrt(cs.sqrt(rolling))
    left = cs.sqrt(1 - F2 * (fourth - ROUNDED))  # √(1 − β²)
    return 1 - rolling, limit * F * cs.sqrt(fourth), rolling * left


@stage(
    define("locked", ONE, "0 where a rear wheel rolls, 1 where its brake has locked it", "+swap", REAR),
    define("braking", N, "friction that the brake of each rear wheel uses, μN where it is locked", "+swap", REAR),
    define("side", ONE, "share of its side force that braking leaves a rear wheel", "+swap", REAR),
)
def brakes_paper():
    """There are none in the paper."""
    return per_wheel(0.0), per_wheel(0.0), per_wheel(1.0)


@stage(define("sliding", M_S, "speed over which each rear wheel's dry friction acts", "+swap", REAR))
def patches(v_xw, v_yw, locked, drag_eps, v_onset):
    """A wheel that rolls resists along its plane, one that is locked whichever way it slides, and that at once."""
    return speed(v_xw * v_xw + locked * v_yw * v_yw, drag_eps + (1 - locked) * v_onset)


@stage(
    define("D_f", N, "rolling resistance of each caster", "+swap", FRONT),
    define("D_r", N, "rolling resistance of each rear wheel", "+swap", REAR),
)
def rolling_resistance(f_f, f_r, q_D, rolling_factor, N_f, N_r):
    """(17), for wheels that touch the ground."""
    return f_f * rolling_factor * cs.fmax(N_f, 0), f_r * q_D * rolling_factor * cs.fmax(N_r, 0)


@stage(define("D_w", N, "dry drag of each rear wheel", "+swap", REAR))
def dry_drag(D_r):
    """Nothing but its rolling resistance."""
    return D_r


@stage(
    define("d_f", N_S_M, "rolling resistance of each caster per speed", "+swap", FRONT),
    define("d_r", N_S_M, "rolling resistance of each rear wheel per speed", "+swap", REAR),
)
def viscous_resistance():
    """None: (17) does not depend on speed."""
    return per_wheel(0.0), per_wheel(0.0)


@stage(define("F_w", N, "force of each rear wheel along its plane", "+swap", REAR))
def rear_longitudinal(F_t, D_w, d_r, locked, braking, sliding, v_xw):
    """Traction less what opposes the hub's motion, forward or backward."""
    return F_t - (((1 - locked) * D_w + braking) / sliding + d_r) * v_xw


@stage(define("F_w", N, "force of each rear wheel along its plane", "+swap", REAR))
def rear_longitudinal_paper(F_t, D_w, d_r, v_xw):
    """As in (20): always forward, so resistance is constant."""
    return F_t - D_w - d_r * v_xw


@stage(
    define("F_xr", N, "force of each rear wheel on the chair along x_m", "+swap", REAR),
    define("F_yr", N, "force of each rear wheel on the chair along y_m", "-swap", REAR),
)
def rear_forces(F_w, F_s):
    """The rear wheels point straight ahead."""
    return F_w, F_s
