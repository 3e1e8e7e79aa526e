"""Headings that mean the same column and are spelt otherwise: a letter is missing, or the unit in the bracket is another.

Words that say which of several alike columns it is are no misspelling of one another: x and y, links and rechts, 1 and 2.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from difflib import SequenceMatcher
from functools import lru_cache

from ..units import split, suffixed

NEAR = 0.75  # likeness, by difflib, from which a word is another one misspelt: of four letters one
SHORT = 3  # letters of a word that can be misspelt, at least
TELLING = frozenset("lrxyz")  # letters that tell a side or an axis where a word begins or ends with them, as in gyrx and gyry
MOST = 20  # headings of a file that somebody misspells: a file with more others has other columns


def alike(one: str, other: str) -> bool:
    """Are two headings the same one but for their units, their spacing or a slip in spelling?"""
    a, b = _words(one), _words(other)
    if not a or not b:
        return False
    return "".join(a) == "".join(b) or (len(a) == len(b) and all(map(_same_word, a, b)))


def nearest(header: str, among: Iterable[str]) -> str | None:
    """The heading that this one is spelt nearest to, of those that it may be; None where it may be none."""
    close = [other for other in among if alike(header, other)]
    return max(close, key=lambda other: SequenceMatcher(None, header, other).ratio(), default=None)


def respelt(own: Collection[str], other: Collection[str]) -> dict[str, str]:
    """Headings of a file that the other one has in another spelling, with that; each is the other spelling of one alone."""
    missing = [header for header in other if header not in own]
    more = [header for header in own if header not in other]
    found: dict[str, str] = {}
    for header in more if len(more) <= MOST else ():
        if (near := nearest(header, missing)) is not None:
            found[header] = near
            missing.remove(near)
    return found


@lru_cache(4096)
def _words(header: str) -> tuple[str, ...]:
    """The words and numbers of a heading in small letters, without its unit; a capital within a word parts it, as in GyroZ."""
    bare = suffixed(split(header)[0])[0]
    return tuple(re.findall(r"\d+|[^\W\d_]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", bare).casefold()))


def _same_word(one: str, other: str) -> bool:
    if one == other:
        return True
    if min(len(one), len(other)) < SHORT or one.isdigit() or other.isdigit() or _told_apart(one, other):
        return False
    return SequenceMatcher(None, one, other).ratio() >= NEAR


def _told_apart(one: str, other: str) -> bool:
    """Do two words differ in nothing but a first or a last letter that tells a side or an axis?"""
    first = one[1:] == other[1:] and {one[0], other[0]} <= TELLING
    return first or (one[:-1] == other[:-1] and {one[-1], other[-1]} <= TELLING)
