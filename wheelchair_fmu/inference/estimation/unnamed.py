"""How far estimates may be off by effects that nobody named: no model is exact, and every chair has a little of everything.

An effect that is not in a model is normal about zero beforehand with a standard deviation of `slight` δ. Data that see it say
more of it. What its size then is, times how far the fit moves each estimate to make up for one δ of it, is what the estimate
may be off by (the bias of omitted variables, with what is known of these).
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence

import numpy as np

from ..policy import DEFAULT, SearchPolicy
from .score import Score


def allowance(scores: Sequence[Score], causes: Mapping[str, str], estimates: int, policy: SearchPolicy = DEFAULT) -> np.ndarray:
    """Covariance (m, m) of what so many `estimates` of a model may be off by, in their units.

    `scores` are of effects that the model lacks, by its linearisation. Those of one of the `causes`, by effect, are forms in
    which it may act, and count as one."""
    forms: dict[str, list[np.ndarray]] = defaultdict(list)
    for s in scores:
        forms[causes[s.effect]].append(s.imitated @ _squares(s, policy.slight) @ s.imitated.T)
    return sum((np.mean(alike, axis=0) for alike in forms.values()), np.zeros((estimates, estimates)))


def _squares(s: Score, slight: float) -> np.ndarray:
    """Mean squares and products (k, k) of an effect's sizes, in δ, slight beforehand and as the data then have them."""
    weight = slight**2 * np.linalg.inv(s.covariance + slight**2 * np.eye(len(s.delta)))
    mean = weight @ (s.estimate / s.delta)
    return slight**2 * (np.eye(len(s.delta)) - weight) + np.outer(mean, mean)
