"""A text file as a table that is not yet numbers: headers, units and body, and in sentences what was found about them."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from math import isfinite
from typing import Any

from .dialect import (
    GROUPED,
    SPACES,
    bare,
    cells,
    columns_of_numbers,
    decimal_of,
    decode,
    find,
    grouped,
    is_binary,
    is_comment,
    is_data,
    named,
    same_unit,
    sample,
    separator_of,
    told_apart,
    uncommented,
)
from .faults import Fault, run_fault
from .units import split, suffixed

_EMPTY = "export it again, or leave it out"
_DECIMAL_COMMA = r"(?:^|{0})[ ]*[-+]?\d*,\d+(?:[eE][-+]?\d+)?[ ]*(?=$|{0})"
_MOST_PREAMBLE = 20000  # lines
_BETWEEN = {"tab": "\t", "space": SPACES, "spaces": SPACES}  # what stands between cells, in words
# What options may be, what another one is not, and what to give instead.
_LAWFUL: Mapping[str, tuple[Callable[[Any], bool], str, str]] = {
    "separator": (lambda s: s in _BETWEEN or len(s) == 1, "separator", 'one character, such as ",", or "tab" or "spaces"'),
    "decimal": (lambda s: s in (".", ","), "decimal sign", '"." or ","'),
    "skip": (lambda n: n >= 0 and n % 1 == 0, "number of lines", "how many stand above the header"),
}


@dataclass(frozen=True)
class Text:
    """The parts of a text file. `header_line` and `first_line` count from 1; `numeric` are the places of columns of numbers."""

    headers: tuple[str, ...]
    units: tuple[str | None, ...]
    body: str = field(repr=False)
    separator: str
    decimal: str
    header_line: int
    first_line: int
    numeric: tuple[int, ...]
    rows: tuple[tuple[str, ...], ...] = field(repr=False)  # the first ones
    notes: tuple[str, ...] = ()
    above: tuple[str, ...] = ()  # lines before the header, as they stand


def parse(file: str, raw: bytes, options: Mapping[str, Any] | None = None) -> tuple[Text | None, list[Fault]]:
    """The parts of a text file, or the fault that stands in the way.

    `options` may hold encoding, separator, decimal and skip (lines before the header).
    """
    options = {name: value for name, value in (options or {}).items() if _is_one(name, value)}
    for name, (lawful, what, cure) in _LAWFUL.items():
        if name in options and not lawful(options[name]):
            fact = f"{name} = {options[name]!r} is no {what}"
            return None, [run_fault(file, fact, f"give {cure}, or leave it out to have it found")]
    if is_binary(raw):
        return None, [run_fault(file, "the file is binary, not text", "export it as CSV, or name its format")]
    try:
        text, encoding = decode(raw, str(options.get("encoding") or ""))
    except (UnicodeDecodeError, LookupError):
        fact = f"the file is not written in {options['encoding']}"
        return None, [run_fault(file, fact, "correct encoding, or leave it out to have it found")]
    if not text.strip():
        return None, [run_fault(file, "the file is empty", _EMPTY)]
    notes = [f"encoding {encoding}"] if encoding else []
    return _parsed(file, text.replace("\r\n", "\n").replace("\r", "\n"), options, notes)


def _is_one(name: str, value: Any) -> bool:
    """Is an option a text, or a number where it is to be one? What is not is told with the campaign's keys."""
    if name != "skip":
        return isinstance(value, str)
    return isinstance(value, (int, float)) and not isinstance(value, bool) and isfinite(value)


def _parsed(file: str, text: str, options: Mapping[str, Any], notes: list[str]) -> tuple[Text | None, list[Fault]]:
    seen = sample(text)
    asked = options.get("separator")
    separator = _BETWEEN.get(str(asked), asked) or separator_of(seen) or _by_header(text)
    rows = [cells(line, separator) for line in seen]
    numeric = columns_of_numbers(rows)
    above, layout_first = _above(text, separator, numeric, options.get("skip"))
    if layout_first is None:
        return _without_numbers(file, text, separator, notes)
    width = max(numeric, default=0) + 1
    layout = find(above, layout_first, width)
    if layout.header is None and (changed := _parted_otherwise(file, text, separator, layout_first)):
        return None, [changed]
    if layout.header is None:
        fact = f"line {layout_first + 1} already holds numbers: there is no header above it"
        cure = "write a first line that names the columns, such as time [s]; or name the format"
        return None, [run_fault(file, fact, cure, layout_first + 1)]
    lines = text.split("\n", layout_first)
    body, header_line = lines[-1], layout.header + 1
    if not body.strip():
        return None, [run_fault(file, "the file has a header but no rows", _EMPTY)]
    own = _untrailed(_header(lines[layout.header], separator, above[layout.header], width), rows)
    headers = told_apart(own, above[layout.header - 1]) if layout.header and separator != SPACES else own
    units_row = above[layout.units] if layout.units is not None else []
    units, faults = _units(file, headers, units_row, layout.units)
    if faults:
        return None, faults
    decimal = options.get("decimal") or decimal_of(rows, separator)
    if decimal == "." and separator != "," and "," in body and not options.get("decimal"):
        decimal = "," if re.search(_DECIMAL_COMMA.format(re.escape(separator)), body, re.MULTILINE) else "."
    if refused := _thousands(file, lines[-1], separator, numeric, rows, layout_first):
        return None, [refused]
    notes += _said(separator, decimal, layout.header, lines, layout.units)
    notes += [GROUPED] if headers != own else []
    body, comments = _body(body, separator)
    notes += [f"{comments} line{'s' * (comments > 1)} of comment among the rows skipped"] if comments else []
    first_rows = tuple(tuple(cells(line, separator)) for line in body[:20000].split("\n")[:200] if line.strip())
    return Text(
        headers,
        units,
        body,
        "\t" if separator == SPACES else separator,
        decimal,
        header_line,
        layout_first + 1,
        tuple(numeric),
        first_rows,
        tuple(notes),
        tuple(lines[: layout.header]),
    ), []


