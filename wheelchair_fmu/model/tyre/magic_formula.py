"""The Magic Formula (1) for the lateral force and the self-aligning torque.

B and D follow from what users know: D = μN and BCD = C_λ for the force; D and BCD = C_mλ for the torque.
"""

from __future__ import annotations

from ...quantities import N_M, ONE, REAR
from ..smooth import sine_over
from ..stage import Alternative, define, stage
from .linear import magic_force


@stage(define("inv_mu", ONE, "inverse friction coefficient 1/μ"))
def friction(mu):
    return 1 / mu


@stage(define("M_lam", N_M, "self-aligning torque of each rear tyre, rolling forward", "-swap", REAR))
def magic_torque(k_M, lam_F, torque_C, torque_D, torque_E):
    Bx = k_M * lam_F / (torque_C * torque_D)
    return -k_M * lam_F * sine_over(Bx, torque_C, torque_E)  # (1)


LAW = Alternative("magic_formula", (friction, magic_force, magic_torque))
