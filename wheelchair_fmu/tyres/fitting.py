"""Least squares for one curve: values, covariance and intervals, and how the scatter compares with the noise."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import stats
from scipy.optimize import least_squares

from . import laws
from .half_difference import Curve

CONFIDENCE = 0.95


@dataclass(frozen=True)
class Estimate:
    """A value, its standard error and its interval at CONFIDENCE; None where the data do not tell them."""

    value: float
    se: float | None = None
    low: float | None = None
    high: float | None = None

    @property
    def interval(self) -> tuple[float, float] | None:
        return None if self.low is None or self.high is None else (self.low, self.high)

    def scaled(self, factor: float) -> Estimate:
        ends = self.interval
        low, high = (None, None) if ends is None else sorted(factor * e for e in ends)
        return Estimate(factor * self.value, None if self.se is None else abs(factor) * self.se, low, high)


def estimate(value: float, variance: float | None, freedom: int) -> Estimate:
    """By Student's t with these degrees of freedom."""
    if variance is None or freedom < 1:
        return Estimate(value)
    se = float(np.sqrt(variance))
    reach = float(stats.t.ppf(0.5 + CONFIDENCE / 2, freedom)) * se
    return Estimate(value, se, value - reach, value + reach)


def positive(logarithm: float, variance: float | None, freedom: int) -> Estimate:
    """The same for a value that is known by its logarithm: its interval stays positive."""
    of_log = estimate(logarithm, variance, freedom)
    value = float(np.exp(logarithm))
    if of_log.low is None or of_log.high is None or of_log.se is None:
        return Estimate(value)
    return Estimate(value, value * of_log.se, float(np.exp(of_log.low)), float(np.exp(of_log.high)))


@dataclass(frozen=True)
class Prior:
    """What is known beforehand of a law's fitted numbers (k,): bounds, and mean and standard deviation (∞: nothing)."""

    lower: np.ndarray
    upper: np.ndarray
    mean: np.ndarray
    deviation: np.ndarray


@dataclass(frozen=True, eq=False)
class Fit:
    """Fitted numbers (k,), their covariance (k, k), or None where nothing tells the noise, and what is left.

    `rms` is over all angles, in the unit of the curve. `misfit` is the probability that noise alone leaves so much.
    """

    numbers: np.ndarray
    covariance: np.ndarray | None
    freedom: int
    rms: float
    misfit: float | None


def straight(curve: Curve, columns: np.ndarray) -> Fit:
    """The combination of `columns` (n, k) nearest to the curve: linear least squares."""
    numbers, *_ = np.linalg.lstsq(columns, curve.value, rcond=None)
    return _judged(curve, columns @ numbers - curve.value, columns, numbers)


def bent(curve: Curve, law: str, starts: Sequence[np.ndarray], prior: Prior, shape: Shape) -> Fit:
    """The numbers of a nonlinear law nearest to the curve and to what was known beforehand, from the best of `starts`.

    The curve must know its noise.
    """
    f = laws.at(law, curve.angle)
    sigma = curve.sigma
    assert sigma is not None

    def residual(z: np.ndarray) -> np.ndarray:
        return np.r_[(f(shape.parameters(z)) - curve.value) / sigma, (z - prior.mean) / prior.deviation]

    def jacobian(z: np.ndarray) -> np.ndarray:
        return np.vstack([f.jacobian(shape.parameters(z)) * shape.slopes(z) / sigma, np.diag(1 / prior.deviation)])

    inside = [np.clip(z, prior.lower + 1e-6, prior.upper - 1e-6) for z in starts]
    found = [
        least_squares(
            residual,
            z,
            jacobian,
            bounds=(prior.lower, prior.upper),
            x_scale="jac",
            xtol=1e-10,
            ftol=1e-10,
            gtol=1e-10,
            max_nfev=200,
        )
        for z in inside
    ]
    best = min(found, key=lambda each: float(each.cost))
    left = f(shape.parameters(best.x)) - curve.value
    return _judged(curve, left, f.jacobian(shape.parameters(best.x)) * shape.slopes(best.x), best.x, prior.deviation)


@dataclass(frozen=True)
class Shape:
    """Which of a law's parameters are fitted by their logarithm."""

    logarithmic: np.ndarray

    def parameters(self, numbers: np.ndarray) -> np.ndarray:
        return np.where(self.logarithmic, np.exp(np.where(self.logarithmic, numbers, 0.0)), numbers)

    def slopes(self, numbers: np.ndarray) -> np.ndarray:
        return np.where(self.logarithmic, self.parameters(numbers), 1.0)


def _judged(
    curve: Curve, left: np.ndarray, jacobian: np.ndarray, numbers: np.ndarray, deviation: np.ndarray | None = None
) -> Fit:
    """The fit with its uncertainty: by the noise that the half sums show, by the scatter about the law where it is larger."""
    n, k = jacobian.shape
    spare = n - k
    square = float(left @ left)
    rms = float(np.sqrt(square / n))
    known = curve.sigma
    if known is None and (spare < 1 or square == 0):
        return Fit(numbers, None, 0, rms, None)
    variance = square / spare if known is None else known**2 * max(1.0, square / known**2 / spare if spare > 0 else 1.0)
    freedom = spare if known is None else curve.freedom
    information = jacobian.T @ jacobian / variance
    if deviation is not None:
        information = information + np.diag(deviation**-2)
    misfit = None if known is None or spare < 1 else float(stats.f.sf(square / spare / known**2, spare, curve.freedom))
    return Fit(numbers, np.linalg.pinv(information), freedom, rms, misfit)
