"""Fitting Dugoff's law (2)–(5): C_λ and μ to the force, then the trail c_p to the torque."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import laws
from .fitting import Estimate, Prior, Shape, bent, estimate, positive, straight
from .half_difference import Curve

_SHAPE = Shape(np.array([True, True]))  # ln C_λ, ln μN


@dataclass(frozen=True, eq=False)
class Dugoff:
    """C_λ [N/rad], μ, c_p [m] (None without torques), and what they leave, in N and N m."""

    C_lambda: Estimate
    mu: Estimate
    c_p: Estimate | None
    rms_force: float
    rms_torque: float | None
    load: float

    def force(self, angle: np.ndarray) -> np.ndarray:
        """F_s (n,) N at slip angles (n,) rad."""
        return laws.evaluate("dugoff", angle, np.array([self.C_lambda.value, self.mu.value * self.load]))

    def torque(self, angle: np.ndarray) -> np.ndarray:
        """M (n,) N m, (3)."""
        assert self.c_p is not None
        return -self.c_p.value * self.force(angle)


def dugoff(force: Curve, torque: Curve | None, slope: float, load: float) -> Dugoff:
    """The fit to a force that bends, with the slope at the origin of about `slope` N/rad, at this load in N."""
    steep, top = np.log(slope), np.log(force.largest)
    prior = Prior(np.array([steep - 1, top - 0.5]), np.array([steep + 1, top + 3]), np.zeros(2), np.full(2, np.inf))
    starts = [np.array([steep, top + up]) for up in (0.1, 0.4, 1.0)]
    fit = bent(force, "dugoff", starts, prior, _SHAPE)
    variances = (None, None) if fit.covariance is None else np.diag(fit.covariance)
    C, D = (positive(float(z), v, fit.freedom) for z, v in zip(fit.numbers, variances, strict=True))
    law = Dugoff(C, D.scaled(1 / load), None, fit.rms, None, load)
    if torque is None:
        return law
    arm = straight(torque, -law.force(torque.angle)[:, None])  # (3)
    variance = None if arm.covariance is None else float(arm.covariance[0, 0])
    trail = estimate(float(arm.numbers[0]), variance, arm.freedom)
    return Dugoff(C, law.mu, trail, fit.rms, arm.rms, load)
