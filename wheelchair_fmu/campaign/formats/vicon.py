"""Vicon Nexus' CSV of trajectories: a rate, names of markers above their axes, units below, and frames in place of a time."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ...dialect import decode, is_number
from ...faults import run_fault
from ...tables import read_bytes, unreadable
from ._defined import first_lines
from ._markers import doubled, table_of
from ._record import Format, Read
from ._support import EMPTY, one

_BEGINS = "Trajectories"
_ABOVE = 5  # lines before the first frame: what this is, the rate, markers, axes, units
_FRAME = 2  # columns before the first marker's: frame and sub frame


def _recognises(path: Path, head: bytes) -> bool:
    lines = [_cells(line)[0] for line in first_lines(head).lstrip("\ufeff").split("\n")[:2]]
    return len(lines) == 2 and lines[0] == _BEGINS and is_number(lines[1])


def _cells(line: str) -> list[str]:
    separator = ";" if line.count(";") > line.count(",") else ","
    return [cell.strip().strip('"') for cell in line.split(separator)]


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    try:
        text = decode(read_bytes(path))[0]
    except OSError as error:
        return None, [unreadable(file, error)]
    lines = text.lstrip("\ufeff").replace("\r\n", "\n").split("\n")
    if len(lines) <= _ABOVE or not is_number(_cells(lines[1])[0]):
        fact = f"not a file of trajectories: it needs {_ABOVE} lines above the first frame, the second with the rate"
        return one(file, fact, "export it again", 1)
    rate = float(_cells(lines[1])[0].replace(",", "."))
    names, units = [name for name in _cells(lines[2]) if name], _cells(lines[4])[_FRAME:]
    unit = next((u for u in units if u), "")
    if not names or not unit or rate <= 0:
        missing, line = ("units", 5) if names and rate > 0 else ("rate", 2) if names else ("markers", 3)
        return one(file, f"the header names no {missing}", "export it again", line)
    if twice := list(doubled(file, names, 3)):
        return None, twice
    return _table(file, lines, names, unit, rate)


def _table(file: str, lines: list[str], names: list[str], unit: str, rate: float) -> Read:
    width, rows = _FRAME + 3 * len(names), []
    for place, line in enumerate(lines[_ABOVE:], _ABOVE + 1):
        if not line.strip(" ,;"):
            break  # what follows is of another device
        cells = (_cells(line) + [""] * width)[:width]
        odd = next((cell for cell in cells if cell and not is_number(cell)), None)
        if odd is not None or not cells[0]:
            fact = f"{odd!r} is not a number" if odd is not None else "the frame is empty"
            return None, [run_fault(file, fact, "export it again, or leave the cell of a hidden marker empty", place)]
        rows.append([float(cell.replace(",", ".")) if cell else np.nan for cell in cells])
    if not rows:
        return one(file, "the file has a header but no frames", EMPTY)
    values = np.array(rows)
    return table_of(file, names, unit, f"{rate:g}", (values[:, 0] - 1) / rate, values[:, _FRAME:])


FORMAT = Format(
    "vicon",
    "Vicon Nexus (trajectories)",
    (),
    "Markers as columns NAME.x, NAME.y, NAME.z, with time from the frames and the rate in the file's second line; a hidden "
    "marker is a gap.",
    (),
    None,
    _recognises,
    _read,
)
