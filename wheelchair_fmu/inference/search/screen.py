"""The screen: which effects of the catalogue would help, by score tests, before any is refitted."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ...errors import SimulationError
from ..chance import chance_beyond
from ..estimation.marginal import squared
from ..estimation.problem import Fit, prior_of
from ..estimation.score import Projector, Score, score
from ..estimation.statistics import cosines
from ..evidence.evidence import Evidence
from ..evidence.likelihood import Likelihood
from ..models.factory import ModelFactory
from ..models.hypothesis import Model
from ..models.models import Models
from ..parallel import parallel_map
from ..policy import Effort

DRY = (1.0, 2.0, 4.0, 8.0)  # times δ of dry friction, whose likelihood is asked where forces lead the runs


@dataclass(frozen=True)
class Screened:
    """An effect's score, and the evidence it rests on, with sensitivities by what is fitted, by this effect and by others.
    `likelihood` runs that evidence again with any size of it.
    `straight`: it does most about calibrated values as the campaign has them, not as a fit without it left them."""

    score: Score
    evidence: Evidence
    likelihood: Likelihood
    delta: np.ndarray
    linear: bool
    effort: Effort
    straight: bool = False

    @property
    def negligible(self) -> bool:
        """Does it gain little, being surely a small part of its smallest interesting size?"""
        far = np.abs(self.score.estimate) + 3 * self.score.se
        return self.score.likelihood_ratio < self.effort.little and bool(np.all(far < self.effort.negligible * self.delta))

    @property
    def nonlinear_candidate(self) -> bool:
        """Is enough left, and hoped for, that an effect of another size may do what no slope tells?"""
        hinted = self.score.likelihood_ratio > self.effort.hint
        return not self.linear and hinted and float(np.mean(self.evidence.r**2)) > self.effort.room


def screen(models: Models, base: Model, among: Iterable[str] | None = None) -> list[Screened]:
    """Score tests of every effect not yet in the model: by slope at zero where that is cheap, by secant where it is not or may
    mislead."""
    return _screened(models, base, among)[0]


def screen_groups(models: Models, base: Model) -> tuple[list[Screened], list[Screened]]:
    """The same, and score tests of effects that may show only together: of groups none of which is in the model, where they
    promise more than one of them does alone."""
    w = models.factory
    screened, here = _screened(models, base)
    alone = {s.score.effect: s.score.likelihood_ratio for s in screened}
    groups = [g for g, members in w.groups.items() if set(members) <= set(alone)]
    joined = _by_secants(models, models.rerun((*base.effects, *groups)), base, here, groups) if groups else []
    more = (s for s in joined if s.score.likelihood_ratio > models.promising + max(alone[e] for e in w.members(s.score.effect)))
    return screened, sorted(more, key=lambda s: -s.score.likelihood_ratio)


def projector(likelihood: Likelihood, base: Fit, here: Evidence) -> Projector:
    """Takes what calibration can imitate off any columns."""
    prior = prior_of(likelihood, base.names)
    rows = prior.rows(np.array([base.values[n] for n in base.names]))
    return Projector(here.S[:, : len(base.names)], prior.slopes, rows, base.names)


def at_prior_mean(models: Models, likelihood: Likelihood, base: Fit, least: float) -> list[dict[str, float]]:
    """Calibrated values as the campaign has them, if a fit that leaves something has bent them by `least` standard
    deviations. None where forces lead the runs, which make up for what values would be bent for. What is known to be as small
    as can be, as the speed over which drag sets in, stays as it was found: it lies beside that bound in every chair, and at the
    bound itself, where dry friction holds whatever stands, no slope tells of anything."""
    if likelihood.leads or base.evidence.rms < models.policy.nothing_left:
        return []
    prior, values = prior_of(likelihood, base.names), np.array([base.values[n] for n in base.names])
    known = np.isfinite(prior.sd) & (prior.sd > 0) & (prior.mean > [likelihood.records[n].lower for n in base.names])
    off = np.where(known, np.abs(values - prior.mean) / prior.sd, 0.0)
    straight = np.where(known, prior.mean, values)
    return [dict(zip(base.names, map(float, straight), strict=True))] if off.max(initial=0) > least else []


def _screened(models: Models, base: Model, among: Iterable[str] | None = None) -> tuple[list[Screened], Evidence]:
    """Scores, the most promising first, and the evidence for the model as it is."""
    w = models.factory
    free = [e for e in (among if among is not None else w.catalogue) if e not in base.effects and w.parameters(e)]
    light = [e for e in free if e in w.light]
    dear = [more for group in (w.heavy, w.demanding) if (more := [e for e in free if e in group])]
    wanted = [partial(models.wide, base.effects), *(partial(models.rerun, (*base.effects, *more)) for more in dear)]
    parallel_map(lambda make: make().sensitivities.library, wanted)  # those that are not compiled yet, side by side
    found, here = _by_slopes(models, base, [e for e in light if e not in models.doubles])
    # Beside unrecorded forces an offset without its nuisance would be made up for by these.
    for effect in [] if w.leads else [e for e in light if e in models.doubles]:
        found += _by_slopes(models, models.rival_of(effect, base), [effect])[0]
    for more in dear:
        found += _by_secants(models, models.rerun((*base.effects, *more)), base, here, more)
    return sorted(found, key=lambda s: -s.score.likelihood_ratio), here


def _by_slopes(models: Models, base: Model, light: Sequence[str]) -> tuple[list[Screened], Evidence]:
    """Scores of effects that make no simulation dearer, and the evidence with sensitivities by all of them."""
    w, fit = models.factory, base.fit
    likelihood, names = models.wide(base.effects), [n for e in light for n in w.parameters(e)]
    here = likelihood.evidence(w.campaign.fit, fit.values, [*fit.names, *names])
    off, at_mean = projector(likelihood, fit, here), _slopes_at_prior_mean(models, likelihood, fit, names)

    def screened(effect: str) -> Screened:
        own, columns = ([by.index(n) for n in w.parameters(effect)] for by in (here.by, names))
        tangent = _score(w, here, off, effect, here.S[:, own])
        bent = [] if w.linear(effect) else _secants(w, likelihood, here, fit.values, effect)
        secants = [_score(w, here, off, effect, S) for S in (*bent, *(S[:, columns] for S in at_mean))]
        return _most_promising(models, [tangent, *secants], here, likelihood)

    return parallel_map(screened, light), here


def _by_secants(models: Models, likelihood: Likelihood, base: Model, here: Evidence, effects: Sequence[str]) -> list[Screened]:
    """Scores of effects with states of their own. To follow these through all derivatives costs more than to try a size, and
    the filters of the model without them serve: at zero they change nothing."""
    w, fit, at = models.factory, base.fit, list[tuple[Mapping[str, float], Evidence]]()
    for values in (fit.values, *at_prior_mean(models, likelihood, fit, models.effort.slightly)):
        try:
            at.append((values, likelihood.resimulated(here, values)))
        except SimulationError:
            if not at:
                return []
    off = projector(likelihood, fit, here)

    def screened(effect: str) -> Screened | None:
        by = [[_score(w, at[0][1], off, effect, S) for S in _secants(w, likelihood, e, values, effect)] for values, e in at]
        scores = [score for group in by for score in group]
        if not scores:
            return None
        best = _most_promising(models, scores, here, likelihood)
        straight = all(best.score.likelihood_ratio > score.likelihood_ratio for score in by[0])
        return replace(best, score=_where_friction_holds(models, base, here, best.score), straight=straight)

    return [s for s in parallel_map(screened, effects) if s]


def _where_friction_holds(models: Models, base: Model, here: Evidence, told: Score) -> Score:
    """An effect's score by the likelihood of several sizes, where forces lead the runs and it is dry friction, if that falls
    by more than slopes say. Along the path of a model in which nothing is held, friction does next to nothing; where it is
    large forces take another path, by which it shows, and no slope leads there."""
    w = models.factory
    if not (w.leads and w.dry(told.effect)):
        return told
    dry = np.array([w.records[n].dry for n in told.names])
    near, off = models.likelihood((*base.effects, told.effect)).beside(here), w.unfitted(told.names)
    sizes = [off + told.delta * np.where(dry, times, 1.0) for times in DRY]

    def deviance(size: np.ndarray) -> float:
        there = {**base.fit.values, **dict(zip(told.names, map(float, size), strict=True))}
        try:
            return near.evidence(w.campaign.fit, there).deviance
        except SimulationError:
            return math.inf

    without, *tried = map(deviance, (off, *sizes))
    best = int(np.argmin(tried))
    fall = without - tried[best]
    if not max(told.likelihood_ratio, 0.0) < fall < math.inf:
        return told
    estimate = sizes[best] - off
    covariance = told.covariance * squared(estimate / told.delta, told.covariance) / fall
    se = np.sqrt(np.diag(covariance)) * told.delta
    p = chance_beyond(fall, len(estimate))
    return replace(told, estimate=estimate, se=se, p=p, likelihood_ratio=fall, covariance=covariance)


def _most_promising(models: Models, scores: Sequence[Score], here: Evidence, likelihood: Likelihood) -> Screened:
    """The most promising of several scores of an effect, with the first one's p: that nobody picked."""
    w, best = models.factory, max(scores, key=lambda s: s.likelihood_ratio)
    told = replace(best, p=scores[0].p)
    return Screened(told, here, likelihood, w.deltas(best.names), w.linear(best.effect), models.effort)


