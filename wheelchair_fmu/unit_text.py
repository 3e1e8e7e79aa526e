"""A unit as loggers write it, such as km/h, N·m or m.s-2, taken apart into names and whole exponents.

::

    product  = factor { ["*" | "·" | "." | "×" | "-" | "/" | "per" | blank] factor }     "-" only before a letter
    factor   = ("1" | name | "(" product ")") [exponent]
    exponent = ["^" | "**"] ["-"] digit | ("^" | "**") "(" ["-"] digit ")" | superscript

Nothing is evaluated, and every length has a limit: the text of a unit comes from whoever wrote the file.
"""

from __future__ import annotations

import re

LONGEST = 60  # characters
MOST_POWER = 9
# What a logger's name stands for, where libraries of units call something else by it, or nothing.
ALIASES = {
    "Nm": "N.m",
    "mNm": "mN.m",
    "kNm": "kN.m",
    "cNm": "cN.m",
    "dps": "deg/s",
    "mdps": "mdeg/s",
    "rev": "revolution",
    "revs": "revolution",
    "°": "deg",
    "Grad": "deg",
    "%": "percent",
    "kph": "km/h",
    "lbft": "lbf.ft",
    "ftlb": "lbf.ft",
    "°C": "degC",
    "°F": "degF",
    "μs": "us",
    "µs": "us",
}
RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹"
LETTERS = rf"[^\W\d_{RAISED}]+"
NAME = re.compile(rf"°[CF]?|%|{LETTERS}(?:_{LETTERS})*")
EXPONENT = re.compile(
    rf"\s*(?:\^|\*\*)\s*(?:([-+]?\d)(?!\.?\d)|\(\s*([-+]?\d)\s*\))|(-?\d)(?!\.?\d)|([⁺⁻]?[{RAISED}])(?![{RAISED}])", re.ASCII
)
JOINT = re.compile(rf"\s*(?:[*·⋅×.]|-(?=\s*{LETTERS}))\s*|\s+(?=[^/\s])")
SLASH = re.compile(r"\s*/\s*|\s+per\s+")
PLAIN = str.maketrans(f"⁺⁻{RAISED}", "+-0123456789")

Powers = dict[str, int]  # exponents by the names of units


def parsed(text: str) -> Powers | None:
    """The names in a unit with their exponents; None where the text is none, or longer than a unit is."""
    if len(text) > LONGEST:
        return None
    try:
        powers, end = _product(text.strip(), 0)
    except _NoUnitError:
        return None
    return powers if end == len(text.strip()) else None


class _NoUnitError(Exception):
    pass


def _product(text: str, at: int) -> tuple[Powers, int]:
    powers, at = _factor(text, at)
    while at < len(text) and text[at] != ")":
        slash = SLASH.match(text, at)
        joint = slash or JOINT.match(text, at)
        if not joint and text[at] != "(":
            raise _NoUnitError
        more, at = _factor(text, joint.end() if joint else at)
        powers = _times(powers, more, -1 if slash else 1)
    return powers, at


def _factor(text: str, at: int) -> tuple[Powers, int]:
    if text[at : at + 1] == "(":
        powers, at = _product(text, at + 1)
        if text[at : at + 1] != ")":
            raise _NoUnitError
        at += 1
    elif text[at : at + 1] == "1":
        return {}, at + 1
    elif name := NAME.match(text, at):
        powers, at = _named(name[0]), name.end()
    else:
        raise _NoUnitError
    if found := EXPONENT.match(text, at):
        written = next(group for group in found.groups() if group)
        return _times({}, powers, int(written.translate(PLAIN))), found.end()
    return powers, at


def _named(name: str) -> Powers:
    meant = ALIASES.get(name)
    return {name: 1} if meant is None else {name: 1} if meant == name else parsed(meant) or {}


def _times(one: Powers, other: Powers, power: int) -> Powers:
    """`one` · `other`^power."""
    made = dict(one)
    for name, exponent in other.items():
        made[name] = made.get(name, 0) + power * exponent
    if not all(abs(exponent) <= MOST_POWER for exponent in made.values()):
        raise _NoUnitError
    return made
