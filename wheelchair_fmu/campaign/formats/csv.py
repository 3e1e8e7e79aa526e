"""CSV of any European habit."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...tables import read_bytes, read_csv, unreadable
from ._record import TEXT, Format, Read


def _recognises(path: Path, head: bytes) -> bool:
    return False  # any text may be one: it is what remains


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    try:
        return read_csv(file, read_bytes(path), options)
    except OSError as error:
        return None, [unreadable(file, error)]


FORMAT = Format(
    "csv",
    "Text in columns (CSV, TSV)",
    (".csv", ".tsv", ".txt", ".dat", ".asc", ".data"),
    "Text with a header and rows of numbers. Encoding, separator, decimal comma, lines before the header and a row of units "
    "are found by looking, and said; so are ISO 8601 and local stamps, times since 1970 and since midnight.",
    TEXT,
    None,
    _recognises,
    _read,
)
