"""The beginnings of files, and text whose columns an instrument defines: what a name measures does not stand in the file."""

from __future__ import annotations

import gzip
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...faults import Fault
from ...tables import CsvTable, read_bytes, read_csv, unreadable
from ...units import split

_HEAD = 65536  # bytes
Units = Mapping[str, str]


def read_defined(
    path: Path, file: str, options: Mapping[str, Any], units: Units, note: str
) -> tuple[CsvTable | None, list[Fault]]:
    """The text file with the units of its definition, by name in any case, where it gives none itself."""
    try:
        table, faults = read_csv(file, read_bytes(path), options)
    except OSError as error:
        return None, [unreadable(file, error)]
    if table is not None:
        table.units = tuple(
            own if split(header)[1] is not None or i in table.stamped else units.get(header.casefold(), own)
            for i, (header, own) in enumerate(zip(table.headers, table.units, strict=True))
        )
        table.notes += (note,)
    return table, faults


def read_head(path: Path) -> bytes:
    """The first bytes, unpacked where the name ends in .gz. Raises OSError."""
    if path.suffix.lower() != ".gz":
        with path.open("rb") as file:
            return file.read(_HEAD)
    try:
        with gzip.open(path) as packed:
            return packed.read(_HEAD)
    except (EOFError, zlib.error) as error:
        raise OSError(f"broken gzip: {error}") from error


def first_lines(head: bytes) -> str:
    """The beginning of a text file, to look for what its maker writes."""
    return head[:8000].decode("utf-8", errors="replace")
