"""What is missing, drawn: a quantity as a free function of one variable after another, with its band."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...model.stage import Effect
from ..estimation.problem import Fit, prior_of
from ..estimation.score import robust_variance
from ..models.models import Models
from ..search.screen import projector

SUPPORTED = 0.9  # of a knot's prior variance that the data must take away, for the knot to be drawn


@dataclass(frozen=True)
class Profile:
    """Estimates (k,) with standard errors at the knots of one variable; NaN where the data say nothing."""

    effect: str
    estimate: np.ndarray
    se: np.ndarray


def profiles(models: Models, base: Fit, effects: tuple[str, ...], free: Mapping[str, Effect]) -> list[Profile]:
    """One linear estimate for each of the `free` effects, beside a model without what is missing.

    Each is estimated alone, from the innovations and with the calibrated directions taken off; the spread of size 10 δ about
    zero keeps knots that the data hardly reach from running away.
    """
    wider = models.widened(free)
    factory, likelihood = wider.factory, wider.wide(effects)
    names = [n for effect in free for n in factory.parameters(effect)]
    evidence = likelihood.evidence(wider.campaign.fit, base.values, [*base.names, *names])
    k, off = len(base.names), projector(likelihood, base, evidence)
    found = []
    for effect in free:
        own = factory.parameters(effect)
        columns = evidence.S[:, [k + names.index(n) for n in own]]
        s, strained, _ = off.with_strained(columns)
        prior = prior_of(likelihood, own).sd
        known = strained.T @ strained + np.diag(prior**-2.0)
        inverse = np.linalg.inv(s.T @ s + known)
        covariance = inverse @ (robust_variance(evidence, s, evidence.r) + known) @ inverse
        seen = np.diag(inverse) < (1 - SUPPORTED) * prior**2
        estimate, se = inverse @ (s.T @ evidence.r + strained.T @ off.rows), np.sqrt(np.diag(covariance))
        found.append(Profile(effect, np.where(seen, estimate, np.nan), np.where(seen, se, np.nan)))
    return found
