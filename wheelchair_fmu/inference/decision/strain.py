"""Given values that a fit has bent as far as it may: another chair, or none."""

from __future__ import annotations

from collections.abc import Sequence

from ..estimation.calibration import Calibrated
from ..evidence.likelihood import MASS
from ..models.models import Models
from ..search.selection import Selection


def strained_values(models: Models, values: Sequence[Calibrated]) -> list[str]:
    """Calibrated values that a fit has bent as far as it may. A body that swings with the pushes, and that nobody recorded,
    answers them as another mass would."""
    swings = models.setting.noise_model.body > 0
    return [v.record.name for v in values if v.beyond and not (swings and v.record.name == MASS)]


def of_another_chair(found: Selection, strained: Sequence[str]) -> Sequence[str]:
    """Those of such values that the data insist on: no law is exact, and with effects that explain much, what held at its prior
    would cost no more than their laws may get wrong proves nothing of the chair."""
    models, fit = found.models, found.top.fit
    allowed = models.policy.inexact**2 * (found.calibrated - fit.deviance)
    if not strained or allowed <= 0 or models.factory.leads:
        return strained
    held = models.refit(found.effects, fit.values, without=frozenset(strained))
    return strained if held.deviance - fit.deviance > allowed else ()
