"""How probable it is that an effect is there, and that it is larger than its smallest interesting size.

Every round of the search compares one model with the same model and one more effect. An effect that is there has a size about
as large as δ or a few times that: each parameter is normal about zero with a standard deviation of `LARGE` δ, and one-sided
where only that is lawful. One that is not there has the small size that every chair has of everything, `SLIGHT` δ, as no model
is exact. The marginal likelihood of each is that of a normal with the estimate's mean and robust covariance, in the directions
that the data see (Laplace's approximation; Kass and Raftery 1995), with what each predicts of the runs held out. Beforehand,
one effect of the catalogue is expected to be missing.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import exp, log

import numpy as np
from scipy import special

from .diagnose import Candidate, Round
from .score import Score
from .statistics import RESAMPLES, cosines, difference_blocks, resampled_totals, seen_axes

LARGE = 4.0  # δ: standard deviation of a size that matters
SLIGHT = 0.25  # δ: of one that does not
DRAWS = 4000  # of a size, from its posterior
LEAST = 0.1  # fall of −2 log likelihood that tells of an estimate as much as none
MOST = 500.0  # log odds that are told apart
EXPECTED = 1.0  # effects of the catalogue that are missing, before anything was measured


@dataclass(frozen=True)
class Support:
    """What a round says of one effect: log marginal likelihoods, beside the model without it, where it is as large as what
    matters and where it is slight; and the probability that it is larger than δ in the former case."""

    effect: str
    large: float
    slight: float
    left: float  # share of the fall that a slight one leaves
    beyond: float


@dataclass(frozen=True)
class Belief:
    """The probability that an effect is `there`, and that it is there and larger than δ."""

    there: float
    large: float


def support(
    effect: str, size: np.ndarray, covariance: np.ndarray, lawful: np.ndarray, fall: float, ahead: float = 0.0
) -> Support:
    """Of an estimate (k,) with its covariance (k, k), in units of δ; `lawful` (k,) says which may only be positive. `fall` is
    by how much −2 log likelihood falls up to the estimate, `ahead` by how much it does so on runs held out."""
    axes, spread = seen_axes(covariance)
    along = axes.T @ size
    one = float(np.linalg.norm(axes, axis=1).max())  # what δ of the parameter that shows most does along the seen directions

    def posterior(sd: float) -> tuple[np.ndarray, np.ndarray]:
        """Means and variances of the size along the seen directions, where it has this standard deviation beforehand."""
        width = spread + sd**2
        return along * sd**2 / width, spread * sd**2 / width

    def marginal(sd: float) -> tuple[float, float]:
        """The log marginal likelihood for sizes with this standard deviation, and the share of the fall that these leave."""
        mean, variance = posterior(sd)
        width = spread + sd**2
        sides = (axes @ mean)[lawful] / np.sqrt((axes**2 @ variance)[lawful])
        allowed = float(np.sum(special.log_ndtr(sides) + log(2)))
        left = float(np.sum((along - mean) ** 2 / spread)) / max(float(np.sum(along**2 / spread)), LEAST)
        value = 0.5 * (fall + (1 - left) * ahead) - 0.5 * float(np.sum(np.log(width / spread) + along**2 / width)) + allowed
        return value, left

    mean, variance = posterior(LARGE)
    draws = mean + np.sqrt(variance) * np.random.default_rng(0).standard_normal((DRAWS, len(along)))
    free = draws[np.all((draws @ axes.T)[:, lawful] >= 0, axis=1)]
    beyond = float(np.mean(np.linalg.norm(free, axis=1) > one)) if len(free) else 0.0
    (large, _), (slight, left) = marginal(LARGE), marginal(SLIGHT)
    return Support(effect, large, slight, left, beyond)


def beliefs(found: Mapping[str, Round], last: Round, one_sided: Mapping[str, np.ndarray]) -> dict[str, Belief]:
    """Of every effect that was scored. What was `found`, by effect, stands against its rivals in the round that decides on it;
    others may be there beside all that was found, by the `last` round, or in the place of what they rival."""
    rounds = {effect: instead(_rivals(r, effect, found), one_sided) for effect, r in found.items()}
    besides = beside(last, one_sided)
    out = {}
    for effect in dict.fromkeys([*found, *besides, *(e for by in rounds.values() for e in by)]):
        told = [rounds[effect]] if effect in found else [besides, *rounds.values()]
        chances = [by[effect] for by in told if effect in by]
        out[effect] = Belief(_either(b.there for b in chances), _either(b.large for b in chances))
    return out


def _rivals(r: Round, effect: str, found: Container[str]) -> Round:
    """A round without the candidates that were found beside an effect."""
    return replace(r, candidates=tuple(c for c in r.candidates if c.effect == effect or c.effect not in found))


def _either(chances: Iterable[float]) -> float:
    """That at least one of several happens."""
    return 1 - float(np.prod([1 - c for c in chances]))


def instead(r: Round, one_sided: Mapping[str, np.ndarray]) -> dict[str, Belief]:
    """Of the refitted effects of a round, of which one is what its model lacks, or none: the mean of the posterior over
    measurements resampled by blocks of time. Where no model is exact, odds between two of them owe more to chance than
    their likelihoods say (Huggins and Miller 2023)."""
    supports = [of_candidate(c, one_sided[c.effect]) for c in r.candidates]
    prior = log(_prior_odds(len(r.scores)))
    logs = np.array([max(0.0, *(s.slight for s in supports)), *(prior + s.large for s in supports)])
    without, *others = _resampled(r)
    best = max(supports, key=lambda s: s.slight)
    logs = logs[:, None] + np.array([without * (best.left if best.slight > 0 else 1.0), *others])
    weights = np.exp(logs - logs.max(axis=0))
    shares = np.mean(weights / weights.sum(axis=0), axis=1)[1:]
    return {s.effect: Belief(w, s.beyond * w) for s, w in zip(supports, map(float, shares), strict=True)}


def shared(group: Sequence[str], r: Round, one_sided: Mapping[str, np.ndarray]) -> dict[str, float]:
    """Of effects of which one is missing, and that a round cannot tell apart, the probability that it is each."""
    found = instead(replace(r, candidates=tuple(c for c in r.candidates if c.effect in group)), one_sided)
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
        out += (totals - blocks.sum(axis=1)[:, None]) / (2 * leader.dispersion * leader.correlation)
    return out


def beside(r: Round, one_sided: Mapping[str, np.ndarray]) -> dict[str, Belief]:
    """Of all effects of a round that found nothing: each may be there or slight, whatever the others are; those that do the
    same share what they have."""
    refitted = {c.effect: of_candidate(c, one_sided[c.effect]) for c in r.candidates}
    supports = [refitted.get(s.effect) or of_score(s, one_sided[s.effect]) for s in r.scores]
    odds = [_prior_odds(len(supports)) * exp(min(s.large - max(0.0, s.slight), MOST)) for s in supports]
    alike = cosines(r.scores, r.scores) ** 2
    np.fill_diagonal(alike, 1.0)
    there = odds / (1 + alike @ np.array(odds))
    return {s.effect: Belief(p, s.beyond * p) for s, p in zip(supports, map(float, there), strict=True)}


def _prior_odds(effects: int) -> float:
    share = EXPECTED / max(effects, 2)
    return share / (1 - share)


def of_candidate(c: Candidate, lawful: np.ndarray) -> Support:
    """Support of a refitted effect. Where zero is likelier than its standard errors have it, they are widened to say so."""
    estimate, scale = c.estimate / c.delta, np.outer(c.delta, c.delta)
    covariance = max((c.covariance / scale, c.between / scale), key=np.trace)
    fall, ahead = max(c.drop, 0.0) / c.correlation, c.gain[0] / (c.dispersion * c.correlation) if c.gain else 0.0
    widen = max(1.0, _squared(estimate, covariance) / max(fall, LEAST))
    return support(c.effect, estimate, covariance * widen, lawful, fall, ahead)


def of_score(s: Score, lawful: np.ndarray) -> Support:
    """Support of an effect that was not refitted, by its slope."""
    estimate = s.estimate / s.delta
    return support(s.effect, estimate, s.covariance, lawful, _squared(estimate, s.covariance))


def _squared(estimate: np.ndarray, covariance: np.ndarray) -> float:
    """Of an estimate, in standard errors, along the directions that the data see."""
    axes, spread = seen_axes(covariance)
    return float(np.sum((axes.T @ estimate) ** 2 / spread))
