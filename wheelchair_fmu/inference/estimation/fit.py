"""Fit parameters to the evidence: `scipy.optimize.least_squares` on innovations, with priors as further rows.

Each descent keeps the sensitivities and filters of where it began, so that a trial costs no more than a
simulation; where it ends everything is linearised anew, until a descent gains nothing that matters. Where that
leads to nothing more likely, because filters change with the parameters as much as residuals do, a step goes by slopes of the
likelihood itself.
"""

from __future__ import annotations

import math
from collections.abc import Container, Mapping, Sequence

import numpy as np

from ...errors import SimulationError
from ..evidence.evidence import Evidence
from ..evidence.likelihood import Likelihood
from .inverse import inverse
from .led import fit_led
from .problem import STRAIGHT, Fit, Problem, found_at

SLIGHT = 1e-4  # of what is left above the noise: a model that leaves much is wrong, and nobody needs its very best values
MOST = 8  # linearisations
NEAR = 2.0  # mean square innovation of a model that is about right: of one that is not, nobody needs the very best values
WORTH_HALVING = 10.0  # fall of squares that slopes promise: a step of less that fails is not tried by halves
PROMISED = 100.0  # fall of squares that slopes promise, and nobody finds
GAINED = 100.0  # fall of −2 log likelihood in one step, from which on a longer one is tried,
FURTHER = 3  # at most so many times, each twice as long


def fit(
    likelihood: Likelihood,
    names: Sequence[str],
    start: Mapping[str, float],
    here: Evidence | None = None,
    rival: float = math.inf,
    most: int = MOST,
    hold: Container[str] = (),
    like: Evidence | None = None,
) -> Fit:
    """The most likely values of `names`, from `start`; `here` is the evidence there, with sensitivities by `names`, if known.

    `rival` is the deviance of another model: one that falls too slowly to come up with it is not followed to its end. `most` is
    how often all is linearised anew. Where forces lead the runs, dry friction that is to `hold` stays where it is, and filters
    tell of all other values what they do in the evidence `like`.
    Raises SimulationError where the model cannot be simulated at the start.
    """
    problem = Problem(likelihood, names)
    theta = problem.inside(start)
    here = here or problem.linearised(theta)
    if likelihood.leads:
        return fit_led(problem, theta, here, most, hold, like)
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
    return found_at(problem, theta, here)


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
