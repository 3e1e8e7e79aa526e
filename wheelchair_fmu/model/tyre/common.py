"""What all tyre laws share: stiffnesses, slip, camber, and how force and torque sit on the wheel."""

from __future__ import annotations

from dataclasses import replace

import casadi as cs

from ...quantities import BAR, M_S, N_M, N_M_RAD, N_RAD, ONE, RAD, REAR, M, N, Parameter
from ..chassis import per_wheel
from ..smooth import direction, magnitude
from ..stage import define, stage
from . import NAMES

RATED = 4.0  # bar, the pressure of Table 1
REFERENCE = "Doria, Table 1: tyre A, 4 bar, 400 N, 4 km/h"

PARAMETERS = (
    Parameter(
        "tyre.law",
        ONE,
        "how the tyre's lateral force follows slip",
        default=1,
        lower=1,
        upper=len(NAMES),
        choices=NAMES,
        fixed=True,
        symbol="tyre_law",
    ),
    Parameter(
        "tyre.C_lambda", N_RAD, "cornering stiffness C_λ of one tyre", default=5038.0, lower=1.0, upper=1e6, source=REFERENCE
    ),
    Parameter(
        "tyre.C_m_lambda",
        N_M_RAD,
        "self-aligning stiffness C_mλ of one tyre",
        default=45.0,
        lower=0.0,
        upper=1e4,
        source=REFERENCE,
    ),
    Parameter("tyre.C_phi", N_RAD, "camber stiffness C_φ of one tyre", default=464.0, lower=0.0, upper=1e5, source=REFERENCE),
    Parameter(
        "tyre.C_m_phi",
        N_M_RAD,
        "twisting torque stiffness C_mφ of one tyre",
        default=3.0,
        lower=0.0,
        upper=1e3,
        source="chosen: not in the paper's text",
    ),
    Parameter(
        "tyre.pressure",
        BAR,
        "inflation pressure p; C_λ, C_mλ and f_r hold at 4 bar",
        default=4.0,
        lower=0.5,
        upper=12.0,
        source=REFERENCE,
    ),
    Parameter(
        "tyre.pressure_F",
        ONE,
        "exponent of the pressure in the cornering stiffness",
        default=0.62,
        lower=-2.0,
        upper=2.0,
        source="fitted to examples/rotating-disc.csv, which is simulated; Doria, Fig. 6.1, has the trend",
    ),
    Parameter(
        "tyre.pressure_M",
        ONE,
        "exponent of the pressure in the self-aligning stiffness",
        default=-0.64,
        lower=-2.0,
        upper=2.0,
        source="fitted to examples/rotating-disc.csv, which is simulated; Doria, Fig. 6.2, has the trend",
    ),
    Parameter(
        "tyre.pressure_D",
        ONE,
        "exponent of the pressure in the rear wheels' rolling resistance",
        default=-0.4,
        lower=-3.0,
        upper=0.0,
        source="chosen: a third more at half the pressure; Sawatzky2005, Ott2020",
    ),
    Parameter(
        "tyre.mu",
        ONE,
        "friction coefficient μ (Dugoff and Magic Formula; under every law what brakes can use)",
        default=1.0,
        lower=0.05,
        upper=5.0,
        source="chosen: the paper's curves do not saturate",
    ),
    Parameter(
        "tyre.c_p",
        M,
        "pneumatic trail c_p at 4 bar (Dugoff)",
        default=45.0 / 5038.0,
        lower=0.0,
        upper=0.2,
        source="C_mλ/C_λ of Table 1",
    ),
    Parameter(
        "tyre.force.C",
        ONE,
        "shape factor C of the lateral force (Magic Formula); with more than 2 a tyre that slides would be driven aside",
        default=1.3,
        lower=0.1,
        upper=2.0,
        symbol="force_C",
        source="Pacejka: the usual value for a lateral force",
    ),
    Parameter(
        "tyre.force.E",
        ONE,
        "curvature factor E of the lateral force (Magic Formula)",
        default=0.0,
        lower=-20.0,
        upper=1.0,
        symbol="force_E",
        source="chosen",
    ),
    Parameter(
        "tyre.torque.C",
        ONE,
        "shape factor C of the self-aligning torque (Magic Formula)",
        default=2.0,
        lower=0.1,
        upper=4.0,
        symbol="torque_C",
        source="chosen: falls again beyond its peak",
    ),
    Parameter(
        "tyre.torque.D",
        N_M,
        "peak D of the self-aligning torque (Magic Formula)",
        default=1.7,
        lower=0.01,
        upper=100.0,
        symbol="torque_D",
        source="chosen: level of Fig. 9 in the reference condition",
    ),
    Parameter(
        "tyre.torque.E",
        ONE,
        "curvature factor E of the self-aligning torque (Magic Formula)",
        default=0.0,
        lower=-20.0,
        upper=1.0,
        symbol="torque_E",
        source="chosen",
    ),
    Parameter(
        "regularisation.slip_speed",
        M_S,
        "speed ε in |v_x| ≈ √(v_x² + ε²), below which slip angles fade",
        default=0.01,
        lower=1e-5,
        upper=1.0,
        symbol="v_eps",
        source="chosen",
    ),
)


