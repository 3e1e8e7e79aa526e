"""Rolling resistance and brakes, (17) and the drag terms of (20)."""

from __future__ import annotations

import casadi as cs

from ..quantities import FRONT, M_S, N_S_M, ONE, REAR, N, Parameter
from .chassis import per_wheel
from .smooth import grip
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
        "brake.F_max",
        N,
        "braking force of one fully applied brake",
        default=300.0,
        lower=0.0,
        upper=5000.0,
        source="chosen: holds 80 kg on a slope of 1 in 1.6 with both",
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


@stage(
    define("D_f", N, "rolling resistance of each caster", "+swap", FRONT),
    define("D_r", N, "rolling resistance of each rear wheel", "+swap", REAR),
)
def rolling_resistance(f_f, f_r, rolling_factor, N_f, N_r):
    """(17), for wheels that touch the ground."""
    return f_f * rolling_factor * cs.fmax(N_f, 0), f_r * rolling_factor * cs.fmax(N_r, 0)


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
def rear_longitudinal(F_t, D_w, d_r, brake_rl, brake_rr, F_max, v_xw, drag_eps):
    """Traction less what opposes the hub's motion, forward or backward."""
    braking = F_max * cs.vertcat(brake_rl, brake_rr)
    return F_t - (D_w + braking) * grip(v_xw, v_xw * v_xw, drag_eps) - d_r * v_xw


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
