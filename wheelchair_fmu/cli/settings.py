"""`--set NAME=VALUE`: any FMI parameter, for commands that simulate."""

from __future__ import annotations

from collections.abc import Iterable

from ..errors import UsageError


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
