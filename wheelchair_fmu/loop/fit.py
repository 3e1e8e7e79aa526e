"""Fit parameters to the evidence: `scipy.optimize.least_squares` on innovations, with priors as further rows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from ..errors import SimulationError
from ..quantities import Parameter
from .evidence import Bench, Evidence

REACH = 2.0  # standard deviations of the prior; a value further off is no calibration but another chair


@dataclass(frozen=True)
class Fit:
    """Values by name (SI), their covariance (k, k) before any allowance for misfit, and the evidence at them."""

    names: tuple[str, ...]
    values: Mapping[str, float]
    covariance: np.ndarray
    evidence: Evidence
    misfit: float  # −2 log likelihood and prior
    prior_slopes: np.ndarray

    def se(self, name: str) -> float:
        i = self.names.index(name)
        return float(np.sqrt(self.covariance[i, i]))


@dataclass(frozen=True)
class Prior:
    """What is known of each parameter before the campaign: mean and standard deviation (inf: nothing)."""

    mean: np.ndarray
    sd: np.ndarray

    def rows(self, theta: np.ndarray) -> np.ndarray:
        return (self.mean - theta) / self.sd

    @property
    def slopes(self) -> np.ndarray:
        """d(mean − θ)/σ, with the sign that sensitivities have."""
        return np.diag(1 / self.sd)


def prior_of(bench: Bench, names: Sequence[str]) -> Prior:
    """Calibrated values have the campaign's word; effects have none."""
    records = {p.name: p for p in bench.variant.parameters()}
    mean = np.array([start_value(bench, records[n]) for n in names])
    stated = bench.campaign.priors
    sd = [stated.get(n, np.inf if n.startswith("effect.") else records[n].uncertainty * (abs(m) or 1.0))
          for n, m in zip(names, mean, strict=True)]  # fmt: skip
    return Prior(mean, np.array(sd))


def start_value(bench: Bench, record: Parameter) -> float:
    return bench.campaign.known.get(record.name, bench.variant.values.get(record.name, record.default))


def fit(
    bench: Bench,
    names: Sequence[str],
    start: Mapping[str, float],
    *,
    precision: float = 1e-6,
    most: int = 12,
) -> Fit:
    """The most likely values of `names`, from `start`.

    Raises SimulationError where the model cannot be simulated at the start.
    """
    names = tuple(names)
    records = {p.name: p for p in bench.variant.parameters()}
    prior = prior_of(bench, names)
    lower = np.maximum([records[n].lower for n in names], prior.mean - REACH * prior.sd)
    upper = np.minimum([records[n].upper for n in names], prior.mean + REACH * prior.sd)
    scale = np.array([records[n].smallest_interesting or records[n].nominal for n in names])
    runs = bench.campaign.fit
    memory: dict[bytes, Evidence] = {}

    def at(theta: np.ndarray) -> Evidence:
        key = theta.tobytes()
        if key not in memory:
            memory[key] = bench.evidence(runs, dict(zip(names, theta, strict=True)), names)
        return memory[key]

    worst: list[float] = []

    def residuals(theta: np.ndarray) -> np.ndarray:
        try:
            e = at(theta)
        except SimulationError:
            if not worst:
                raise
            return np.full(size, 10 * worst[0])  # a wall: the search turns back where the model cannot run
        return np.concatenate([e.r, prior.rows(theta)])

    def slopes(theta: np.ndarray) -> np.ndarray:
        return -np.concatenate([at(theta).S, prior.slopes])

    theta = np.clip([start.get(n, records[n].default) for n in names], lower, upper)
    first = residuals(theta)
    size = len(first)
    worst.append(float(np.sqrt(np.mean(first**2))))
    if names:
        inside = np.clip(theta, lower + 1e-12 * scale, upper - 1e-12 * scale)
        found = least_squares(residuals, inside, jac=slopes, bounds=(lower, upper), x_scale=scale, ftol=precision,
                              xtol=1e-5, gtol=1e-10, max_nfev=most)  # fmt: skip
        theta = found.x
    values = dict(zip(names, map(float, theta), strict=True))
    evidence = at(theta)
    A = evidence.S.T @ evidence.S + prior.slopes**2
    covariance = np.linalg.pinv(A, hermitian=True) if names else np.zeros((0, 0))
    misfit = evidence.misfit + float(np.sum(prior.rows(theta) ** 2))
    return Fit(names, values, covariance, evidence, misfit, prior.slopes)
