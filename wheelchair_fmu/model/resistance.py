"""Rolling resistance, (17), and what else drags on wheels; how wheels turn that into forces on the chair is a wheel law's."""

from __future__ import annotations

import casadi as cs

from ..quantities import FRONT, M_S, N_S_M, ONE, REAR, N, Parameter
from .chassis import per_wheel
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


@stage(
    define("F_xr", N, "force of each rear wheel on the chair along x_m", "+swap", REAR),
    define("F_yr", N, "force of each rear wheel on the chair along y_m", "-swap", REAR),
)
def rear_forces(F_w, F_s):
    """The rear wheels point straight ahead."""
    return F_w, F_s