def _slopes_at_prior_mean(models: Models, likelihood: Likelihood, base: Fit, names: Sequence[str]) -> list[np.ndarray]:
    """Slopes (N, k) by `names` with calibrated values as the campaign has them, where a fit without the effect has bent them:
    what it bent to imitate an effect may be what the effect works through."""
    at_mean = at_prior_mean(models, likelihood, base, models.effort.bent) if names else []
    try:
        return [likelihood.evidence(likelihood.campaign.fit, values, names).S for values in at_mean]
    except SimulationError:
        return []


def _score(w: ModelFactory, evidence: Evidence, off: Projector, effect: str, S: np.ndarray) -> Score:
    names = w.parameters(effect)
    return score(evidence, off, effect, names, S, w.deltas(names), w.one_sided(names))


def _secants(
    w: ModelFactory, likelihood: Likelihood, known: Evidence, values: Mapping[str, float], effect: str
) -> list[np.ndarray]:
    """What the effect really does at its smallest interesting size, and at minus that where that may be another thing:
    (N, k) per unit, each. `known` is the evidence at `values`, where it is off. Of a group each member is tried beside those
    before it, by which it acts."""
    names = w.parameters(effect)
    records = [w.records[n] for n in names]
    values = {**dict(zip(names, w.unfitted(names).tolist(), strict=True)), **values}
    found = []
    for sign in (1.0,) if w.linear(effect) else (1.0, -1.0):
        sizes = {r.name: sign * r.delta for r in records if r.lower <= sign * r.delta}
        members = [{n: sizes[n] for n in w.parameters(member) if n in sizes} for member in w.members(effect)]
        try:
            columns = _one_by_one(likelihood, known, values, members)
        except SimulationError:
            continue
        if len(columns) == len(records):
            found.append(np.stack(columns, axis=1))
    return found


