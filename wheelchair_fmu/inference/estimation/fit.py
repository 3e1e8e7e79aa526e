"""Fit parameters to the evidence: `scipy.optimize.least_squares` on innovations, with priors as further rows.

Each descent keeps the sensitivities and filters of where it began, so that a trial costs no more than a
simulation; where it ends everything is linearised anew, until a descent gains nothing that matters. Where that
leads to nothing more likely, because filters change with the parameters as much as residuals do, a step goes by slopes of the
likelihood itself.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from ...errors import SimulationError
from ..evidence.evidence import Evidence
from ..evidence.likelihood import LED, STEPPED, Likelihood
from .inverse import inverse

STRAIGHT = 1.0  # −2 log likelihood: a descent that falls by less has gone no further than a standard error, where slopes hold
SLIGHT = 1e-4  # of what is left above the noise: a model that leaves much is wrong, and nobody needs its very best values
MOST = 8  # linearisations
GROUPED = 10.0  # δ: standard deviation of each of several parameters of one effect, where the data say nothing of it
NEAR = 2.0  # mean square innovation of a model that is about right: of one that is not, nobody needs the very best values
WORTH_HALVING = 10.0  # fall of squares that slopes promise: a step of less that fails is not tried by halves
PROMISED = 100.0  # fall of squares that slopes promise, and nobody finds
GAINED = 100.0  # fall of −2 log likelihood in one step, from which on a longer one is tried,
FURTHER = 3  # at most so many times, each twice as long
AT_BOUND = 1e-3  # of a parameter's scale
STEEPEST = 1e100  # slope in standard deviations per unit, of whose squares no computer loses count
LEAST_SHARE = 0.2  # of a step that is tried
REACH = 4.0  # standard deviations of the prior; a value further off is no calibration but another chair


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

    def beside(self, here: Evidence, goes: int = LED) -> Problem:
        """The same with runs that go on so from the paths on which evidence has them: those of values nearby are close."""
        return Problem(self.likelihood.beside(here, goes), self.names)

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
            found[j] = _half_slope(curvature, np.array([by]), np.array([rise]))
        return found

    def _there(self, theta: np.ndarray) -> float:
        """The deviance at values without slopes."""
        return self.deviance(self.likelihood.evidence(self.likelihood.campaign.fit, self.values(theta)), theta)

    def _only(self, j: int) -> np.ndarray:
        """1 for one value, and 0 for all others (k,)."""
        return np.eye(len(self.names))[j]

    def led_slopes(self, here: Evidence, theta: np.ndarray, hold: Container[str]) -> tuple[np.ndarray, np.ndarray]:
        """`gradient` (k,) and `information` (k, k); of dry friction by the likelihood itself, from its deviance a standard
        error to both sides, or to one beside a bound; with no way to go for what is to `hold`.

        Where friction holds, a filter expects nothing to happen, and that nothing does tells more of the friction than
        readings' slopes by it. All go the same one step from the path that runs are on: steps to the likeliest one end now
        here, now there, where friction lets go a little earlier or later, so that a deviance jumps by more than a standard
        error makes.
        """
        g, information = self.gradient(here.S, here.r, theta), self.information(here)
        dry = [j for j, name in enumerate(self.names) if self.likelihood.records[name].dry]
        asked = [j for j in dry if self.names[j] not in hold]
        for j in set(dry).difference(asked):
            information[j, :], information[:, j], information[j, j], g[j] = 0.0, 0.0, 1.0, 0.0
        if not asked:
            return g, information
        nearby = self.beside(here, STEPPED)
        before = nearby._there(theta)
        for j in asked:
            by = information[j, j] ** -0.5
            sides = np.array([side for side in (by, -by) if self.lower[j] <= theta[j] + side <= self.upper[j]])
            rises = np.array([nearby._there(theta + side * self._only(j)) - before for side in sides])
            if len(sides) == 2:
                information[j, j] = max(information[j, j], float(rises.mean()) / by**2)
            if len(sides):
                g[j] = _half_slope(information[j, j], sides, rises)
        return g, information

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


def fit(
    likelihood: Likelihood,
    names: Sequence[str],
    start: Mapping[str, float],
    here: Evidence | None = None,
    rival: float = math.inf,
    most: int = MOST,
    hold: Container[str] = (),
) -> Fit:
    """The most likely values of `names`, from `start`; `here` is the evidence there, with sensitivities by `names`, if known.

    `rival` is the deviance of another model: one that falls too slowly to come up with it is not followed to its end. `most` is
    how often all is linearised anew. Where forces lead the runs, dry friction that is to `hold` stays where it is.
    Raises SimulationError where the model cannot be simulated at the start.
    """
    problem = Problem(likelihood, names)
    theta = problem.inside(start)
    here = here or problem.linearised(theta)
    if likelihood.leads:
        return _fit_led(problem, theta, here, most if names else 0, hold)
    for _ in range(most if names else 0):
        enough = max(STRAIGHT, SLIGHT * (problem.squares(here, theta) - len(here.r)))
        if problem.expected(here, theta) < max(enough, (problem.deviance(here, theta) - rival) / MOST):
            break
        to, there = problem.descend(here, theta)
        fall = problem.squares(here, theta) - problem.squares(there, to)
        behind = problem.deviance(there, to) - rival
        if fall < max(enough, behind / MOST):
            theta, here = to, there
            break
        shrinks = (1.0, 0.5, 0.25) if fall > WORTH_HALVING else (1.0,)
        further = _taken(problem, theta, here, to, shrinks) or _by_likelihood(problem, theta, here)
        if further is None:
            break
        before = problem.deviance(here, theta)
        gained = before - problem.deviance(further[1], further[0])
        if likelihood.may_flip and gained > GAINED and most > 1:  # a single step only shows how much a start promises
            problem, further = _beyond(problem, theta, *further, before)
        theta, here = further
    return _found(problem, theta, here)


def _half_slope(curvature: float, by: np.ndarray, rises: np.ndarray) -> float:
    """−½ the slope of a deviance that rises by so much (m,) at these distances (m,), less what it rises by as it is bent."""
    return float(np.mean(curvature * by - rises / by)) / 2


def _found(problem: Problem, theta: np.ndarray, here: Evidence) -> Fit:
    covariance = inverse(problem.information(here)) if len(theta) else np.zeros((0, 0))
    values, deviance, prior = problem.values(theta), problem.deviance(here, theta), problem.prior.slopes
    return Fit(problem.names, values, covariance, here, deviance, prior, problem.lower, problem.upper)


def _fit_led(problem: Problem, theta: np.ndarray, here: Evidence, most: int, hold: Container[str]) -> Fit:
    """The same where forces that nobody recorded lead the runs: the values at which innovations tell nothing more of them.

    A filter knows what forces do to a chair of this mass, so that the likelihood takes how large innovations are for a
    measurement of the mass. It is none that anyone would trust: filters weigh the readings and are no evidence themselves
    (generalised estimating equations; Liang and Zeger 1986), and no step is asked whether it makes the likelihood larger.
    """
    if not most:
        return _found(problem, theta, here)
    problem = problem.beside(here)
    (step, promised), share = problem.towards(theta, *problem.led_slopes(here, theta, hold)), 1.0
    for _ in range(most):
        if promised < STRAIGHT:
            break
        to = problem.stepped(theta, share * step)
        try:
            there = problem.linearised(to)
            nearby = problem.beside(there)
            further, still = nearby.towards(to, *nearby.led_slopes(there, to, hold))
        except SimulationError:
            still = math.inf
        if still < promised:
            problem, theta, here, step, promised, share = nearby, to, there, further, still, 1.0
        elif share > LEAST_SHARE:
            share /= 2
        else:
            break
    return _found(problem, theta, here)


def _taken(
    problem: Problem, theta: np.ndarray, here: Evidence, to: np.ndarray, shrinks: Sequence[float] = (1.0, 0.5, 0.25)
) -> tuple[np.ndarray, Evidence] | None:
    """The step from `theta`, or as much of it, the first of `shrinks`, that is more likely once all is linearised anew.

    A filter that expects less noise makes squares larger and the model more likely: only the deviance compares two filters.
    """
    before = problem.deviance(here, theta)
    for shrink in shrinks:
        trial = theta + shrink * (to - theta)
        try:
            found = problem.linearised(trial)
        except SimulationError:
            continue
        if problem.deviance(found, trial) < before:
            return trial, found
    return None


def _beyond(
    problem: Problem, theta: np.ndarray, to: np.ndarray, here: Evidence, worst: float
) -> tuple[Problem, tuple[np.ndarray, Evidence]]:
    """A step that helped, or twice as far and so on while that is likelier, with runs that follow the errors of their pushes;
    and the problem with runs that have these.

    Slopes are about the errors that a run had before the step. Where casters may flip these hold it on its way, so that a step
    is much too short, however often it is taken. One is too long, and not followed, that slopes about these errors have for
    less likely than what the step came from, by the deviance `worst`.
    """

    def followed(along: Problem, trial: np.ndarray) -> tuple[float, Problem]:
        """The deviance there once runs follow, and the problem in which they do."""
        there = along.at(trial, 1)
        return (along.deviance(there, trial), along.continued(there)) if there else (math.inf, along)

    far, (best, kept) = to, followed(problem, to)
    for _ in range(FURTHER):
        trial = np.clip(theta + 2 * (far - theta), problem.lower, problem.upper)
        unfollowed = kept.at(trial, 0)
        if not unfollowed or problem.deviance(unfollowed, trial) >= worst:
            break
        found, there = followed(kept, trial)
        if found >= best:
            break
        far, best, kept = trial, found, there
    return (kept, (far, kept.linearised(far))) if best < problem.deviance(here, to) else (problem, (to, here))


def _by_likelihood(problem: Problem, theta: np.ndarray, here: Evidence) -> tuple[np.ndarray, Evidence] | None:
    """`_taken` in the direction that the likelihood itself falls in, where that is worth a simulation for each parameter."""
    if problem.expected(here, theta) < PROMISED or float(np.mean(here.r**2)) > NEAR:
        return None
    try:
        gradient = problem.whole_gradient(here, theta)
    except SimulationError:
        return None
    step = inverse(problem.information(here)) @ gradient
    found = _taken(problem, theta, here, np.clip(theta + step, problem.lower, problem.upper))
    return found if found and problem.deviance(here, theta) - problem.deviance(found[1], found[0]) > STRAIGHT else None
