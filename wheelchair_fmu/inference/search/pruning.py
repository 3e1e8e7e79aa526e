"""Backward: what of a model's effects the others have made needless."""

from __future__ import annotations

from collections.abc import Container

from ..estimation.problem import Fit
from ..estimation.statistics import margin
from ..models.models import Models


def pruned(models: Models, effects: tuple[str, ...], found: Fit, keep: Container[str] = ()) -> tuple[tuple[str, ...], Fit]:
    """Leave out every effect but the last, and those to `keep`, that the others have made needless."""
    leads = models.factory.leads
    for effect in effects[:-1]:
        weight = models.weight(found, effect)
        plain = models.policy.tied * (1.0 if leads else models.effort.plainly)
        by_errors = leads and not models.factory.dry(effect)  # of what holds, likelihoods tell more than slopes
        if effect in keep or weight > plain:
            continue  # by its standard errors it is so far from zero that nobody needs to try without
        fewer = tuple(e for e in effects if e != effect)
        without = models.fitted(fewer, found.values)
        if by_errors or without.deviance - found.deviance < margin(found.evidence, models.policy):
            return pruned(models, fewer, without, keep)
    return effects, found
