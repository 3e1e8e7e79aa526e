"""Effects that are put in together: a group that was found as one, and those that ask for one law.

Where a law has several effects of its own, one alone may leave the model as far off as none: simulations go another way
altogether until all are about right. So where much is left and nothing is found, their sizes are tried together, and judged as
any group is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np

from ...errors import SimulationError
from ..estimation.fit import Fit
from ..estimation.starts import most_promising
from ..models.factory import TOGETHER
from .candidate import Candidate
from .rounds import Round
from .search import HALFWAY, Search

SIZES = (0.0, 0.5, 1.0, 2.0, 4.0)  # of δ
TRIES = 125  # combinations of them, at most
BEGUN = 16  # of these, refits that make one step
ENDED = 2  # of these, refits that go on to their end


def together(search: Search, now: Round) -> Candidate | None:
    """Of the effects that ask for one law, as a group: the first that a round finds, beside the model that it was `now` for."""
    w, effects, base = search.factory, now.effects, now.fit
    for group in kin(search):
        new = tuple(e for e in group if e not in effects)
        found = _fitted(search, effects, new, group, base) if new and len(group) > 1 else None
        if found is None:
            continue
        likelihood, names = w.likelihood((*effects, *new)), [n for e in new for n in w.parameters(e)]
        found = replace(found, evidence=likelihood.restarted(found.evidence, found.values))
        held = search.heldout(likelihood, found.values)
        judged = search.judge(base, now.heldout, found, held, TOGETHER.join(new), names, len(now.scores))
        if replace(now, candidates=(), groups=(judged,)).winner is not None:
            return judged
    return None


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
