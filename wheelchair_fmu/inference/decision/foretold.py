"""How well the models of a staircase foretell what was held out, in the units of the instruments and by the same readings; and
where the last one does so worse than the calibrated one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ...campaign import BY_NAME
from ...errors import SimulationError
from ..models.models import Models
from ..residual.physical import channel_errors, pooled
from ..residual.staircase import Step

WORSE = 1.1  # times an error: a start that is off within what readings say of it changes one by less


def on_led_runs(step: Step, values: Mapping[str, float], led: Models) -> Step:
    """A step of a search on whole runs, with the errors that its `values` leave where the chair rolls, as those of all further
    steps are of a search that is `led`; whitened it stays as it is."""
    campaign, likelihood = led.campaign, led.likelihood()
    try:
        fitted, held = (channel_errors(likelihood.evidence(runs, values)) for runs in (campaign.fit, campaign.holdout))
    except SimulationError:  # it goes another way than any force could lead it: so its errors are of whole runs
        return step
    return replace(step, fit_errors=fitted, heldout_errors=held)


def worsened(ladder: Sequence[Step]) -> list[str]:
    """A sentence for each channel that the last model foretells clearly worse on held-out runs than the calibrated one does."""
    (_, calibrated, *further) = ladder
    if not further:
        return []
    last = further[-1]
    before, after = (pooled(step.heldout_errors.values()) for step in (calibrated, last))
    return [
        f"{channel}: on the runs held out the last model is off by {error.rms:.2g} {error.unit}, where the calibrated one is "
        f"by {before[channel].rms:.2g}: for this channel what was found is no improvement"
        for channel, error in after.items()
        if channel in before and error.rms > WORSE * before[channel].rms and not _drifted(channel, calibrated, last)
    ]


def worse(calibrated: Step, last: Step) -> bool:
    """Does a model foretell runs that were held out clearly worse than the calibrated one, over all channels: by the geometric
    mean of its errors over those?"""
    before, after = (pooled(step.heldout_errors.values()) for step in (calibrated, last))
    both = [c for c in after if c in before and before[c].rms > 0 and after[c].rms > 0 and not _drifted(c, calibrated, last)]
    return bool(both) and float(np.mean([np.log(after[c].rms / before[c].rms) for c in both])) > np.log(WORSE)


def _drifted(channel: str, calibrated: Step, last: Step) -> bool:
    """Is a position or heading further off by chance alone? What pushes a chair a little adds up there without end, and by what
    each reading adds to those before it the last model is not worse."""
    before, after = (step.heldout_whitened.get(channel, np.nan) for step in (calibrated, last))
    return BY_NAME[channel].drifts and not after > before
