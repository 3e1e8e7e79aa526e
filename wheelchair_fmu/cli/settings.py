"""`--set NAME=VALUE`: any FMI parameter, for commands that simulate."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from ..campaign import Campaign
from ..errors import UsageError
from ..model.variant import Variant


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


def applied(settings: Iterable[str], chair: Variant, measured: Campaign) -> tuple[Variant, Campaign, tuple[str, ...]]:
    """The chair and the campaign with these values, which go before the campaign file's own; and their names.

    Raises UsageError as `parse` and `Variant.with_values` do.
    """
    names = tuple(parse(settings))
    chair = chair.with_values(parse(settings))
    known = {n: chair.values[n] for n in names if n in chair.values and not n.startswith("effect.")}
    return chair, replace(measured, known={**measured.known, **known}), names
