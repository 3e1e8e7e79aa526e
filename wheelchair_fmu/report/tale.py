"""All that the page tells in words, before any script runs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..quantities import Quantity, Unit
from .cards import cards
from .screens import screens
from .told import Told, capital, next_words
from .words import channel_words, spoken

MERELY = 0.95  # of how much a channel varies: what is left of it that is as good as all


@dataclass(frozen=True)
class Story:
    """What the page tells: cards, screens, and what is left in units that sensors read in."""

    cards: Sequence[Mapping[str, Any]]
    screens: Sequence[Mapping[str, Any]]
    physical: Sequence[str] = ()
    following: Sequence[str] = ()  # what to measure next, and why


def story_of(
    diagnosis: Mapping[str, Any], titles: Mapping[str, str], records: Mapping[str, Quantity], units: Mapping[str, Unit]
) -> Story:
    """All of it; `records` are effects' parameters, and `units` those of channels, by name."""
    t = Told(diagnosis, titles, records)
    return Story(cards(t), screens(t), physical_words(t, units), next_words(t))


def physical_words(t: Told, units: Mapping[str, Unit]) -> list[str]:
    """What is left on runs held out in each channel's own unit, where the diagnosis says so."""
    left = t.diagnosis.get("physical") or {}
    said = []
    for name, v in left.items():
        if name in units and v.get("heldout_rms") is not None:
            error = spoken(v["heldout_rms"], None, Unit(v["unit"]))  # in the unit that it names already
            said.append(f"{capital(channel_words(name))} is predicted to within {error}{_share(v.get('share_of_sd'))}.")
    return said


def _share(share: float | None) -> str:
    if share is None:
        return ""
    if share > MERELY:
        return ", as much as it varies at all"
    return f", {f'{share:.0%}'.replace('%', ' %') if share > 0.01 else 'less than 1 %'} of how much it varies"


def texts(items: Sequence[Mapping[str, Any]]) -> list[str]:
    """All sentences of cards or screens, for reading them aloud."""
    return [s for item in items for s in (item.get("lead", item.get("title", "")), *item["lines"])]
