"""The Dugoff law, (2)–(5)."""

from __future__ import annotations

import casadi as cs

from ...quantities import N_M, REAR, N
from ..stage import Alternative, define, stage
from .linear import LIGHTEST
from .magic_formula import friction


@stage(define("F_lam", N, "lateral force by slip of each rear tyre", "-swap", REAR))
def dugoff_force(k_F, lam_F, inv_mu, N_r):
    pull = k_F * cs.tan(lam_F)
    inv_gamma = 2 * cs.fabs(pull) * inv_mu / cs.fmax(N_r, LIGHTEST)  # (4)
    gamma = 1 / cs.fmax(inv_gamma, 1)
    return pull * gamma * (2 - gamma)  # (2), (5)


@stage(define("M_lam", N_M, "self-aligning torque of each rear tyre, rolling forward", "-swap", REAR))
def dugoff_torque(F_lam, c_p, q_F, q_M):
    """The trail is what is left of the torque's stiffness beside the force's: on a soft or lightly loaded tyre not c_p."""
    return -F_lam * c_p * q_M / q_F  # (3)


LAW = Alternative("dugoff", (friction, dugoff_force, dugoff_torque))
