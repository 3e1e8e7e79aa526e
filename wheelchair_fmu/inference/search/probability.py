"""How probable it is that an effect is there, and that it is larger than its smallest interesting size.

Every round of the search compares one model with the same model and one more effect, by their marginal likelihoods. Beforehand,
one effect of the catalogue is expected to be missing.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from math import exp

import numpy as np

from ..estimation.marginal import of_score
from ..estimation.statistics import cosines
from .candidate import Candidate, ranked
from .rounds import Belief, Round, instead

MOST = 500.0  # log odds that are told apart


def beliefs(found: Mapping[str, Round], last: Round, one_sided: Mapping[str, np.ndarray]) -> dict[str, Belief]:
    """Of every effect that was scored. What was `found`, by effect, stands against its rivals in the round that decides on it;
    others may be there beside all that was found, by the `last` round, or in the place of what they rival."""
    rounds = {effect: in_place(r, effect, found) for effect, r in found.items()}
    besides = beside(last, one_sided)
    out = {}
    for effect in dict.fromkeys([*found, *besides, *(e for by in rounds.values() for e in by)]):
        told = [rounds[effect]] if effect in found else [besides, *rounds.values()]
        chances = [by[effect] for by in told if effect in by]
        out[effect] = Belief(_either(b.there for b in chances), _either(b.large for b in chances))
    return out


def in_place(r: Round, effect: str, found: Container[str]) -> dict[str, Belief]:
    """Of an effect that a round decides on, and of its rivals, of which one is what the round's model lacks, or none."""
    return instead(r, _rivals(r, effect, found))


def _rivals(r: Round, effect: str, found: Container[str]) -> list[Candidate]:
    """A round's candidates and groups, without those that were found beside an effect."""
    return ranked(c for c in r.every if c.effect == effect or not any(e in found for e in c.members))


def _either(chances: Iterable[float]) -> float:
    """That at least one of several happens."""
    return 1 - float(np.prod([1 - c for c in chances]))


def shared(group: Sequence[str], r: Round) -> dict[str, float]:
    """Of effects of which one is missing, and that a round cannot tell apart, the probability that it is each."""
    found = instead(r, [c for c in r.candidates if c.effect in group])
    whole = sum(b.there for b in found.values())
    return {e: found[e].there / whole for e in group}


def beside(r: Round, one_sided: Mapping[str, np.ndarray]) -> dict[str, Belief]:
    """Of all effects of a round that found nothing: each may be there or slight, whatever the others are; those that do the
    same share what they have."""
    refitted = {c.effect: c.support for c in r.candidates}
    supports = [refitted.get(s.effect) or of_score(s, one_sided[s.effect], r.policy) for s in r.scores]
    odds = [exp(min(r.log_prior + s.large - r.nothing([s]), MOST)) for s in supports]
    alike = cosines(r.scores, r.scores) ** 2
    np.fill_diagonal(alike, 1.0)
    there = odds / (1 + alike @ np.array(odds))
    return {s.effect: Belief(p, s.beyond * p) for s, p in zip(supports, map(float, there), strict=True)}
