"""`--set NAME=VALUE`, any FMI parameter, and what a command of the loop is about by its options."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from ..campaign import Campaign
from ..contracts.own import catalogue
from ..errors import UsageError
from ..inference.subject import applied, chair
from ..model.variant import Variant
from .check import measurements

__all__ = ["catalogue", "parse", "subject"]


def parse(settings: Iterable[str]) -> dict[str, str]:
    """Names and values as written; the later of two for one name holds.

    Raises UsageError for a word that is not NAME=VALUE.
    """
    found = {}
    for word in settings:
        name, equals, value = (part.strip() for part in word.partition("="))
        if not (name and equals and value):
            raise UsageError(f"--set {word!r} is not NAME=VALUE; write for example --set chair.m=90")
        found[name] = value
    return found


def subject(
    campaign: Path, variant: Path | None, effects: Path | None, settings: Iterable[str] | None
) -> tuple[Variant, Campaign, tuple[str, ...]]:
    """What a command of the loop is about, by its options: the chair, the measurements, and the names that --set fixes."""
    start = chair(variant, effects)
    return applied(parse(settings or ()), start, measurements(campaign, start.catalogue, start.choice))
