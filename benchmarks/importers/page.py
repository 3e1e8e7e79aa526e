"""The tables in the documentation, between markers, and which rows stand there."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

DOCS = Path(__file__).parents[2] / "docs"
PAGES = {"fmu": DOCS / "importers.md", "ssp": DOCS / "ssp.md"}


def marks(kind: str) -> tuple[str, str]:
    return f"<!-- begin {kind} importers, by `make importers` -->", f"<!-- end {kind} importers -->"


def shown(kind: str) -> str:
    """The table of a kind as it stands in the documentation. Raises ValueError where the markers are lost."""
    begin, end = marks(kind)
    return PAGES[kind].read_text(encoding="utf-8").split(begin, 1)[1].split(end, 1)[0].strip()


def put(kind: str, table: Iterable[str]) -> None:
    begin, end = marks(kind)
    text = PAGES[kind].read_text(encoding="utf-8")
    before, rest = text.split(begin, 1)
    PAGES[kind].write_text("\n".join([before + begin, *table, end + rest.split(end, 1)[1]]), encoding="utf-8")


def cells(table: str) -> list[tuple[str, ...]]:
    """The table's rows without its head."""
    return [tuple(cell.strip() for cell in line.strip("|").split("|")) for line in table.splitlines()[2:]]
