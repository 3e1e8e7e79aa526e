"""How a text file writes a table, found by looking: its encoding, separator and decimal sign, and where its rows begin."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from .timestamps import is_stamp
from .units import UnitError, coherent, is_unit, split

GAPS = ("", "NaN", "nan", "NAN")
SEPARATORS = ("\t", ";", ",", "|")
GROUPED = "names that stand twice are told apart by the row above the header"  # a note
SPACES = " "
_NAMES = {"\t": "tab", SPACES: "spaces"}
_NUMBER = re.compile(r"[-+]?(\d+[.,]?\d*|[.,]\d+)([eE][-+]?\d+)?|[-+]?inf(inity)?", re.IGNORECASE)
_GROUPED = re.compile(r"[-+]?\d{1,3}(?:([.,' \u00a0\u202f])\d{3})+(?:(?!\1)[.,]\d+)?")
_COMMENT = re.compile(r"\s*(#|%|//)+")
_SAMPLE = 40  # lines looked at in the middle and at the end
_FEW_NULS = 0.01  # share of bytes; a text file with more is none


@dataclass(frozen=True)
class Layout:
    """Where a table stands in rows of cells: places count from 0; `units` is None where there is no row of units."""

    header: int | None
    units: int | None
    first: int


def decode(raw: bytes, encoding: str = "") -> tuple[str, str]:
    """The text of a file and the encoding it was read in. Raises UnicodeDecodeError or LookupError for a wrong `encoding`."""
    if encoding:
        return raw.decode(encoding).removeprefix("\ufeff"), encoding
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return raw.decode("utf-16", errors="replace"), "UTF-16"
    head = raw[:2000]
    for at, name in ((1, "utf-16-le"), (0, "utf-16-be")):
        if len(head) > 8 and head[at::2].count(0) > 0.8 * len(head[at::2]) and head[1 - at :: 2].count(0) < 0.1 * len(head):
            return raw.decode(name, errors="replace"), "UTF-16"
    try:
        return raw.decode("utf-8-sig"), ""
    except UnicodeDecodeError:
        try:
            return raw.decode("cp1252"), "cp1252"
        except UnicodeDecodeError:
            return raw.decode("latin-1"), "latin-1"


def is_binary(raw: bytes) -> bool:
    """Bytes that no text holds, but for a few that a broken transfer may leave."""
    head = raw[:20000]
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff") or decode(head)[1] == "UTF-16":
        return False
    odd = sum(head.count(byte) for byte in range(32) if byte not in b"\t\n\r\f\x1a")
    return odd > _FEW_NULS * len(head) + 2


def named(separator: str) -> str:
    """As a sentence names it."""
    return _NAMES.get(separator, repr(separator))


def is_number(cell: str) -> bool:
    return bool(_NUMBER.fullmatch(cell))


def grouped(cell: str) -> bool:
    """Does a number carry separators of thousands, as 1.234,5 and 1,234.5 and 12 345 do?"""
    return bool(_GROUPED.fullmatch(cell)) and (not is_number(cell) or len(re.findall(r"[., ']", cell)) > 1)


def cells(line: str, separator: str) -> list[str]:
    if separator == SPACES:
        return line.split()
    if '"' in line:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=separator), [])]
    return [cell.strip() for cell in line.split(separator)]


def sample(text: str) -> list[str]:
    """Lines from the middle and the end of the text, where the rows are; all lines of a short text."""
    if len(text) < 20000:
        return [line for line in text.split("\n") if line.strip()]
    middle = text[len(text) // 2 : len(text) // 2 + 60000].split("\n")[1 : _SAMPLE + 1]
    end = text[-60000:].split("\n")[1:-1][-_SAMPLE:]
    return [line for line in middle + end if line.strip() and not _COMMENT.match(line)]


def separator_of(lines: Sequence[str]) -> str | None:
    """The separator that makes the most numbers of these lines; None where none makes any."""
    best: tuple[float, float, int] = (0.0, 0.0, 0)
    chosen = None
    for separator in (*SEPARATORS, SPACES):
        rows = [cells(line, separator) for line in lines]
        rows = [row for row in rows if any(map(_valued, row))]
        if not rows:
            continue
        width = _width(rows)
        if width == 1 and separator != ",":
            continue
        filled = [cell for row in rows if _trimmed(row) == width for cell in row if cell]
        numbers = sum(map(_valued, filled)) / max(len(filled), 1)
        regular = sum(_trimmed(row) == width for row in rows) / len(rows)
        score = (round(numbers, 1) * round(regular, 1), numbers, 0 if separator == SPACES else width)
        if score > best:
            best, chosen = score, separator
    return chosen


def _width(rows: Sequence[Sequence[str]]) -> int:
    return Counter(map(_trimmed, rows)).most_common(1)[0][0]


def _trimmed(row: Sequence[str]) -> int:
    """How many cells a row has, without an empty one after a separator at its end."""
    return len(row) - (len(row) > 1 and not row[-1])


def _valued(cell: str) -> bool:
    return is_number(cell) or is_stamp(cell) or grouped(cell)


def decimal_of(rows: Sequence[Sequence[str]], separator: str) -> str:
    """The decimal sign of these cells; a point where none tells."""
    numbers = [cell for row in rows for cell in row if is_number(cell) or (is_stamp(cell) and "," in cell)]
    commas = sum("," in cell for cell in numbers)
    return "," if commas > sum("." in cell for cell in numbers) else "."


def columns_of_numbers(rows: Sequence[Sequence[str]]) -> list[int]:
    """The places whose cells are numbers or stamps in most of these rows."""
    width = _width([row for row in rows if any(map(_valued, row))] or rows) if rows else 0
    found = []
    for i in range(width):
        filled = [row[i] for row in rows if len(row) > i and row[i] and row[i] not in GAPS]
        if filled and 2 * sum(map(_valued, filled)) > len(filled):
            found.append(i)
    return found


def is_data(row: Sequence[str], numeric: Sequence[int]) -> bool:
    """Is this a row of the table, seen by the columns that hold numbers?"""
    here = [row[i] for i in numeric if i < len(row) and row[i]]
    valued = [_valued(cell) or cell in GAPS for cell in here]
    if not any(valued) or len(row) <= max(numeric) // 2:
        return False
    begins = _valued(row[numeric[0]]) or not row[numeric[0]] if numeric[0] < len(row) else False
    share = sum(valued) / len(valued)
    return (share == 1.0 and begins) or share >= 0.75 or (begins and share >= 0.5)


def find(rows: Sequence[Sequence[str]], first: int, width: int) -> Layout:
    """Which of the rows before the `first` one with numbers, whose table is `width` wide, are the header and the units."""
    above = [i for i in range(first) if any(cell.strip("-=_*") for cell in rows[i])]
    while above and _filled(rows[above[-1]]) <= width // 2 and any(_filled(rows[i]) > width // 2 for i in above):
        above.pop()  # a remark between the header and the rows
    if not above or _filled(rows[above[-1]]) <= width // 2:
        return Layout(None, None, first)
    last = above[-1]
    if len(above) > 1 and is_unit_row(rows[last]) and _filled(rows[above[-2]]) >= max(_filled(rows[last]), width // 2 + 1):
        return Layout(above[-2], last, first)
    return Layout(last, None, first)


def told_apart(headers: Sequence[str], groups: Sequence[str]) -> tuple[str, ...]:
    """Headers of which some stand there twice, each of these with the group that the row above gives it, as in `Left.F [N]`: a
    group reaches to where the next one begins. As they are, where that does not tell them apart."""
    group, found = "", []
    for i, header in enumerate(headers):
        group = (groups[i] if i < len(groups) else "") or group
        found.append(f"{group}.{header}" if header and group and headers.count(header) > 1 else header)
    named = [header for header in found if header]
    return tuple(found if len(set(named)) == len(named) else headers)


def _filled(row: Sequence[str]) -> int:
    return sum(bool(cell) for cell in row)


def bare(unit: str) -> str:
    """'[N.m]' and '(N.m)' are 'N.m'."""
    found = re.fullmatch(r"\s*[\[(](.*)[\])]\s*", unit)
    return (found[1] if found else unit).strip()


def is_unit_row(row: Sequence[str]) -> bool:
    """Do most of its cells say a unit, and does none of them say a name with one?"""
    filled = [cell for cell in row if cell]
    if not filled or any(split(cell)[1] is not None and split(cell)[0] for cell in filled):
        return False
    return 2 * sum(is_unit(bare(cell)) or cell == "-" or bare(cell) != cell for cell in filled) > len(filled)


def same_unit(first: str, second: str) -> bool:
    """Two writings of one unit."""
    if first.replace(" ", "") == second.replace(" ", ""):
        return True
    try:
        return coherent(first) == coherent(second)
    except UnitError:
        return False


def uncommented(line: str) -> str:
    """A line of a header without the sign of a comment before it."""
    found = _COMMENT.match(line)
    return line[found.end() :] if found else line


def is_comment(line: str) -> bool:
    return bool(_COMMENT.match(line))