def _one_by_one(
    likelihood: Likelihood, known: Evidence, values: Mapping[str, float], members: Sequence[Mapping[str, float]]
) -> list[np.ndarray]:
    """What each parameter of some effects does (N,) per unit of so much more than `values` have, beside the members before its
    own at theirs."""
    columns: list[np.ndarray] = []
    before, r = dict(values), known.r
    for i, own in enumerate(members):
        for n, size in own.items():
            moved = likelihood.resimulated(known, {**before, n: before[n] + size}, whole=False).r
            columns.append((r - moved) / size)
        before |= {n: before[n] + size for n, size in own.items()}
        if i < len(members) - 1:
            r = likelihood.resimulated(known, before, whole=False).r
    return columns


def shortlist(models: Models, screened: Sequence[Screened]) -> list[Screened]:
    """The best by expected fall, some more of those whose slopes say little, and whatever may do nearly as much as the leader
    or looks like it; not what is surely far too small to matter."""
    effort, leads = models.effort, models.factory.leads
    hopeful = (s for s in screened if s.score.likelihood_ratio > models.promising)
    promising = [s for s in hopeful if s.nonlinear_candidate or not s.negligible]
    first, others = promising[: effort.shortlist], promising[effort.shortlist :]
    if not others:
        return first
    curved = [s.score.effect for s in others if s.nonlinear_candidate][: effort.curved]
    leader = first[0].score
    (alike,) = cosines([leader], [s.score for s in others])

    def wanted(s: Screened, cosine: float) -> bool:
        near = effort.halfway if s.linear or leads else 1 / effort.beyond  # of a fall, as far as slopes tell
        may = s.score.likelihood_ratio > near * leader.likelihood_ratio
        return s.score.effect in curved or may or cosine > effort.alike

    return [*first, *(s for s, cosine in zip(others, alike, strict=True) if wanted(s, cosine))]
