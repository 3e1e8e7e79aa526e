"""campaign.toml with other content, but with the comments, the order and the layout that somebody gave it."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, MutableMapping, Sequence, Set
from typing import Any

import tomli_w
import tomlkit
from tomlkit.container import OutOfOrderTableProxy
from tomlkit.items import AoT

Entries = Sequence[Mapping[str, Any]]


def relaid(text: str, content: Mapping[str, Any]) -> str:
    """`content` as TOML, laid out as `text`, which is TOML: what is in both stands where and as it stood, with its comments.

    What stands below a run, up to the next header, goes where that run goes. Where the layout has no place for the content,
    it is the layout that is lost. Raises TypeError for what TOML cannot hold.
    """
    plain = tomli_w.dumps(content)
    document = tomlkit.parse(text)
    _put(document, tomllib.loads(text), content)
    laid = document.as_string()
    return laid if _read(laid) == tomllib.loads(plain) else plain


def _read(text: str) -> dict[str, Any] | None:
    """The content; None where it is no TOML."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        return None


def _put(table: MutableMapping[str, Any], before: Mapping[str, Any], after: Mapping[str, Any]) -> None:
    """Change a table that holds `before` to hold `after`."""
    for key in before.keys() - after.keys():
        del table[key]
    for key, new in after.items():
        old = before.get(key)
        if isinstance(old, Mapping) and isinstance(new, Mapping) and not _scattered(table[key], old.keys() - new.keys()):
            _put(table[key], old, new)
        elif isinstance(old, list) and isinstance(table[key], AoT) and _in_order(old, new):
            _put_entries(table[key], old, new)
        elif old != new or isinstance(old, bool) != isinstance(new, bool):
            table[key] = new


def _scattered(table: Any, gone: Set[str]) -> bool:
    """Is this a table written in several places, from which keys are to go? tomlkit mixes its places up."""
    return isinstance(table, OutOfOrderTableProxy) and bool(gone)


def _files(entries: Entries) -> list[Any]:
    return [entry.get("file") for entry in entries]


def _in_order(before: Entries, after: Any) -> bool:
    """Are these runs the same by their files, but for some that are gone and some that come last?"""
    if not isinstance(after, list) or not all(isinstance(entry, Mapping) for entry in after):
        return False
    stay = [file for file in _files(before) if file in _files(after)]
    return _files(after)[: len(stay)] == stay


def _put_entries(tables: AoT, before: Entries, after: Entries) -> None:
    """Change [[tables]] that hold `before` to hold `after`."""
    stay = [entry for entry in before if entry.get("file") in _files(after)]
    for place in reversed(range(len(before))):
        if before[place].get("file") not in _files(after):
            del tables[place]
    for table, old, new in zip(tables, stay, after, strict=False):
        _put(table, old, new)
    more, followed = after[len(stay) :], _ends_blank(tables)
    for entry in more:
        _end_blank(tables)
        tables.append(tomlkit.item(entry))
    if more and followed:
        _end_blank(tables)


def _ends_blank(tables: AoT) -> bool:
    return len(tables) > 0 and tables[-1].as_string().endswith("\n\n")


def _end_blank(tables: AoT) -> None:
    if len(tables) and not _ends_blank(tables):
        tables[-1].add(tomlkit.nl())
