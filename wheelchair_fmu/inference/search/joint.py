"""Effects that are put in together: a group that was found as one, and those that ask for one law.

Where a law has several effects of its own, one alone may leave the model as far off as none: simulations go another way
altogether until all are about right. So where much is left and nothing is found, their sizes are tried together, and stay if
they explain most of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from ...errors import SimulationError
from ..estimation.fit import Fit
from ..estimation.score import Score
from ..estimation.starts import most_promising
from ..estimation.statistics import decisive, margin
from .candidate import Candidate
from .rounds import Round
from .search import HALFWAY, Search

SIZES = (0.0, 0.5, 1.0, 2.0, 4.0)  # of δ
TRIES = 125  # combinations of them, at most
BEGUN = 16  # of these, refits that make one step
ENDED = 2  # of these, refits that go on to their end


@dataclass(frozen=True)
class Stage:
    """An effect, the model before it is put in, and the model with it."""

    effect: str
    without: Fit
    fit: Fit


def together(search: Search, effects: tuple[str, ...], base: Fit, scores: Sequence[Score]) -> list[Round]:
    """Rounds that put in what a group of effects explains together, one effect each, the most needed first; none if it
    explains nothing."""
    for group in kin(search):
        new = tuple(e for e in group if e not in effects)
        found = _fitted(search, effects, new, group, base) if new and len(group) > 1 else None
        if found is not None and found.misfit < base.misfit - decisive(base.evidence) and explains(base, found):
            try:
                return _rounds(search, effects, _stages(search, effects, new, found, base), scores)
            except SimulationError:
                continue  # with some of these and not the others the model cannot run: nobody can say which are needed
    return []


def parted(search: Search, now: Round, group: Candidate) -> list[Round]:
    """Rounds that judge each effect of a group that a round found, beside the rest of the group, the most needed last. What the
    others make needless is left out, so that a group of which one does all comes to that one."""
    w, known = search.factory, now.effects
    whole = search.refit((*known, *w.members(group.effect)), group.fit.values)
    order = sorted(w.members(group.effect), key=lambda e: search.weight(whole, e))
    every, found = search.pruned((*known, *order), whole, known)
    near = (c for c in now.candidates if c.lawful and c.drop >= HALFWAY * group.drop)
    contested = bool({c.effect for c in near}.difference(every))
    found = replace(found, evidence=w.likelihood(every).restarted(found.evidence, found.values))
    held, rounds = search.heldout(w.likelihood(every), found.values), []
    for effect in every[len(known) :]:
        others = tuple(e for e in every if e != effect)
        without = search.refit(others, found.values) if others != known else now.fit
        before, names = search.heldout(w.likelihood(others), without.values), w.parameters(effect)
        judged = search.judge(without, before, search.compared(found, effect, without), held, effect, names, len(now.scores))
        rounds.append(Round(others, without, before, now.scores, (judged,), contested=contested, policy=search.policy))
    return rounds


def explains(base: Fit, found: Fit) -> bool:
    """Does a model leave less than half of what was left above the noise?"""
    return found.evidence.rms - 1 < (base.evidence.rms - 1) / 2


def kin(search: Search) -> list[tuple[str, ...]]:
    """Effects with parameters to estimate, by the laws that they ask for."""
    w = search.factory
    groups: dict[tuple[tuple[str, str], ...], list[str]] = {}
    for e in w.demanding:
        if w.parameters(e):
            groups.setdefault(tuple(sorted(w.catalogue[e].needs.items())), []).append(e)
    return [tuple(group) for group in groups.values()]


def _fitted(search: Search, effects: tuple[str, ...], new: tuple[str, ...], group: Sequence[str], base: Fit) -> Fit | None:
    """The most likely model with all of a group that starts from several sizes of each lead to."""
    every = (*effects, *new)
    likelihood, names = search.factory.likelihood(every), search.names(every)
    own = [n for e in group for n in search.factory.parameters(e)]
    sizes = [[f * search.records[n].delta for f in SIZES] for n in own]
    tries = list(product(*sizes))
    if len(tries) > TRIES:
        tries = [tries[i] for i in np.random.default_rng(0).choice(len(tries), TRIES, replace=False)]
    starts = [{**dict.fromkeys(names, 0.0), **base.values, **dict(zip(own, one, strict=True))} for one in tries]
    thetas = [[start[n] for n in names] for start in starts]
    begun = []
    for start in most_promising(likelihood, base.evidence, names, thetas, BEGUN, base.evidence.r):
        try:
            begun.append(search.refit(every, dict(zip(names, start.theta, strict=True)), most=1))
        except SimulationError:
            continue
    begun.sort(key=lambda fit: fit.misfit)
    ended = [search.refit(every, fit.values, fit.evidence) for fit in begun[:ENDED]]
    return min(ended, key=lambda fit: fit.misfit, default=None)


def _stages(search: Search, effects: tuple[str, ...], new: tuple[str, ...], found: Fit, base: Fit) -> list[Stage]:
    """The way back from a model with all of `new` to one without, by what is needed least; what is not needed is left out."""
    stages: list[Stage] = []
    while new:
        without = {e: base if len(new) == 1 else _refitted(search, (*effects, *(o for o in new if o != e)), found) for e in new}
        least = min(without, key=lambda e: without[e].misfit)
        needed = without[least].misfit - found.misfit > margin(found.evidence)
        if needed or stages:
            stages.insert(0, Stage(least, without[least], found))
        new, found = tuple(e for e in new if e != least), without[least]
    return stages


def _refitted(search: Search, effects: tuple[str, ...], found: Fit) -> Fit:
    return search.refit(effects, found.values, rival=found.misfit)


def _rounds(search: Search, effects: tuple[str, ...], stages: Sequence[Stage], scores: Sequence[Score]) -> list[Round]:
    w, rounds = search.factory, []
    for s in stages:
        more = (*effects, s.effect)
        before, after = (search.heldout(w.likelihood(e), fit.values) for e, fit in ((effects, s.without), (more, s.fit)))
        found = replace(s.fit, evidence=w.likelihood(more).restarted(s.fit.evidence, s.fit.values))
        judged = search.judge(s.without, before, found, after, s.effect, w.parameters(s.effect), len(scores))
        rounds.append(Round(effects, s.without, before, tuple(scores), (judged,), policy=search.policy))
        effects = more
    return rounds
