"""What is fitted: parameters with their bounds, scales and priors, on a likelihood; and what a fit is."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from ...errors import SimulationError
from ..evidence.evidence import Evidence
from ..evidence.likelihood import Likelihood
from .inverse import inverse

GROUPED = 10.0  # δ: standard deviation of each of several parameters of one effect, where the data say nothing of it
AT_BOUND = 1e-3  # of a parameter's scale
STEEPEST = 1e100  # slope in standard deviations per unit, of whose squares no computer loses count
REACH = 4.0  # standard deviations of the prior; a value further off is no calibration but another chair
STRAIGHT = 1.0  # −2 log likelihood: a descent that falls by less has gone no further than a standard error, where slopes hold


@dataclass(frozen=True)
class Fit:
    """Values by name (SI), their covariance (k, k) before any allowance for laws that are not exact, and the evidence at them;
    `lower` and `upper` (k,) are how far the fit might go, where it was not free to go anywhere. The deviance is −2 log
    posterior, but for a constant."""

    names: tuple[str, ...]
    values: Mapping[str, float]
    covariance: np.ndarray
    evidence: Evidence
    deviance: float
    prior_slopes: np.ndarray
    lower: np.ndarray | None = None
    upper: np.ndarray | None = None


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


def prior_of(likelihood: Likelihood, names: Sequence[str]) -> Prior:
    """Calibrated values have the campaign's word, or as much as chairs differ by where nobody gave one's; constants of effects
    have their records', and so have sizes that were measured. Other sizes of effects have none, but that of several parameters
    which the data cannot tell apart each is taken to be no larger than it must be."""
    mean = np.array([*start_values(likelihood, names).values()])
    groups = Counter(n.rpartition(".")[0] for n in names if likelihood.records[n].estimated)

    def sd(name: str, mean: float) -> float:
        if name in likelihood.campaign.priors:
            return likelihood.campaign.priors[name]
        if sizes_an_effect(likelihood, name):
            return GROUPED * likelihood.records[name].delta if groups[name.rpartition(".")[0]] > 1 else np.inf
        if name in likelihood.offsets:
            return likelihood.campaign.nuisance_sd.get(likelihood.offsets[name], np.inf)
        record = likelihood.records[name]
        nobody_gave = name not in likelihood.campaign.known and name not in likelihood.variant.values
        return record.among_chairs if record.among_chairs and nobody_gave else record.prior_sd(mean)

    return Prior(mean, np.array([sd(n, m) for n, m in zip(names, mean, strict=True)]))


def sizes_an_effect(likelihood: Likelihood, name: str) -> bool:
    """Does a parameter say how large an effect is, so that nothing is known of it beforehand? Of one that the campaign gives
    something is known where its record says how well labs measure such a size, or the campaign itself."""
    record, campaign = likelihood.records[name], likelihood.campaign
    measured = name in campaign.priors or (name in campaign.known and record.known_to is not None)
    return record.estimated and name.startswith("effect.") and not measured


def start_values(likelihood: Likelihood, names: Sequence[str]) -> dict[str, float]:
    """Values as the campaign gives them, or else the chair, or as they are usual."""
    given = {**likelihood.variant.values, **likelihood.campaign.known}
    return {n: given.get(n, likelihood.records[n].default) for n in names}


class Problem:
    """Parameters to fit on a likelihood: their bounds, scale and prior."""

    def __init__(self, likelihood: Likelihood, names: Sequence[str]):
        records = likelihood.records
        self.likelihood, self.names, self.prior = likelihood, tuple(names), prior_of(likelihood, names)
        reach = np.where([sizes_an_effect(likelihood, n) for n in names], np.inf, REACH * self.prior.sd)
        self.lower = np.maximum([records[n].lower for n in names], self.prior.mean - reach)
        self.upper = np.minimum([records[n].upper for n in names], self.prior.mean + reach)
        self.scale = np.array([records[n].smallest_interesting or records[n].nominal for n in names])

    def inside(self, start: Mapping[str, float]) -> np.ndarray:
        return np.clip([start.get(n, self.likelihood.records[n].default) for n in self.names], self.lower, self.upper)

    def values(self, theta: np.ndarray) -> dict[str, float]:
        return dict(zip(self.names, map(float, theta), strict=True))

    def linearised(self, theta: np.ndarray) -> Evidence:
        """Raises SimulationError too where slopes lead nowhere."""
        found = self.likelihood.evidence(self.likelihood.campaign.fit, self.values(theta), self.names)
        if not np.abs(found.S).max(initial=0.0) < STEEPEST:
            raise SimulationError("slopes by the parameters are beyond all numbers, as of casters that flip by chance")
        return found

    def at(self, theta: np.ndarray, tune_start: int) -> Evidence | None:
        """Evidence there without slopes; None where the model cannot run."""
        try:
            return self.likelihood.evidence(self.likelihood.campaign.fit, self.values(theta), tune_start=tune_start)
        except SimulationError:
            return None

    def continued(self, found: Evidence) -> Problem:
        """The same with runs that begin where evidence has found that they do."""
        return Problem(self.likelihood.continued(found), self.names)

    def beside(self, here: Evidence) -> Problem:
        """The same with runs that go on from the paths on which evidence has them: those of values nearby are close."""
        return Problem(self.likelihood.beside(here), self.names)

    def squares(self, here: Evidence, theta: np.ndarray) -> float:
        """What a descent makes small: squared innovations, and the prior's."""
        return float(here.r @ here.r + np.sum(self.prior.rows(theta) ** 2))

    def deviance(self, here: Evidence, theta: np.ndarray) -> float:
        """−2 log likelihood, with the prior."""
        return here.deviance + float(np.sum(self.prior.rows(theta) ** 2))

    def information(self, here: Evidence) -> np.ndarray:
        """Sᵀ S (k, k), and the prior's."""
        return here.S.T @ here.S + self.prior.slopes**2

    def gradient(self, S: np.ndarray, r: np.ndarray, theta: np.ndarray) -> np.ndarray:
        """Sᵀ r (k,), and the prior's."""
        return S.T @ r + self.prior.slopes @ self.prior.rows(theta)

    def whole_gradient(self, here: Evidence, theta: np.ndarray) -> np.ndarray:
        """−½ the slope of the deviance (k,), by differences of a standard error: `gradient`, and what the filters' own change
        does."""
        before, found = self.deviance(here, theta), np.zeros(len(theta))
        for j, curvature in enumerate(np.diag(self.information(here))):
            by = curvature**-0.5 if theta[j] + curvature**-0.5 <= self.upper[j] else -(curvature**-0.5)
            rise = self._there(theta + by * self._only(j)) - before
            found[j] = (curvature * by - rise / by) / 2
        return found

    def _there(self, theta: np.ndarray) -> float:
        """The deviance at values without slopes."""
        return self.deviance(self.likelihood.evidence(self.likelihood.campaign.fit, self.values(theta)), theta)

    def _only(self, j: int) -> np.ndarray:
        """1 for one value, and 0 for all others (k,)."""
        return np.eye(len(self.names))[j]

    def expected(self, here: Evidence, theta: np.ndarray) -> float:
        """How much the squares would fall at most, if slopes held all the way: of what no bound holds."""
        return self.towards(theta, self.gradient(here.S, here.r, theta), self.information(here))[1]

    def towards(self, theta: np.ndarray, g: np.ndarray, information: np.ndarray) -> tuple[np.ndarray, float]:
        """The step (k,) to where a gradient would be none, if slopes held all the way, of what no bound holds; and what it
        promises."""
        near = AT_BOUND * self.scale
        free = ~((theta < self.lower + near) & (g < 0) | (theta > self.upper - near) & (g > 0))
        step = np.zeros(len(theta))
        step[free] = inverse(information[np.ix_(free, free)]) @ g[free]
        return step, float(g @ step)

    def stepped(self, theta: np.ndarray, step: np.ndarray) -> np.ndarray:
        """As much of a step as slopes hold for, within bounds."""
        far = float(np.max(np.abs(step) / self.prior.sd, initial=0.0))
        return np.clip(theta + step / max(1.0, far), self.lower, self.upper)

    def descend(self, here: Evidence, theta: np.ndarray) -> tuple[np.ndarray, Evidence]:
        """Where to go from `theta`, and the evidence there with the filters and sensitivities of `here`."""
        slopes = -np.concatenate([here.S, self.prior.slopes])
        Q, R = np.linalg.qr(slopes)
        inside = np.clip(theta, self.lower + 1e-12 * self.scale, self.upper - 1e-12 * self.scale)
        latest = {inside.tobytes(): here}
        wall = 10 * float(np.sqrt(here.r @ here.r))

        def residuals(q: np.ndarray) -> np.ndarray:
            """As long as all innovations and as steep, in few numbers: their part along the slopes, and the rest's size."""
            if q.tobytes() not in latest:
                try:
                    latest[q.tobytes()] = self.likelihood.resimulated(here, self.values(q), whole=False)
                except SimulationError:
                    return np.full(len(q) + 1, wall)  # the search turns back where the model cannot run
            r = np.concatenate([latest[q.tobytes()].r, self.prior.rows(q)])
            along = Q.T @ r
            return np.append(along, np.sqrt(max(0.0, float(r @ r - along @ along))))

        found = least_squares(
            residuals,
            inside,
            jac=lambda q: np.vstack([R, np.zeros(len(q))]),
            bounds=(self.lower, self.upper),
            x_scale=self.scale,
            ftol=1e-7,
            xtol=1e-6,
            gtol=1e-10,
            max_nfev=10,
        )
        there = latest[found.x.tobytes()]
        try:
            return found.x, there if there is here else self.likelihood.whole(there, self.values(found.x))
        except SimulationError:
            return theta, here  # it cannot run there by itself


def found_at(problem: Problem, theta: np.ndarray, here: Evidence) -> Fit:
    """The fit that has ended at values (k,), with the evidence at them."""
    covariance = inverse(problem.information(here)) if len(theta) else np.zeros((0, 0))
    values, deviance, prior = problem.values(theta), problem.deviance(here, theta), problem.prior.slopes
    return Fit(problem.names, values, covariance, here, deviance, prior, problem.lower, problem.upper)
