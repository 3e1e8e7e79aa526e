"""`--set NAME=VALUE`, any FMI parameter, and the chair that it and the other options make."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path

from ..campaign import Campaign
from ..contracts.own import catalogue
from ..errors import UsageError
from ..fmu.build import with_chosen_effects
from ..loop.subject import applied, chair
from ..model.stage import Effect
from ..model.variant import Variant, read_variant
from .check import measurements

__all__ = ["catalogue", "chair_of", "parse", "subject"]


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
    return applied(parse(settings or ()), chair(variant, effects), measurements(campaign))


def chair_of(file: Path | None, equations: str | None, given: Mapping[str, str], catalogue: Mapping[str, Effect]) -> Variant:
    """The variant asked for, with the effects that --set names; their values are checked on the way."""
    start = read_variant(file, catalogue) if file else Variant(catalogue=catalogue)
    if equations:
        start = replace(start, choice=replace(start.choice, equations=equations))
    named = dict.fromkeys(name.split(".")[1] for name in given if name.startswith("effect.") and name.count(".") > 1)
    return with_chosen_effects(start, named).with_values(given)
