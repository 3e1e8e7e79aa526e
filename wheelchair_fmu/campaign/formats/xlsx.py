"""Excel workbooks (.xlsx), by openpyxl."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lxml import etree

from ._grid import OPTIONS, read_sheets
from ._record import Format, Read
from ._support import by_library

_MAIN = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
_LINK = "{http://schemas.openxmlformats.org/officeDocument/2006/relationships}id"


def _recognises(path: Path, head: bytes) -> bool:
    if head[:4] != b"PK\x03\x04" or not zipfile.is_zipfile(path):
        return False
    with zipfile.ZipFile(path) as archive:
        return "xl/workbook.xml" in archive.namelist()


def _merged(path: Path, sheet: str) -> list[tuple[int, int]]:
    """First and last row, from 0, of each range of merged cells."""
    with zipfile.ZipFile(path) as archive:
        book = etree.fromstring(archive.read("xl/workbook.xml"))
        links = etree.fromstring(archive.read("xl/_rels/workbook.xml.rels"))
        link = next((s.get(_LINK) for s in book.iter(f"{_MAIN}sheet") if s.get("name") == sheet), None)
        target = next((r.get("Target") for r in links if r.get("Id") == link), "")
        part = target.lstrip("/") if target.startswith("/") else f"xl/{target}"
        text = archive.read(part).decode("utf-8", errors="replace") if part in archive.namelist() else ""
    ranges = re.findall(r'<(?:\w+:)?mergeCell\b[^>]*\bref="[A-Z]+(\d+):[A-Z]+(\d+)"', text)
    return [(int(first) - 1, int(last) - 1) for first, last in ranges]


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    return by_library(path, file, "openpyxl", lambda _: read_sheets(path, file, options, "openpyxl", _merged))


FORMAT = Format(
    "xlsx",
    "Excel workbook",
    (".xlsx", ".xlsm"),
    "One sheet: a header, perhaps a row of units, rows of numbers or dates.",
    OPTIONS,
    "openpyxl",
    _recognises,
    _read,
)
