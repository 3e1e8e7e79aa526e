"""Profile-likelihood intervals: how far a parameter can go before the best of all others cannot make up for it.

Unlike estimate ± 1.96 standard errors they follow a valley that bends, and need not be symmetric (Venzon and Moolgavkar
1988). The threshold is widened by what correlated residuals do to the variance, and by what runs do that would have the
parameter elsewhere each: no model is exact.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
from scipy.optimize import brentq

from ...errors import SimulationError
from ...quantities import Parameter
from ..chance import student, value_beyond
from ..evidence.likelihood import Likelihood
from ..parallel import parallel_map
from .inverse import inverse
from .problem import Fit, Problem
from .score import RUNS
from .statistics import between_runs, degrees_between_runs, sandwich

LEVEL = 0.95
NORMAL = value_beyond(1 - LEVEL, 1) ** 0.5  # standard errors, at LEVEL
FARTHEST = 6.0  # robust standard errors; what is further off is not looked for
PRECISE = 0.03  # of a standard error
JUMP = 0.5  # of a standard error, within which no smooth likelihood falls so far
CORRECTIONS = 2  # steps of the other parameters towards their best


def profile_interval(likelihood: Likelihood, found: Fit, name: str) -> tuple[float, float]:
    """The interval (SI) of one fitted parameter at LEVEL; an end is its bound, or FARTHEST off, where the data set none.

    Where the likelihood jumps close by, as with casters that swing round or do not, that says nothing of how sure an estimate
    is: there an end is as far off as standard errors have it.
    """
    at = found.names.index(name)
    half = half_width(found, at)
    threshold, se = half**2 / found.covariance[at, at], half / NORMAL
    record, best, deviance = likelihood.records[name], found.values[name], _profile(likelihood, found, at)

    @cache
    def beyond(off: float) -> float:
        """Above 0 where the interval has ended. The root makes of a parabola a straight line, on which ends are soon found."""
        return float(np.sqrt(max(0.0, deviance(best + off) - found.deviance) / threshold)) - 1

    def end(side: float) -> float:
        bound = record.upper if side > 0 else record.lower
        reach = min(abs(bound - best), FARTHEST * se)
        near, far = 0.0, min(2.2 * se, reach)
        while beyond(side * far) < 0:
            if far >= reach:
                return best + side * reach
            near, far = far, min(1.6 * far, reach)
        distance = float(brentq(lambda d: beyond(side * d) if d else -1.0, near, far, xtol=PRECISE * se))
        return best + side * (distance if distance > JUMP * se else min(half, reach))

    if not se > 0:
        return best, best
    lower, upper = parallel_map(end, (-1.0, 1.0))
    return lower, upper


def half_width(found: Fit, at: int) -> float:
    """How far either way, by standard errors, a parameter may be: by residuals that last, or by runs that differ."""
    lasting, runs = NORMAL * float(np.sqrt(sandwich(found)[at, at])), len(found.evidence.runs)
    if runs < RUNS:
        return lasting
    return max(lasting, student(LEVEL, degrees_between_runs(found, at)) * float(np.sqrt(between_runs(found)[at, at])))


def interval_by_errors(found: Fit, at: int, allowed: float, record: Parameter) -> tuple[float, float]:
    """The interval (SI) of one fitted parameter by its standard errors, `widened`."""
    value, half = found.values[found.names[at]], half_width(found, at)
    return widened((value - half, value + half), value, allowed, record)


def widened(ends: tuple[float, float], value: float, allowed: float, record: Parameter) -> tuple[float, float]:
    """An interval of an estimate that may be off by something else as well, normal with this standard deviation, within bounds:
    squares of half widths add."""
    lower, upper = (float(np.hypot(end - value, NORMAL * allowed)) for end in ends)
    return max(value - lower, record.lower), min(value + upper, record.upper)


def _profile(likelihood: Likelihood, found: Fit, at: int) -> Callable[[float], float]:
    """The deviance by one parameter, the others where that lets them be."""
    deviance = profile(likelihood, found, (at,))
    return lambda value: deviance((value,))


def profile(
    likelihood: Likelihood, found: Fit, at: Sequence[int], corrections: int = CORRECTIONS
) -> Callable[[Sequence[float] | np.ndarray], float]:
    """The deviance by some parameters of a fit, the others where these let them be; infinity where the model cannot be
    simulated. The others follow by slopes, which `corrections` - 1 further steps improve."""
    problem, S = Problem(likelihood, found.names), found.evidence.S
    chosen = np.isin(np.arange(len(found.names)), at)
    A, best = problem.information(found.evidence), np.array([found.values[n] for n in found.names])
    known, where = inverse(A[np.ix_(~chosen, ~chosen)]), np.array(at)

    def deviance(values: Sequence[float] | np.ndarray) -> float:
        theta, lowest = best.copy(), np.inf
        theta[where] = values
        theta[~chosen] -= known @ A[np.ix_(~chosen, where)] @ (np.asarray(values) - best[where])
        for _ in range(corrections):
            theta[~chosen] = np.clip(theta, problem.lower, problem.upper)[~chosen]
            try:
                there = likelihood.resimulated(found.evidence, problem.values(theta))
            except SimulationError:
                break
            lowest = min(lowest, problem.deviance(there, theta))
            theta[~chosen] += known @ problem.gradient(S, there.r, theta)[~chosen]
        return lowest

    return deviance
