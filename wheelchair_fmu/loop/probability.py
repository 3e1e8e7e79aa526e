"""How probable it is that an effect is there, and that it is larger than its smallest interesting size.

Every round of the search compares one model with the same model and one more effect, by their marginal likelihoods. Beforehand,
one effect of the catalogue is expected to be missing.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import exp, log

import numpy as np

from .diagnose import Round, ranked
from .marginal import Support, squared, support
from .score import Score
from .statistics import RESAMPLES, cosines, difference_blocks, resampled_totals

MOST = 500.0  # log odds that are told apart
EXPECTED = 1.0  # effects of the catalogue that are missing, before anything was measured


@dataclass(frozen=True)
class Belief:
    """The probability that an effect is `there`, and that it is there and larger than δ."""

    there: float
    large: float


def beliefs(found: Mapping[str, Round], last: Round, one_sided: Mapping[str, np.ndarray]) -> dict[str, Belief]:
    """Of every effect that was scored. What was `found`, by effect, stands against its rivals in the round that decides on it;
    others may be there beside all that was found, by the `last` round, or in the place of what they rival."""
    rounds = {effect: instead(_rivals(r, effect, found)) for effect, r in found.items()}
    besides = beside(last, one_sided)
    out = {}
    for effect in dict.fromkeys([*found, *besides, *(e for by in rounds.values() for e in by)]):
        told = [rounds[effect]] if effect in found else [besides, *rounds.values()]
        chances = [by[effect] for by in told if effect in by]
        out[effect] = Belief(_either(b.there for b in chances), _either(b.large for b in chances))
    return out


def _rivals(r: Round, effect: str, found: Container[str]) -> Round:
    """A round with its groups among the candidates, and without those that were found beside an effect."""
    others = (c for c in (*r.candidates, *r.groups) if c.effect == effect or not any(e in found for e in c.members))
    return replace(r, candidates=tuple(ranked(others)))


def _either(chances: Iterable[float]) -> float:
    """That at least one of several happens."""
    return 1 - float(np.prod([1 - c for c in chances]))


def instead(r: Round) -> dict[str, Belief]:
    """Of the refitted effects of a round, of which one is what its model lacks, or none: the mean of the posterior over
    measurements resampled by blocks of time. Where no model is exact, odds between two of them owe more to chance than
    their likelihoods say (Huggins and Miller 2023)."""
    supports = [c.support for c in r.candidates]
    prior = log(_prior_odds(len(r.scores)))
    logs = np.array([max(0.0, *(s.slight for s in supports)), *(prior + s.large for s in supports)])
    without, *others = _resampled(r)
    best = max(supports, key=lambda s: s.slight)
    logs = logs[:, None] + np.array([without * (best.left if best.slight > 0 else 1.0), *others])
    weights = np.exp(logs - logs.max(axis=0))
    shares = np.mean(weights / weights.sum(axis=0), axis=1)[1:]
    return {s.effect: Belief(w, s.beyond * w) for s, w in zip(supports, map(float, shares), strict=True)}


def shared(group: Sequence[str], r: Round) -> dict[str, float]:
    """Of effects of which one is missing, and that a round cannot tell apart, the probability that it is each."""
    found = instead(replace(r, candidates=tuple(c for c in r.candidates if c.effect in group)))
    whole = sum(b.there for b in found.values())
    return {e: found[e].there / whole for e in group}


def _resampled(r: Round) -> np.ndarray:
    """By how much resampling moves the log likelihood of a round's model (first) and of each of its candidates, beside that of
    the first candidate, (1 + m, RESAMPLES): on fitted runs and on those held out."""
    leader = r.candidates[0]
    fitted = [r.fit.evidence, *(c.fit.evidence for c in r.candidates)]
    heldout = [r.heldout, *(c.heldout for c in r.candidates)]
    out = np.zeros((len(fitted), RESAMPLES))
    for of, models in ((leader.fit.evidence, fitted), (leader.heldout, heldout)):
        if of is None or not of.runs:
            continue
        blocks = np.array([difference_blocks(of, m) if m is not None else 0 * difference_blocks(of, of) for m in models])
        totals = np.array([resampled_totals(one) for one in blocks])
        out += (totals - blocks.sum(axis=1)[:, None]) / (2 * leader.scale)
    return out


def beside(r: Round, one_sided: Mapping[str, np.ndarray]) -> dict[str, Belief]:
    """Of all effects of a round that found nothing: each may be there or slight, whatever the others are; those that do the
    same share what they have."""
    refitted = {c.effect: c.support for c in r.candidates}
    supports = [refitted.get(s.effect) or of_score(s, one_sided[s.effect]) for s in r.scores]
    odds = [_prior_odds(len(supports)) * exp(min(s.large - max(0.0, s.slight), MOST)) for s in supports]
    alike = cosines(r.scores, r.scores) ** 2
    np.fill_diagonal(alike, 1.0)
    there = odds / (1 + alike @ np.array(odds))
    return {s.effect: Belief(p, s.beyond * p) for s, p in zip(supports, map(float, there), strict=True)}


def _prior_odds(effects: int) -> float:
    share = EXPECTED / max(effects, 2)
    return share / (1 - share)


def of_score(s: Score, lawful: np.ndarray) -> Support:
    """Support of an effect that was not refitted, by its slope."""
    estimate = s.estimate / s.delta
    return support(s.effect, estimate, s.covariance, lawful, squared(estimate, s.covariance))
