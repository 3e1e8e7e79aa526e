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
from ..estimation.problem import Fit
from ..estimation.starts import Outlook, most_promising
from ..models.factory import TOGETHER, ModelFactory
from ..models.hypothesis import Model
from ..models.models import Models
from ..parallel import parallel_map
from .candidate import Candidate
from .judge import judge
from .pruning import pruned
from .rounds import Round

SIZES = (0.0, 0.5, 1.0, 2.0, 4.0)  # of δ


def together(models: Models, now: Round) -> Candidate | None:
    """Of the effects that ask for one law, as a group: the first that a round finds, beside the model that it was `now` for."""
    w = models.factory
    for group in kin(w):
        new = tuple(e for e in group if e not in now.effects)
        found = _fitted(models, now.model, new, group) if new and len(group) > 1 else None
        if found is None:
            continue
        whole = _held_out(models, (*now.effects, *new), found)
        names = [n for e in new for n in w.parameters(e)]
        judged = judge(models, now.model, whole, TOGETHER.join(new), names, len(now.scores))
        if replace(now, candidates=(), groups=(judged,)).winner is not None:
            return judged
    return None


def parted(models: Models, now: Round, group: Candidate) -> list[Round]:
    """Rounds that judge each effect of a group that a round found, beside the rest of the group: first the one without which
    most is left, as steps of the staircase follow. What the others make needless is left out, so that a group of which one does
    all comes to that one."""
    w, known = models.factory, now.effects
    whole = models.fitted((*known, *group.members), group.fit.values)
    order = sorted(group.members, key=lambda e: models.weight(whole, e))
    every, found = pruned(models, (*known, *order), whole, known)
    near = (c for c in now.candidates if c.lawful and c.likelihood_ratio >= models.effort.halfway * group.likelihood_ratio)
    contested = bool({c.effect for c in near}.difference(every))
    lacking = {e: _without(models, now, every, e, found) for e in every[len(known) :]}
    needed = sorted(lacking, key=lambda e: -lacking[e].deviance)
    top, rounds = _held_out(models, (*known, *needed), found), []
    for effect in needed:
        others, fewer = tuple(e for e in top.effects if e != effect), lacking[effect]
        without = Model(others, fewer, models.heldout(models.likelihood(others), fewer))
        with_it = replace(top, fit=models.compared(top.fit, effect, fewer))
        judged = judge(models, without, with_it, effect, w.parameters(effect), len(now.scores))
        rounds.append(Round(others, fewer, without.heldout, now.scores, (judged,), contested=contested, policy=models.policy))
    return rounds


def _without(models: Models, now: Round, effects: tuple[str, ...], effect: str, found: Fit) -> Fit:
    """The fit of all these effects but one."""
    others = tuple(e for e in effects if e != effect)
    return now.fit if others == now.effects else models.fitted(others, found.values)


def _held_out(models: Models, effects: tuple[str, ...], found: Fit) -> Model:
    """A fit with its runs started where readings want them, to first order, and held out."""
    likelihood = models.likelihood(effects)
    found = replace(found, evidence=likelihood.restarted(found.evidence, found.values))
    return Model(effects, found, models.heldout(likelihood, found))


def kin(w: ModelFactory) -> list[tuple[str, ...]]:
    """Effects with parameters to estimate, by the laws that they ask for."""
    groups: dict[tuple[tuple[str, str], ...], list[str]] = {}
    for e in w.demanding:
        if w.parameters(e):
            groups.setdefault(tuple(sorted(w.catalogue[e].needs.items())), []).append(e)
    return [tuple(group) for group in groups.values()]


def tries(w: ModelFactory, group: Sequence[str], most: int) -> list[dict[str, float]]:
    """Several sizes of each effect of a group, combined, with the constants of their laws as records have them."""
    names = [n for e in group for n in w.parameters(e)]
    sizes = list(product(*([f * w.records[n].delta for f in SIZES] for n in names)))
    if len(sizes) > most:
        sizes = [sizes[i] for i in np.random.default_rng(0).choice(len(sizes), most, replace=False)]
    constants = {n: w.records[n].default for e in group for n in w.constants(e)}
    return [{**constants, **dict(zip(names, one, strict=True))} for one in sizes]


def _fitted(models: Models, base: Model, new: tuple[str, ...], group: Sequence[str]) -> Fit | None:
    """The most likely model with all of a group that starts from several sizes of each lead to."""
    every, known = (*base.effects, *new), base.fit.evidence
    likelihood, names = models.likelihood(every), models.names(every)
    starts = ({**base.fit.values, **sizes} for sizes in tries(models.factory, group, models.effort.tries))
    thetas = [[start[n] for n in names] for start in starts]

    def one_step(start: Outlook) -> Fit | None:
        try:
            return models.refit(every, dict(zip(names, start.theta, strict=True)), most=1)
        except SimulationError:
            return None

    promising = most_promising(likelihood, known, names, thetas, models.effort.begun, known.r)
    begun = sorted((fit for fit in parallel_map(one_step, promising) if fit), key=_deviance)
    ended = parallel_map(lambda fit: models.refit(every, fit.values, fit.evidence), begun[: models.effort.starts])
    best = min(ended, key=_deviance, default=None)
    return best and models.started(every, best)


def _deviance(fit: Fit) -> float:
    return fit.deviance
