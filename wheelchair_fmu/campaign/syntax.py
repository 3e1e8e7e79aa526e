"""What is wrong where a campaign.toml is no TOML, by the line that a parser stopped at: slips that people make."""

from __future__ import annotations

import re

from ..faults import Fault

HEADER = re.compile(r"\s*\[(\[)?\s*([^\[\]]+?)\s*\]")
KEY = re.compile(r"""\s*((?:"[^"]*"|'[^']*'|[\w-]+)(?:\s*\.\s*(?:"[^"]*"|'[^']*'|[\w-]+))*)\s*=""")
_DECIMAL_COMMA = re.compile(r"=\s*([-+]?\d+),(\d+)\s*(#.*)?$")
_PYTHONS = re.compile(r"=\s*(True|False|TRUE|FALSE|yes|no|None|nan\.|null)\s*(#.*)?$")
_BARE = re.compile(r"=\s*([A-Za-zÀ-ÿ][^\"'#=\[\]{}]*?)\s*(#.*)?$")
TWICE = ("cannot declare", "cannot overwrite", "cannot redefine")


def fault_of_syntax(file: str, text: str, message: str) -> Fault:
    """The fault of a text that is no TOML, by the parser's `message`."""
    place = re.search(r"\(at line (\d+), column (\d+)\)", message)
    rows = text.split("\n")
    line = int(place[1]) if place else len(rows)
    what = re.sub(r" \(at .*\)$", "", message)
    what = f"{what[:1].lower()}{what[1:]}"
    if slip := (_slip(rows[line - 1]) or (_twice(rows, line) if what.startswith(TWICE) else None)):
        return Fault(file, line, None, *slip)
    column = f" at character {place[2]}" if place else " at the end of the file"
    return Fault(file, line, None, f"not valid TOML{column}: {what}", "correct this line")


def _slip(row: str) -> tuple[str, str] | None:
    """Fact and cure of a value that is none."""
    if found := _DECIMAL_COMMA.search(row):
        return f"{found[1]},{found[2]} has a decimal comma", f"write {found[1]}.{found[2]}"
    if found := _PYTHONS.search(row):
        meant = {"yes": "true", "no": "false"}.get(found[1], found[1].lower())
        return f"{found[1]} is no value of TOML", f"write {meant}" if meant in ("true", "false") else "leave the line out"
    if (found := _BARE.search(row)) and found[1] not in ("true", "false", "inf", "nan"):
        return f"the text {found[1]} has no quotes", f'write "{found[1]}"'
    return None


def _twice(rows: list[str], line: int) -> tuple[str, str] | None:
    """Fact and cure of a table or a key that is there already; None where no line above has it."""
    table, first = "", dict[tuple[str, str], int]()
    for i, row in enumerate(rows[:line], start=1):
        header, key = HEADER.match(row), KEY.match(row)
        if header:
            table = f"[{header[2]}]"
            first = {k: v for k, v in first.items() if k[0] != table} if header[1] else first
            what = (table, "")
        elif key:
            what = (table, key[1])
        else:
            continue
        if i == line and what in first:
            name = f"{what[1]} of {table}" if what[1] else f"the table {table}"
            cure = "remove one of them" if what[1] else "put both into one"
            return f"{name} is there twice, first in line {first[what]}", cure
        first.setdefault(what, i)
    return None
