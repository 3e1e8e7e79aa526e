"""What a search takes recordings for before it looks for anything: their noise, their columns and their clocks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ...campaign import Campaign, windows
from ...model.variant import Variant
from ..evidence.noise_model import NoiseModel
from ..models.factory import ModelFactory
from ..models.models import Models, quiet
from ..preflight.timing import clocks
from .beginning import begin
from .selection import selection


@dataclass(frozen=True)
class Taken:
    """A campaign without channels that are not what they are called, and with its pushes in time; the noise that it has beside
    the chair with all its own effects; and sentences on all of this."""

    campaign: Campaign
    noise_model: NoiseModel
    notes: tuple[str, ...] = ()


def taken(campaign: Campaign, chair: Variant, say: Callable[[str], None] = quiet) -> Taken:
    """A campaign as a search of this chair takes it; as it is where no run is to be fitted.

    Of a large one a search sees windows: what it finds of noise and columns holds for all of it, and clocks stay as they are.
    """
    if not campaign.fit:
        return Taken(campaign, NoiseModel(campaign.noise))
    looked_at = windows(campaign)
    begun = begin(Models.of(ModelFactory(looked_at, chair).narrowed(), say=say))
    now = selection(begun, lambda ladder: None)
    whole = ModelFactory(campaign, chair).without(_channels(campaign) - _channels(begun.models.campaign))
    if looked_at.thinned:
        heard = begun.notes
    else:
        whole = whole.retimed(begun.retimed)
        heard = begun.heard(clocks(now.top.fit.evidence, now.top.heldout))
    return Taken(whole.campaign, now.models.setting.noise_model, (*heard, *now.models.setting.notes))


def _channels(campaign: Campaign) -> set[str]:
    return {channel for run in campaign.runs for channel in run.channels}
