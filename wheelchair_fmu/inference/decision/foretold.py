"""How well the models of a staircase foretell what was held out, in the units of the instruments and by the same readings; and
where the last one does so worse than the calibrated one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import inf, sqrt

import numpy as np

from ...campaign import BY_NAME
from ...errors import SimulationError
from ..models.models import Models
from ..residual.physical import ChannelError, channel_errors, pooled
from ..residual.staircase import Step

NO_BETTER = 1.05  # times an error: a constant that is as far off as that is no worse
PLAIN = 2.0  # times a sensor's noise, from which there is something to foretell
WORSE = 1.1  # times an error: a start that is off within what readings say of it changes one by less


def on_led_runs(step: Step, values: Mapping[str, float], led: Models, effects: Sequence[str] = ()) -> Step:
    """A step of a search on whole runs, with the errors that its `values` leave, of a model with these effects, where the chair
    rolls, as those of all further steps are of a search that is `led`; whitened it stays as it is."""
    campaign, likelihood = led.campaign, led.likelihood(effects)
    try:
        fitted, held = (channel_errors(likelihood.evidence(runs, values)) for runs in (campaign.fit, campaign.holdout))
    except SimulationError:  # it goes another way than any force could lead it: so its errors are of whole runs
        return step
    return replace(step, fit_errors=fitted, heldout_errors=held)


def remarks(ladder: Sequence[Step], noise: Mapping[str, float]) -> list[str]:
    """All that follows of a staircase, with the sensors' `noise` (SI)."""
    return [*raised(ladder), *worsened(ladder), *untold(ladder[-1], noise)]


def worsened(ladder: Sequence[Step]) -> list[str]:
    """A sentence for each channel that the last model foretells clearly worse on held-out runs than the calibrated one does."""
    (_, calibrated, *further) = ladder
    if not further:
        return []
    return [
        f"{channel}: on the runs held out the last model is off by {after.rms:.2g} {after.unit}, where the calibrated one is "
        f"by {before.rms:.2g}: for this channel what was found is no improvement"
        for channel, before, after in _by_channel(calibrated, further[-1])
        if after.rms > WORSE * before.rms
    ]


def untold(last: Step, noise: Mapping[str, float]) -> list[str]:
    """A sentence for each channel that a model foretells no better than a constant does, with clearly more left than its
    sensor's `noise` (SI), of which nobody foretells anything."""
    held = bool(last.heldout_errors)
    errors = pooled((last.heldout_errors if held else last.fit_errors).values())
    return [
        f"{channel}: on the runs {'held out' if held else 'fitted'} the last model is off by {e.rms:.3g} {e.unit}, and a "
        f"constant for each run by {e.constant:.3g}: what changes there it does not foretell"
        for channel, e in errors.items()
        if e.rms * NO_BETTER > e.constant and sqrt(e.squares / max(e.count, 1)) > PLAIN * noise.get(channel, inf)
    ]


def raised(ladder: Sequence[Step]) -> list[str]:
    """A sentence where calibration leaves a clearly larger error than given values do, on fitted or on held-out runs."""
    nominal, calibrated = ladder[:2]
    sides = (("fitted", nominal.fit, calibrated.fit), ("held-out", nominal.heldout, calibrated.heldout))
    told = [f"that of {which} runs from {a:.2f} to {b:.2f}" for which, a, b in sides if b > WORSE * max(a, 1.0)]
    if not told:
        return []
    return [
        f"calibration raises the error, {' and '.join(told)}: a fit weighs what each reading says beyond those before it, and "
        "where something is missing that no calibrated value stands for, whole runs may go further off"
    ]


def worse(other: Step, last: Step) -> bool:
    """Does a model foretell runs that were held out clearly worse than another one, over all channels: by the geometric mean of
    its errors over those?"""
    told = [(before.rms, after.rms) for _, before, after in _by_channel(other, last) if before.rms > 0 and after.rms > 0]
    return bool(told) and float(np.mean([np.log(after / before) for before, after in told])) > np.log(WORSE)


def _by_channel(other: Step, last: Step) -> list[tuple[str, ChannelError, ChannelError]]:
    """Each channel with its errors on held-out runs by both, but for one that is further off by chance alone."""
    before, after = (pooled(step.heldout_errors.values()) for step in (other, last))
    return [(c, before[c], e) for c, e in after.items() if c in before and not _drifted(c, other, last)]


def _drifted(channel: str, other: Step, last: Step) -> bool:
    """Is a position or heading further off by chance alone? What pushes a chair a little adds up there without end, and by what
    each reading adds to those before it the last model is not worse."""
    before, after = (step.heldout_whitened.get(channel, np.nan) for step in (other, last))
    return BY_NAME[channel].drifts and not after > before
