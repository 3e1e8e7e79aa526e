"""The linear law of (13)–(16), written as the Magic Formula's limit 1/μ → 0.

With `inv_mu` zero the force is C_λ λ exactly; the effect `tyre_saturation` is nothing but `inv_mu`.
"""

from __future__ import annotations

import casadi as cs

from ...quantities import N_M, ONE, REAR, N
from ..smooth import sine_over
from ..stage import Alternative, define, stage

LIGHTEST = 1.0  # N; a wheel that carries less than this is off the ground


@stage(define("inv_mu", ONE, "inverse friction coefficient 1/μ"))
def endless_friction():
    return 0.0


@stage(
    define("F_lam", N, "lateral force by slip of each rear tyre", "-swap", REAR),
    define("bend", ONE, "lateral force by slip of each rear tyre beside what its stiffness would give", "+swap", REAR),
)
def magic_force(k_F, lam_F, inv_mu, N_r, force_C, force_E):
    """(1) with D = μN and BCD = C_λ: C_λ λ times what the bend leaves of it."""
    bend = sine_over(k_F * lam_F * inv_mu / (force_C * cs.fmax(N_r, LIGHTEST)), force_C, force_E)
    return k_F * lam_F * bend, bend


@stage(define("M_lam", N_M, "self-aligning torque of each rear tyre, rolling forward", "-swap", REAR))
def linear_torque(k_M, lam_F, bend):
    """(15), (16): a force that bends over is C_mλ/C_λ behind the hub as before, and so the torque bends over with it."""
    return -k_M * lam_F * bend


LAW = Alternative("linear", (endless_friction, magic_force, linear_torque))