def parameters(laws: tuple[str, ...]) -> tuple[Parameter, ...]:
    """The same, with these laws to choose from."""
    return tuple(replace(p, choices=laws, upper=len(laws)) if p.name == "tyre.law" else p for p in PARAMETERS)


@stage(
    define("q_F", ONE, "cornering stiffness of each rear tyre beside C_λ", "+swap", REAR),
    define("q_M", ONE, "self-aligning stiffness of each rear tyre beside C_mλ", "+swap", REAR),
    define("q_D", ONE, "rolling resistance coefficient of each rear tyre beside f_r", "+swap", REAR),
)
def inflation(pressure, pressure_F, pressure_M, pressure_D):
    """Stiffness of a soft tyre falls with its pressure; its trail and its rolling resistance grow."""
    log_p = cs.log(pressure / RATED)
    return tuple(per_wheel(cs.exp(exponent * log_p)) for exponent in (pressure_F, pressure_M, pressure_D))


@stage(
    define("k_F", N_RAD, "cornering stiffness of each rear tyre", "+swap", REAR),
    define("k_M", N_M_RAD, "self-aligning stiffness of each rear tyre", "+swap", REAR),
    define("phi", RAD, "camber angle of each rear wheel, positive when it leans to the right", "-swap", REAR),
)
def tyres(C_lambda, C_m_lambda, q_F, q_M):
    return C_lambda * q_F, C_m_lambda * q_M, per_wheel(0.0)


@stage(
    define("s", ONE, "direction of rolling: +1 forward, −1 in reverse, 0 at rest", "+swap", REAR),
    define("lam", RAD, "slip angle λ of each rear wheel", "-swap", REAR),
)
def slip(v_xw, v_yw, v_eps):
    """(11), (12) for either direction; v_y / ε, a damper, at rest."""
    return direction(v_xw, v_eps), -cs.atan2(v_yw, magnitude(v_xw, v_eps))


@stage(
    define("s", ONE, "direction of rolling: always forward", "+swap", REAR),
    define("lam", RAD, "slip angle λ of each rear wheel", "-swap", REAR),
)
def slip_paper(v_xw, v_yw):
    """(11), (12) to the letter."""
    return per_wheel(1.0), -v_yw / v_xw


@stage(define("lam_F", RAD, "slip angle that force and torque follow", "-swap", REAR))
def followed_slip(lam):
    return lam


@stage(
    define("F_s", N, "lateral force F_s of each rear tyre", "-swap", REAR),
    define("M_t", N_M, "torque M of each rear tyre about the vertical", "-swap", REAR),
)
def tyre_forces(F_lam, M_lam, phi, s, C_phi, C_m_phi, side, locked, braking, sliding, v_yw):
    """(13)–(16). In reverse the trail lies on the other side; camber pushes no wheel at rest. A locked wheel only slides."""
    F_s = side * (F_lam + C_phi * phi * s * s) - locked * braking / sliding * v_yw
    return F_s, side * s * (M_lam + C_m_phi * phi)
