"""TRC: markers of motion capture as text."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ...dialect import decode, is_number
from ...faults import run_fault
from ...tables import read_bytes, unreadable
from ._markers import doubled, table_of
from ._record import Format, Read
from ._support import EMPTY, one

_BEGINS = "PathFileType"


def _recognises(path: Path, head: bytes) -> bool:
    return head.lstrip(b"\xef\xbb\xbf").startswith(_BEGINS.encode())


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    try:
        text = decode(read_bytes(path))[0]
    except OSError as error:
        return None, [unreadable(file, error)]
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    if not text.strip():
        return one(file, "the file is empty", EMPTY)
    if len(lines) < 6 or not lines[0].startswith(_BEGINS):
        return one(file, "not a TRC file: it needs five lines of header, the first with PathFileType", "export it again", 1)
    again = next((i for i, line in enumerate(lines[1:], 2) if line.startswith((_BEGINS, "Frame#")) and i != 4), None)
    if again is not None:
        what = "a second header begins here: a marker was renamed or added half-way"
        return one(file, what, "export each part as a file of its own", again)
    about = dict(zip(_cells(lines[1]), _cells(lines[2]), strict=False))
    unit = about.get("Units", "")
    names = [name for name in _cells(lines[3])[2:] if name]
    if not unit or not names:
        missing = "units" if not unit else "markers"
        return one(file, f"the header names no {missing}", "export it again", 3 if not unit else 4)
    if twice := list(doubled(file, names, 4)):
        return None, twice
    return _table(file, lines, names, unit, about)


def _cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.split("\t")]


def _table(file: str, lines: list[str], names: list[str], unit: str, about: Mapping[str, str]) -> Read:
    width = 2 + 3 * len(names)
    rows, places = [], []
    for place, line in enumerate(lines[5:], 6):
        if not line.strip():
            continue
        cells = _cells(line)
        if len(cells) > width and any(cells[width:]):
            return one(file, f"{len(cells)} cells, but {len(names)} markers need {width}", "export it again", place)
        odd = next((cell for cell in cells[:width] if cell and cell != "NaN" and not is_number(cell)), None)
        if odd is not None:
            fact = f"{odd!r} is not a number: a marker may have been renamed half-way"
            return one(file, fact, "export each part as a file of its own", place)
        rows.append([float(cell.replace(",", ".")) if cell else np.nan for cell in (cells + [""] * width)[:width]])
        places.append(place)
    if not rows:
        return one(file, "the file has a header but no rows", EMPTY)
    values = np.array(rows)
    table, faults = table_of(file, names, unit, about.get("DataRate", ""), values[:, 1], values[:, 2:])
    if np.isnan(values[:, 1]).any():
        first = places[int(np.flatnonzero(np.isnan(values[:, 1]))[0])]
        faults.append(run_fault(file, "the time is empty", "export it again", first))
    return table, faults


FORMAT = Format(
    "trc",
    "TRC (motion capture)",
    (".trc",),
    "Markers as columns NAME.x, NAME.y, NAME.z in the unit of the file's header; a hidden marker is a gap.",
    (),
    None,
    _recognises,
    _read,
)
