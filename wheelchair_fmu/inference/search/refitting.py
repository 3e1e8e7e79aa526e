"""The refit of one more effect, or of a group of them: from where it starts, and how far it is followed."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ...errors import SimulationError
from ...quantities import Parameter
from ..estimation.problem import Fit
from ..estimation.starts import most_promising, outlook
from ..evidence.evidence import Evidence
from ..models.factory import ModelFactory
from ..models.hypothesis import Model
from ..models.models import Models
from ..parallel import parallel_map
from ..policy import SearchPolicy
from .candidate import Candidate
from .judge import judge
from .screen import Screened, at_prior_mean

SIZES = (1.0, 2.0, 4.0, 8.0, -1.0, -2.0, -4.0, -8.0)  # of δ, from which a refit may start
GRID = (1.0, 2.0, 4.0)  # of δ as well, where no size at all promises enough

Start = tuple[dict[str, float], Evidence | None]  # values, and what is known there


def candidate(
    models: Models, base: Model, s: Screened, tests: int, rival: float = math.inf, least: float = -math.inf
) -> Candidate | None:
    """Refit with one more effect, from the expected change and from sizes of interest, if −2 log likelihood may fall by
    `least`; `rival` is the best deviance yet."""
    effect = s.score.effect
    effects, base = (*base.effects, effect), models.rival_of(effect, base)
    likelihood = models.likelihood(effects)
    starts = _starts(models, base.fit, s, least)
    if starts:
        models.say(f"refitting {effect}")
    rival = min(rival, base.fit.deviance)  # which it has as a special case
    found, anew = _best_of(models, effects, starts, rival, base.fit), _afresh(models, base, s, least, rival)
    if found is not None and found.deviance > base.fit.deviance and not models.factory.leads:
        found = _from_base(models, base, s, found)
    afresh = anew is not None and (found is None or anew.deviance < found.deviance)
    if afresh:
        found, models = anew, models.afresh()
        likelihood = models.likelihood(effects)
    if found is None:
        return None
    found = models.started(effects, found)
    if not models.factory.leads:
        models.remember(effects, found, ended=found.deviance < rival)  # who falls behind a rival may not have been followed
    found = models.compared(found, effect, base.fit)
    found = replace(found, evidence=likelihood.restarted(found.evidence, found.values))
    if risen(base.fit, found, models.policy, led=models.factory.leads):
        return None  # no fit: the model without the effect is one with it
    try:
        held = likelihood.restarted(models.heldout(likelihood, found, tune_start=0), found.values)
    except SimulationError:
        return None  # a model that cannot be simulated on what was held out foretells nothing of it
    judged = judge(models, base, Model(effects, found, held), effect, models.factory.parameters(effect), tests)
    return replace(judged, afresh=afresh)


def risen(before: Fit, after: Fit, policy: SearchPolicy, *, led: bool) -> bool:
    """Does one more effect cost fitted runs an error above the noise? A model whose casters swing may leave less than that, as
    errors of the pushes are found with them. Where nothing was left to explain, one that leaves more than noise explains
    nothing: it is likelier only as its filter, with casters that stick, expects less noise than there is. Where runs are `led`
    by forces, these are what leaves nothing."""
    was, now = before.evidence.rms, after.evidence.rms
    nothing_left = was < policy.nothing_left < now and not led
    return nothing_left or now > policy.structured * max(1.0, was)


def _best_of(models: Models, effects: Sequence[str], starts: Sequence[Start], rival: float, base: Fit) -> Fit | None:
    """The most likely model that these starts lead to, one step from each, and to the end from the best. Constants of the
    effect's law are as its record has them until its size is known: of something small any law would do. `base` is the fit
    without it."""
    known: dict[str, Any] = {"hold": frozenset(base.names), "like": base.evidence}
    constants = models.factory.constants(effects[-1])

    def one_step(start: Start) -> Fit | None:
        try:
            return models.refit(effects, *start, constants, rival=rival, most=1, **known)
        except SimulationError:
            return None

    begun = [f for f in parallel_map(one_step, starts) if f]
    own, ended = models.factory.parameters(effects[-1]), list[Fit]()
    for ahead in sorted(begun, key=lambda f: f.deviance)[: models.effort.ended if len(own) > 1 else 1]:
        signs, *others = (_signs([f.values[n] for n in own]) for f in (ahead, *ended))
        if signs not in others:
            ended.append(models.refit(effects, ahead.values, ahead.evidence, constants, rival=rival, **known))
            rival = min(rival, ended[-1].deviance)
    best = min(ended, key=lambda f: f.deviance, default=None)
    try:
        return models.refit(effects, best.values, **known) if best and constants else best
    except SimulationError:
        return best  # by the law as its record has it


def _from_base(models: Models, base: Model, s: Screened, found: Fit) -> Fit:
    """The likelier of a fit and of one from what was fitted without the effect. That model is a special case of the one with
    it, so that a fit which ends less likely went astray: slopes of one calibration promised too much of another one."""
    effects = (*base.effects, s.score.effect)
    try:
        return min(found, models.refit(effects, {**base.fit.values, **_expected(models, s)}), key=lambda f: f.deviance)
    except SimulationError:
        return found


def _afresh(models: Models, base: Model, s: Screened, least: float, rival: float) -> Fit | None:
    """The same from the best of several sizes with nothing kept of a model that lacks something large: neither its bent values,
    nor where it has runs start, nor what it took for errors of the pushes. Where casters may swing round, these send a run
    another way altogether, and no step leads back from there."""
    w, effects = models.factory, (*base.effects, s.score.effect)
    fresh = models.afresh()
    likelihood = fresh.likelihood(effects)
    hopeful = likelihood.may_flip and s.score.likelihood_ratio >= least / models.effort.beyond
    at_mean = at_prior_mean(models, likelihood, base.fit, models.effort.bent) if hopeful else []
    if not at_mean or s.score.effect in w.groups:
        return None
    own = w.parameters(s.score.effect)
    sizes = sizes_to_try(s, [w.records[n] for n in own], w.unfitted(own))
    tries = [{**at_mean[0], **dict(zip(own, map(float, size), strict=True))} for size in sizes]

    def deviance(values: dict[str, float]) -> float:
        try:
            return likelihood.evidence(w.campaign.fit, values).deviance
        except SimulationError:
            return math.inf

    start = tries[int(np.argmin(parallel_map(deviance, tries)))]
    try:
        return fresh.restarted(likelihood, fresh.names(effects), start, rival=rival)
    except SimulationError:
        return None


def _starts(models: Models, base: Fit, s: Screened, least: float) -> list[Start]:
    """Where to start refits, and what is known there, where −2 log likelihood may fall by `least`: a linear effect from zero,
    others from the most promising of several sizes: the expected change, both signs of δ, and larger ones."""
    w, likelihood = models.factory, s.likelihood
    group = s.score.effect in w.groups
    if s.score.likelihood_ratio < (
        least if s.linear or group else least / models.effort.beyond
    ):  # secants of a group are taken where it acts
        return []
    names = [*base.names, *w.parameters(s.score.effect)]
    if w.leads:  # where forces make up for what is missing, slopes say about how much that is,
        of_interest = dict(zip(s.score.names, map(float, s.delta), strict=True))
        sizes = [_expected(models, s), *([of_interest] if group else [])]  # but where a member seems to be nothing
        return [({**base.values, **size}, None) for size in sizes]
    at_mean = at_prior_mean(models, likelihood, base, models.effort.slightly if s.straight else models.effort.bent)
    calibrations = [[values[n] for n in base.names] for values in (base.values, *at_mean)]
    if s.linear and len(calibrations) == 1:
        off = _without(w, base, names)
        known = s.evidence.only(names) if set(names) <= set(s.evidence.by) else None
        return [(dict(zip(names, off, strict=True)), known)]
    thetas = _sizes(models, base, names, calibrations, s, least)
    return [(dict(zip(names, theta, strict=True)), None) for theta in dict.fromkeys(thetas)]


def _expected(models: Models, s: Screened) -> dict[str, float]:
    """An effect's sizes as slopes have them, within bounds."""
    names = models.factory.parameters(s.score.effect)
    expected, *_ = sizes_to_try(s, [models.factory.records[n] for n in names], models.factory.unfitted(names))
    return dict(zip(names, map(float, expected), strict=True))


