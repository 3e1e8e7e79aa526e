"""Profile-likelihood intervals: how far a parameter can go before the best of all others cannot make up for it.

Unlike estimate ± 1.96 standard errors they follow a valley that bends, and need not be symmetric (Venzon and Moolgavkar
1988). The threshold is widened by what correlated residuals do to the variance.
"""

from __future__ import annotations

import numpy as np
from scipy import stats
from scipy.optimize import brentq

from ..errors import SimulationError
from .evidence import Bench
from .fit import Fit, Problem
from .statistics import sandwich

LEVEL = 0.95
FARTHEST = 6.0  # robust standard errors; what is further off is not looked for
PRECISE = 0.03  # of a standard error
CORRECTIONS = 2  # steps of the other parameters towards their best


def profile_interval(bench: Bench, found: Fit, name: str) -> tuple[float, float]:
    """The interval (SI) of one fitted parameter at LEVEL; an end is its bound, or FARTHEST off, where the data set none."""
    at = found.names.index(name)
    se = float(np.sqrt(sandwich(found)[at, at]))
    threshold = stats.chi2.ppf(LEVEL, 1) * se**2 / found.covariance[at, at]
    record, best = bench.records[name], found.values[name]

    def above(value: float) -> float:
        return _profiled(bench, found, at, value) - found.misfit - threshold

    def end(side: float) -> float:
        bound = record.upper if side > 0 else record.lower
        reach = min(abs(bound - best), FARTHEST * se)
        near, far = 0.0, min(2.2 * se, reach)
        while above(best + side * far) < 0:
            if far >= reach:
                return best + side * reach
            near, far = far, min(1.6 * far, reach)
        return best + side * float(brentq(lambda d: above(best + side * d) if d else -threshold, near, far, xtol=PRECISE * se))

    if not se > 0:
        return best, best
    return end(-1.0), end(1.0)


def _profiled(bench: Bench, found: Fit, at: int, value: float) -> float:
    """The misfit with one parameter held, the others where that lets them be."""
    problem = Problem(bench, found.names)
    others = np.arange(len(found.names)) != at
    S, prior = found.evidence.S, problem.prior
    A = S.T @ S + prior.slopes**2
    inverse = np.linalg.pinv(A[np.ix_(others, others)], hermitian=True)
    theta = np.array([found.values[n] for n in found.names])
    step = value - theta[at]
    theta[at] = value
    theta[others] -= inverse @ A[others, at] * step
    lowest = np.inf
    for _ in range(CORRECTIONS):
        theta[others] = np.clip(theta, problem.lower, problem.upper)[others]
        try:
            there = bench.again(found.evidence, problem.values(theta))
        except SimulationError:
            break
        lowest = min(lowest, problem.misfit(there, theta))
        g = S.T @ there.r + prior.slopes @ prior.rows(theta)
        theta[others] += inverse @ g[others]
    return lowest

