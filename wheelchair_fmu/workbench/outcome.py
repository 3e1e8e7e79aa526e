"""What the last diagnosis of a session says, in the sentences of the report."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from ..campaign import CHANNELS
from ..inference.decision.among_forces import FORCES
from ..model.generic import library
from ..model.stage import Effect
from ..model.variant import Variant
from ..report.tale import story_of
from ..report.words import named, sentence
from .session import Session

COMMAND = "wheelchair "  # what a sentence names that is for a terminal; here a button does it


def outcome(session: Session, catalogue: Mapping[str, Effect]) -> dict[str, Any] | None:
    """{"sentence", "cards", "effects": those of the catalogue to be put in, "order": all of its ranking, "fresh": whether it is
    of the model and the campaign as they are, "notes": sentences on recordings and values, "forces": whether it counts forces
    that nobody recorded as noise}; None before any diagnosis, and where its file cannot be read."""
    try:
        told = json.loads((session.folder / "diagnosis.json").read_text(encoding="utf-8"))
        every = {**library(), **catalogue}
        titles = {e.id: e.title for e in every.values()}
        records = {p.name: p for p in (*Variant().parameters(), *(p for e in every.values() for p in e.owned))}
        story = story_of(told, titles, records, {c.name: c.unit for c in CHANNELS})
        return {
            "sentence": sentence(told, titles, records),
            "cards": [{**card, "lines": [line for line in card["lines"] if COMMAND not in line]} for card in story.cards],
            "effects": [e for e in told["effects"] if e in catalogue and told["verdict"] != "small"],
            "order": [row["effect"] for row in told["ranking"] if row["effect"] in catalogue],
            "fresh": session.diagnosed,
            "notes": [named(note, titles, records) for note in told["notes"]],
            "forces": any(step["step"] == FORCES for step in told["ladder"]),
        }
    except (OSError, ValueError, KeyError, TypeError, IndexError):
        return None  # somebody has broken the file, or it is of another version: diagnosing again makes it anew
