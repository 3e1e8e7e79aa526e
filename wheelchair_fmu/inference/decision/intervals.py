"""Intervals of what was found, and by how much causes that nobody named may move estimates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..estimation.interval import interval_by_errors, profile_interval, widened
from ..estimation.problem import Fit
from ..estimation.score import Score
from ..estimation.unnamed import allowance
from ..models.hypothesis import Model
from ..models.models import Models
from ..search.rounds import Round
from ..search.screen import screen
from ..search.selection import Selection


def allowance_of(found: Selection) -> dict[str, float]:
    """By how much (a standard deviation, by name) the estimates of the last model may be off by causes that nobody named. Those
    that a nuisance of the campaign stands for are allowed for by it. A model with as many effects as are put in was not
    searched for more, so that it is screened for this."""
    last = next((r for r in reversed(found.rounds) if r.effects == found.effects), None)
    return _allowed(found.models, found.top, last.scores if last else [s.score for s in screen(found.models, found.top)])


def _allowed(models: Models, model: Model, scores: Sequence[Score]) -> dict[str, float]:
    """The same of any model, with the scores of what it lacks."""
    causes = {e: record.cause for e, record in models.factory.catalogue.items()}
    named = {causes[e] for e in model.effects}
    others = [s for s in scores if causes[s.effect] not in named and s.effect not in models.doubles]
    names = model.fit.names
    covariance = allowance(others, causes, len(names), models.policy)
    return dict(zip(names, map(float, np.sqrt(np.diag(covariance))), strict=True))


def intervals_of(
    models: Models, included: Sequence[str], effects: Sequence[str], found: Fit, allowed: Mapping[str, float]
) -> dict[str, tuple[float, float]]:
    """Intervals of the parameters of the effects that were found."""
    likelihood, names = models.likelihood(included), [n for e in effects for n in models.factory.parameters(e)]

    def interval(name: str) -> tuple[float, float]:
        more, record = allowed.get(name, 0.0), likelihood.records[name]
        if models.factory.leads:  # no value was found by how likely the readings are
            return interval_by_errors(found, found.names.index(name), more, record)
        return widened(profile_interval(likelihood, found, name), found.values[name], more, record)

    return {n: interval(n) for n in names if n in found.names}


def intervals_of_rivals(found: Selection, ties: Sequence[tuple[Sequence[str], Round]]) -> dict[str, tuple[float, float]]:
    """Intervals of what is tied with an effect of the last model, each in the model that has it instead."""
    models, intervals = found.models, dict[str, tuple[float, float]]()
    for group, r in ties:
        fits = {c.effect: c.fit for c in r.candidates}
        for rival in (e for e in group if e not in found.effects):
            model = models.model((*r.effects, rival), fits[rival].values)
            allowed = _allowed(models, model, [s.score for s in screen(models, model)])
            intervals |= intervals_of(models, model.effects, (rival,), model.fit, allowed)
    return intervals