def _sizes(
    models: Models, base: Fit, names: Sequence[str], calibrations: Sequence[Sequence[float]], s: Screened, least: float
) -> list[tuple[float, ...]]:
    """The most promising calibrations and sizes of an effect together, by `names`."""
    w, effort, likelihood = models.factory, models.effort, s.likelihood
    records = [w.records[n] for n in w.parameters(s.score.effect)]
    known, calibrated = s.evidence.only(base.names), len(base.names)
    members = [w.catalogue[member] for member in w.members(s.score.effect)]
    states, laws = (any(getattr(record, what) for record in members) for what in ("rows", "needs"))
    tries = [(*c, *size) for c in calibrations for size in sizes_to_try(s, records, w.unfitted([r.name for r in records]))]
    many = len(records) > 1 and not s.linear
    wanted = 1 if s.linear else effort.directions if many else effort.starts
    best = most_promising(likelihood, known, names, tries, wanted, s.score.signature, _signs if many else None)
    off = _without(w, base, names)
    without, most = outlook(likelihood, known, names, off).deviance, np.inf
    if s.linear:
        return [o.theta for o in best if o.deviance <= without - effort.halfway * least]
    if not (states or laws):  # with another law or more states runs may go another way altogether
        most = without - least
    if many and best:
        most = min(most, without - effort.halfway * (without - best[0].deviance))
    found = [o.theta for o in best if o.deviance <= most]
    negligible = s.negligible and any(o.deviance < without - effort.halfway * s.score.likelihood_ratio for o in best)
    if states and s.nonlinear_candidate:  # the error may fall only close to the truth
        return [*(() if negligible else found), *((*off[:calibrated], *(f * s.delta)) for f in GRID)]
    return [] if negligible else found


def _without(w: ModelFactory, base: Fit, names: Sequence[str]) -> list[float]:
    """Values of a model by `names`, of which it lacks some."""
    return [base.values.get(n, unfitted) for n, unfitted in zip(names, w.unfitted(names).tolist(), strict=True)]


def _signs(sizes: Sequence[float]) -> tuple[float, ...]:
    return tuple(np.sign(sizes))


def sizes_to_try(s: Screened, records: Sequence[Parameter], unfitted: np.ndarray) -> list[np.ndarray]:
    """Sizes (k,) of an effect's parameters from which a refit may start: from those that it is not fitted with the expected
    change, and multiples of δ of all of them, of one against the others, and of one alone, with both signs where that is
    lawful."""
    lower, upper = (np.array([getattr(r, side) for r in records]) for side in ("lower", "upper"))
    expected = np.where(np.isfinite(s.score.estimate), s.score.estimate, 0)
    several, both = len(records) > 1, bool((lower < 0).all())
    alone = [*np.diag(s.delta)] if several else []
    against = [s.delta - 2 * one for one in alone] if both else []
    multiples = (f * d for d in (s.delta, *alone, *against) for f in SIZES if f > 0 or both)
    return [np.clip(unfitted + size, lower, upper) for size in (expected, *multiples)]
