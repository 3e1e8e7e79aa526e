"""OpenDocument spreadsheets (.ods), by odfpy."""

from __future__ import annotations

import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lxml import etree

from ._grid import OPTIONS, read_sheets
from ._record import Format, Read
from ._support import by_library

_TABLE = "{urn:oasis:names:tc:opendocument:xmlns:table:1.0}"
_KIND = b"application/vnd.oasis.opendocument.spreadsheet"


def _recognises(path: Path, head: bytes) -> bool:
    return head[:4] == b"PK\x03\x04" and _KIND in head[:200]


def _merged(path: Path, sheet: str) -> list[tuple[int, int]]:
    """First and last row, from 0, of each range of merged cells."""
    with zipfile.ZipFile(path) as archive:
        content = etree.fromstring(archive.read("content.xml"), etree.XMLParser(huge_tree=True, resolve_entities=False))
    found, row = [], 0
    for table in content.iter(f"{_TABLE}table"):
        for line in table.iter(f"{_TABLE}table-row") if table.get(f"{_TABLE}name") == sheet else ():
            for cell in line:
                wide, high = (int(cell.get(f"{_TABLE}number-{name}-spanned") or 1) for name in ("columns", "rows"))
                if wide > 1 or high > 1:
                    found.append((row, row + high - 1))
            row += int(line.get(f"{_TABLE}number-rows-repeated") or 1)
    return found


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    return by_library(path, file, "odf", lambda _: read_sheets(path, file, options, "odf", _merged))


FORMAT = Format(
    "ods",
    "OpenDocument spreadsheet",
    (".ods",),
    "One sheet: a header, perhaps a row of units, rows of numbers or dates.",
    OPTIONS,
    "odfpy",
    _recognises,
    _read,
)
