"""What may be there though it was not named: what is probably of a size of interest, and what nobody could have seen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ..models.factory import MEASURED, ModelFactory
from ..models.models import Models
from ..search.probability import beliefs
from ..search.rounds import Round
from ..search.screen import screen


def likely_of(w: ModelFactory, decided: Mapping[str, Round], last: Round) -> dict[str, float]:
    """The probability of effects that are more probably of a size of interest than not, though none is sure enough to be named:
    of those that only help the model, by the round that decided on each, and of others beside it."""
    return {e: b.large for e, b in beliefs(decided, last, one_sided(w)).items() if b.large > 0.5}


def one_sided(w: ModelFactory) -> dict[str, np.ndarray]:
    """By effect, which of its parameters (k,) may only be positive."""
    return {e: w.one_sided(w.parameters(e)) for e in w.catalogue}


def unsure(effect: str, probability: float) -> str:
    return (
        f"{effect} is probably missing, with a size of interest ({probability:.2f}), but not surely enough to be named; "
        "further runs would tell"
    )


def powers_of(models: Models, first: Round) -> dict[str, float]:
    """With which power each effect would have been seen if it were there, but for what mass and geometry could be instead
    within what is known of them: in that case the model predicts as well without."""
    weak = [s.effect for s in first.scores if s.power < models.policy.power]
    exact = replace(first.fit, names=tuple(n for n in first.fit.names if n not in MEASURED))
    again = screen(models, replace(first.model, fit=exact), weak) if weak else []
    return {s.effect: s.power for s in (*first.scores, *(s.score for s in again))}