def _by_header(text: str) -> str:
    """The separator that the header holds most often; a comma where there is none."""
    bare_header = re.sub(r'\[[^\]]*\]|"[^"]*"', "", text.lstrip("\n").partition("\n")[0])
    return max((",", ";", "\t"), key=bare_header.count)


def _above(text: str, separator: str, numeric: list[int], skip: Any) -> tuple[list[list[str]], int | None]:
    """The cells of the lines before the first row of numbers, and the place of that row."""
    above: list[list[str]] = []
    at = 0
    skip = int(skip or 0)
    while numeric and at <= len(text) and len(above) < _MOST_PREAMBLE:
        end = text.find("\n", at)
        line = text[at : end if end >= 0 else len(text)]
        plain = uncommented(line)
        row = cells(plain, separator)
        if len(above) >= skip and not is_comment(line) and is_data(row, numeric):
            return above, len(above)
        above.append(row if len(above) >= skip else [])
        if end < 0:
            break
        at = end + 1
    return above, None


def _without_numbers(file: str, text: str, separator: str, notes: list[str]) -> tuple[Text | None, list[Fault]]:
    """A header above cells of which none is a number: the cells are judged one by one, where they are asked for."""
    blank = len(text) - len(text.lstrip("\n"))
    first, _, body = text[blank:].partition("\n")
    if not body.strip():
        return None, [run_fault(file, "the file has a header but no rows", _EMPTY)]
    separator = _by_header(text)
    headers = tuple(cells(first, separator))
    units = tuple(_own(h) for h in headers)
    decimal = "," if separator != "," and "," in body else "."
    return Text(headers, units, body, separator, decimal, blank + 1, blank + 2, (), (), tuple(notes)), []


def _parted_otherwise(file: str, text: str, separator: str, first: int) -> Fault | None:
    """The fault of a file whose rows are parted in another way above line `first`, counted from 0, as where two exports were
    put into one; None where they are not."""
    above = text.split("\n", first)[:first][:_MOST_PREAMBLE]
    other = separator_of(above)
    if other is None or other == separator or not columns_of_numbers([cells(line, other) for line in above]):
        return None
    fact = f"columns are parted by {named(other)} up to line {first}, and by {named(separator)} from line {first + 1} on"
    return run_fault(file, fact, "write all of the file in one way", first + 1)


def _header(line: str, separator: str, row: list[str], width: int) -> tuple[str, ...]:
    """Header cells; between names that hold single spaces, two or more separate."""
    if separator != SPACES:
        return tuple(row)
    wide = re.split(r"\s{2,}|\t", uncommented(line).strip())
    return tuple(wide) if len(wide) >= width else tuple(row)


def _untrailed(headers: tuple[str, ...], rows: list[list[str]]) -> tuple[str, ...]:
    """Without empty names at the end that stand over nothing."""
    while len(headers) > 1 and not headers[-1] and not any(len(r) >= len(headers) and r[len(headers) - 1] for r in rows):
        headers = headers[:-1]
    return headers


def _own(header: str) -> str | None:
    name, unit = split(header)
    return unit if unit is not None else suffixed(name)[1]


def _units(
    file: str, headers: Sequence[str], row: Sequence[str], place: int | None
) -> tuple[tuple[str | None, ...], list[Fault]]:
    """The unit of each column, by the row of units, else by its header; a fault where the two contradict."""
    units: list[str | None] = []
    for i, header in enumerate(headers):
        below = bare(row[i]) if i < len(row) and row[i] else None
        own = split(header)[1]
        if below is not None and own is not None and below != "-" and not same_unit(own, below):
            fact = f"the header says [{own}], the row of units below it says {below!r}"
            line = None if place is None else place + 1
            return (), [run_fault(file, fact, "correct one of them", line, header)]
        units.append(_own(header) if (below in (None, "-") and own is not None) or below is None else below)
    return tuple(units), []


def _thousands(file: str, body: str, separator: str, numeric: list[int], rows: list[list[str]], first: int) -> Fault | None:
    """A number that carries separators of thousands could be another number elsewhere: it is refused."""
    found = next((row[i] for row in rows for i in numeric if i < len(row) and grouped(row[i])), None)
    if found is None:
        return None
    line = first + 1 + body[: max(body.find(found), 0)].count("\n")
    return run_fault(file, f"{found!r} has a separator of thousands", "export the numbers without one", line)


def _said(separator: str, decimal: str, header: int, lines: Sequence[str], units: int | None) -> list[str]:
    """What is not as in a plain CSV."""
    notes = []
    if separator != ",":
        notes.append(f"separator {named(separator)}")
    if decimal == ",":
        notes.append("decimal comma")
    skipped = sum(bool(line.strip()) for line in lines[:header])
    if skipped:
        notes.append(f"{skipped} line{'s' * (skipped > 1)} before the header skipped")
    if units is not None:
        notes.append("a row of units below the header")
    return notes


def _body(body: str, separator: str) -> tuple[str, int]:
    """The rows with comments made blank, so that lines keep their count, and one sign between cells."""
    comments = 0
    if any(sign in body for sign in ("#", "%", "//")):
        body, comments = re.subn(r"^[ \t]*(#|%|//).*$", "", body, flags=re.MULTILINE)
    if separator == SPACES:
        body = re.sub(r"(?<=\S)[ \t]+(?=\S)", "\t", re.sub(r"^[ \t]+|[ \t]+$", "", body, flags=re.MULTILINE))
    return body, comments
