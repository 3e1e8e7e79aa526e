"""Fits where forces that nobody recorded lead the runs: the values at which readings tell nothing more of them.

A filter knows what forces do to a chair of this mass, so that the likelihood takes how large innovations are for a measurement
of the mass. It is none that anyone would trust: filters weigh the readings and are no evidence themselves (generalised
estimating equations; Liang and Zeger 1986), and no step is asked whether it makes the likelihood larger.

But where dry friction holds, what a filter expects depends on what would make it let go. That nothing happens tells of the
friction, and of all that would have moved what it holds; readings' slopes have none of that, and are off by it. There slopes
are those of the likelihood itself, and a step that makes it larger by a good part of what they promise is taken for that.
"""

from __future__ import annotations

from collections.abc import Container, Sequence
from dataclasses import dataclass

import numpy as np

from ...errors import SimulationError
from ..evidence.evidence import Evidence
from ..evidence.likelihood import HELD
from ..parallel import parallel_map
from .problem import STRAIGHT, Fit, Problem, found_at

NEARBY = 0.1  # standard errors over which the deviance is as good as a parabola
ENOUGH = 0.25  # of a fall that slopes promise: a step that does so much goes the right way, however slopes bend
LEAST_SHARE = 0.2  # of a step that is tried


@dataclass(frozen=True)
class _Place:
    """Where a fit has come to: its problem with runs on their paths, values (k,), evidence at them, and the step (k,) from
    there, with how much it promises."""

    problem: Problem
    theta: np.ndarray
    here: Evidence
    step: np.ndarray
    promised: float

    @property
    def deviance(self) -> float:
        return self.problem.deviance(self.here, self.theta)

    def likelier(self, other: _Place) -> bool:
        """Is it, than another place, by as much as counts of what slopes promised there?"""
        return other.deviance - self.deviance > max(STRAIGHT, ENOUGH * other.promised)


def fit_led(
    problem: Problem, theta: np.ndarray, here: Evidence, most: int, hold: Container[str] = (), like: Evidence | None = None
) -> Fit:
    """The fit from `theta`, with the evidence there, by `most` steps. Dry friction that is to `hold` stays where it is,
    and filters tell of all other values what they do in the evidence `like`."""
    if not problem.names:
        return found_at(problem, theta, here)
    place, share = _place(problem, theta, here, hold, like), 1.0
    slips = any(name not in hold for name in _dry(problem))
    for _ in range(most):
        if place.promised < STRAIGHT:
            break
        there = _tried(place, share, hold, like)
        if there and (there.promised < place.promised or (slips and there.likelier(place))):
            place, share = there, 1.0
        elif share > LEAST_SHARE:
            share /= 2
        else:
            break
    return found_at(place.problem, place.theta, place.here)


def _tried(place: _Place, share: float, hold: Container[str], like: Evidence | None) -> _Place | None:
    """After some share of the step from a place; None where the model cannot run."""
    to = place.problem.stepped(place.theta, share * place.step)
    try:
        return _place(place.problem, to, place.problem.linearised(to), hold, like)
    except SimulationError:
        return None


def _place(problem: Problem, theta: np.ndarray, here: Evidence, hold: Container[str], like: Evidence | None) -> _Place:
    near = problem.beside(here)
    told, more = knowing(near, theta, here, hold, like)
    g, information = told.pull + near.prior.slopes @ near.prior.rows(theta), near.information(here) + np.diag(more)
    for name in _dry(near):
        if name in hold:
            j = near.names.index(name)
            information[j, :], information[:, j], information[j, j], g[j] = 0.0, 0.0, 1.0, 0.0
    return _Place(near, theta, told, *near.towards(theta, g, information))


def _dry(problem: Problem) -> Sequence[str]:
    """Which of the values are of dry friction."""
    return [name for name in problem.names if problem.likelihood.records[name].dry]


def knowing(
    problem: Problem, theta: np.ndarray, here: Evidence, hold: Container[str] = (), like: Evidence | None = None
) -> tuple[Evidence, np.ndarray]:
    """Evidence with what filters' own change tells of each value, where dry friction is among these, and how much more (k,) it
    tells of the friction than readings' slopes do. Where all of that is to `hold`, it is as the evidence `like` has it."""
    beyond, more = np.zeros((len(here.runs), len(theta))), np.zeros(len(theta))
    dry = _dry(problem)
    held = all(name in hold for name in dry)
    known = _told_by(like) if held and like else {}
    if dry and (known or not held):
        for j, name in enumerate(problem.names):
            beyond[:, j] = known.get(name, 0.0)
        offsets = problem.likelihood.offsets  # which no filter heeds
        asked = [j for j, name in enumerate(problem.names) if name not in known and name not in offsets]
        found = parallel_map(lambda j: _beyond_slopes(problem, theta, here, j), asked)
        for j, (told, bent) in zip(asked, found, strict=True):
            beyond[:, j], more[j] = told, bent if problem.names[j] in dry else 0.0
    return here.knowing(beyond), more


def _told_by(evidence: Evidence) -> dict[str, np.ndarray]:
    """By name of each value, what filters' own change tells of it (m,), if that is known."""
    beyond = [e.beyond for e in evidence.runs if e.beyond is not None]
    return dict(zip(evidence.by, np.transpose(beyond), strict=True)) if len(beyond) == len(evidence.runs) else {}


def _beyond_slopes(problem: Problem, theta: np.ndarray, here: Evidence, j: int) -> tuple[np.ndarray, float]:
    """What filters' own change tells (m,) of one value by each run, and how much more the deviance is bent than slopes have it:
    from values to both sides, over which it is as good as a parabola, or to one side beside a bound."""
    slopes = [e.S[e.finite][:, j] for e in here.runs]
    squares = np.array([s @ s for s in slopes])
    by = NEARBY * float(squares.sum() + problem.prior.slopes[j, j] ** 2) ** -0.5
    sides = np.array([side for side in (by, -by) if problem.lower[j] <= theta[j] + side <= problem.upper[j]])
    if not len(sides):
        return np.zeros(len(slopes)), 0.0
    only = np.eye(len(theta))[j]
    before = _by_run(here)
    rises = np.array([_by_run(_nearby(problem, theta, here, theta + side * only)) - before for side in sides])
    bent = float(rises.sum(axis=1).mean()) / by**2 - float(squares.sum()) if len(sides) == 2 else 0.0
    pulls = [s @ e.r[e.finite] for s, e in zip(slopes, here.runs, strict=True)]
    half = np.mean(squares * sides[:, None] - rises / sides[:, None], axis=0) / 2  # less what it rises by as it is bent
    return half - pulls, max(0.0, bent)


def _nearby(problem: Problem, theta: np.ndarray, here: Evidence, there: np.ndarray) -> Evidence:
    """Evidence at values nearby, on the paths that forces take there: from those that runs are on by as much as smoothed forces
    differ. They do there to a chair what they do here: that is known, and not how large they are."""
    values = problem.values(there)
    likelihood = problem.likelihood.beside(here, HELD).turning(problem.values(theta), values)
    runs = likelihood.campaign.fit
    found = likelihood.evidence(runs, values)
    if any(e.path is None for e in here.runs):
        return found
    return likelihood.beside(found.led_from(here), HELD).evidence(runs, values)


def _by_run(found: Evidence) -> np.ndarray:
    """−2 log likelihood (m,) of each run."""
    return np.array([e.deviance for e in found.runs])
