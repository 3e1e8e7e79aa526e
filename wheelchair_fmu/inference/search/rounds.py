"""One round of the search: a model, what was tried beside it, and which of that is the most probable."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy import special

from ..estimation.marginal import Support
from ..estimation.problem import Fit
from ..estimation.score import Score
from ..estimation.statistics import RESAMPLES, difference_blocks, resampled_totals
from ..evidence.evidence import Evidence
from ..models.hypothesis import Model
from ..policy import DEFAULT, SearchPolicy
from .candidate import Candidate, ranked


@dataclass(frozen=True)
class Belief:
    """The probability that an effect is `there`, and that it is there and larger than δ."""

    there: float
    large: float


@dataclass(frozen=True)
class Round:
    """The model that a round started from, all scores, and what was refitted, best first; `groups` are of several effects.

    `again`: it is for what an earlier round found, beside all that was found later. `contested`: it judges one effect of a
    group that others came near to, and nobody asked whether they do so in the place of this one. `odds` are those of each of
    its candidates, before anything was measured, beside an effect's of the catalogue; `explained` is by how much −2 log
    likelihood fell to its model from one without any effect.
    """

    effects: tuple[str, ...]
    fit: Fit
    heldout: Evidence
    scores: tuple[Score, ...]
    candidates: tuple[Candidate, ...]
    again: bool = False
    groups: tuple[Candidate, ...] = ()
    contested: bool = False
    odds: float = 1.0
    explained: float = 0.0
    policy: SearchPolicy = DEFAULT

    @property
    def model(self) -> Model:
        """That which it started from."""
        return Model(self.effects, self.fit, self.heldout)

    @cached_property
    def every(self) -> tuple[Candidate, ...]:
        """Candidates and groups, best first."""
        both = (*self.candidates, *self.groups)
        return tuple(sorted(both, key=lambda c: -c.support.large)) if self.groups else self.candidates

    @cached_property
    def beliefs(self) -> dict[str, Belief]:
        """Of each candidate and group."""
        return instead(self, self.every)

    def decided_by(self, policy: SearchPolicy) -> Round:
        """The same round, as another policy judges what was tried."""
        return replace(self._with(lambda c: replace(c, policy=policy)), policy=policy)

    def leaving_out(self, run: str) -> Round:
        """The same round, as all fitted runs but one have it."""
        fit = replace(self.fit, evidence=self.fit.evidence.without(run))
        return replace(self._with(lambda c: c.leaving_out(run)), fit=fit)

    def _with(self, changed: Callable[[Candidate], Candidate]) -> Round:
        candidates, groups = (tuple(ranked(map(changed, which))) for which in (self.candidates, self.groups))
        return replace(self, candidates=candidates, groups=groups)

    @cached_property
    def present(self) -> dict[str, float]:
        """Of each candidate and group, the probability that it is there, large or slight, beside nothing."""
        return {c.effect: _present(self, c) for c in self.every}

    @property
    def winner(self) -> Candidate | None:
        """The best candidate, or group of them, if it is surely there, and it is more probable that some such thing is missing
        than that all have at most a little of everything. What worsens held-out runs is never said to help."""
        able = [c for c in self.every if c.possible and not c.worsens]
        large = sum(self.beliefs[c.effect].there for c in able) > 0.5
        sure = bool(able) and min(self.present[able[0].effect], _present_in_blocks(self, able[0])) > self.policy.sure
        return able[0] if large and sure else None

    @property
    def slight(self) -> list[Candidate]:
        """Candidates that are surely there, be they slight, and do not worsen held-out runs, the likeliest first."""
        sure = (c for c in self.candidates if c.possible and not c.worsens and self.present[c.effect] > self.policy.sure)
        return sorted(sure, key=lambda c: -c.support.slight)

    def likelier_slight(self, c: Candidate) -> bool:
        """Is a candidate that is there likelier slight than large, by what is expected beforehand and by what was measured?"""
        return self.nothing([c.support]) > self.log_prior + c.support.large

    @property
    def log_prior(self) -> float:
        return self.policy.log_prior(len(self.scores)) + float(np.log(self.odds))

    @property
    def of_laws(self) -> float:
        """Log likelihood that may be gained for no other reason than that the laws of what was found before are not exact."""
        unit = self.every[0].unit if self.every else 1.0
        return 0.5 * self.policy.inexact**2 * max(self.explained, 0.0) / unit

    def nothing(self, supports: Iterable[Support]) -> float:
        """The log likelihood of there being none of several effects: a slight one may be there, and laws that are not exact may
        gain as much as one that is large gains beyond it. What readings cannot see is as probable as it was beforehand."""
        every = list(supports)
        slight = max(0.0, *(s.slight for s in every))
        beyond = max(s.large for s in every) - slight
        return slight + min(max(beyond, 0.0), self.of_laws)


def instead(r: Round, candidates: Sequence[Candidate]) -> dict[str, Belief]:
    """Of refitted effects, of which one is what a round's model lacks, or none: the mean of the posterior over measurements
    resampled by blocks of time. Where no model is exact, odds between two of them owe more to chance than their likelihoods
    say (Huggins and Miller 2023)."""
    if not candidates:
        return {}
    supports = [c.support for c in candidates]
    logs = np.array([r.nothing(supports), *(r.log_prior + s.large for s in supports)])
    without, *others = _resampled(r, candidates)
    best = max(supports, key=lambda s: s.slight)
    logs = logs[:, None] + np.array([without * (best.left if best.slight > 0 else 1.0), *others])
    weights = np.exp(logs - logs.max(axis=0))
    shares = np.mean(weights / weights.sum(axis=0), axis=1)[1:]
    return {s.effect: _belief(s, w) for s, w in zip(supports, map(float, shares), strict=True)}


def _present(r: Round, c: Candidate, resampled: np.ndarray | float = 0.0) -> float:
    """The probability that a candidate is there at any size, beside nothing; by its standard errors where these say less than
    the fall of −2 log likelihood does. `resampled` is by how much the log likelihood of the model without it moves."""
    large, slight = c.support.large - c.excess, c.support.slight - (1 - c.support.left) * c.excess
    gained = np.logaddexp(large, slight) - resampled
    return float(np.mean(special.expit(r.log_prior + gained - np.clip(gained, 0.0, r.of_laws))))


def _present_in_blocks(r: Round, c: Candidate) -> float:
    """The same as held-out runs have it, resampled by blocks of time: what a moment of them alone shows is no effect."""
    without, _ = _of_blocks(c, c.heldout, [r.heldout, c.heldout])
    return _present(r, c, without)


def _belief(s: Support, there: float) -> Belief:
    return Belief(there, s.beyond * there)


def _resampled(r: Round, candidates: Sequence[Candidate]) -> np.ndarray:
    """By how much resampling moves the log likelihood of a round's model (first) and of each of its candidates, beside that of
    the first candidate, (1 + m, RESAMPLES): on fitted runs and on those held out."""
    leader = candidates[0]
    fitted = [r.fit.evidence, *(c.fit.evidence for c in candidates)]
    heldout = [r.heldout, *(c.heldout for c in candidates)]
    return _of_blocks(leader, leader.fit.evidence, fitted) + _of_blocks(leader, leader.heldout, heldout)


def _of_blocks(leader: Candidate, own: Evidence | None, models: Sequence[Evidence | None]) -> np.ndarray:
    """The same by some of the runs, (m, RESAMPLES) of so many models."""
    if own is None or not own.runs:
        return np.zeros((len(models), RESAMPLES))
    blocks = np.array([difference_blocks(own, m) if m is not None else 0 * difference_blocks(own, own) for m in models])
    totals = np.array([resampled_totals(one) for one in blocks])
    return (totals - blocks.sum(axis=1)[:, None]) / (2 * leader.scale)
