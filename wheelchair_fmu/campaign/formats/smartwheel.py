"""SMARTWheel: text without a header, its columns known by their places."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ...dialect import is_number
from ...errors import CampaignError, UsageError
from ...faults import WARNING, Fault, run_fault
from ...tables import FrameTable, as_frame_table, read_bytes, unreadable
from ._record import Format, Option, Read

RATE = 240.0  # Hz
_COLUMNS = {
    0: "counter",
    3: "angle [deg]",
    18: "Fx [N]",
    19: "Fy [N]",
    20: "Fz [N]",
    21: "Mx [N.m]",
    22: "My [N.m]",
    23: "Mz [N.m]",
}
_MOMENT_Z = 23
_FEWEST = 24  # columns


def _recognises(path: Path, head: bytes) -> bool:
    line = head.decode("utf-8-sig", errors="replace").lstrip().partition("\n")[0].strip()
    cells = line.split(";" if line.count(";") > line.count(",") else ",")
    filled = [cell.strip() for cell in cells if cell.strip()]
    return len(filled) >= _FEWEST and all(map(is_number, filled)) and cells[0] == cells[1] and cells[0].strip().isdigit()


def _fields(path: Path, columns: list[int]) -> pd.DataFrame:
    """Fields of a file by their places, counted from 0. Raises CampaignError for a file that is no SMARTWheel recording."""
    try:
        text = read_bytes(path).decode("utf-8-sig", errors="replace").lstrip()
    except OSError as error:
        raise CampaignError([unreadable(path.name, error)]) from error
    separator = ";" if text.partition("\n")[0].count(";") > text.partition("\n")[0].count(",") else ","
    try:
        return pd.read_csv(io.StringIO(text), sep=separator, header=None, usecols=columns, dtype=float)
    except ValueError as error:
        fact = f"not a SMARTWheel file ({' '.join(str(error).split())})"
        cure = "use one with 24 columns of numbers and no header, or read it as csv"
        raise CampaignError([run_fault(path.name, fact, cure)]) from error


def read_smartwheel(path: str | Path, side: str, radius: float) -> pd.DataFrame:
    """A SMARTWheel file: no header, 240 Hz, one wheel.

    `side` is "l" or "r", where the wheel was mounted; `radius` the wheel's, in m. Columns of the result:
    `time [s]` from 0, `M_rl [N.m]` (or rr), the propulsive moment, which is the file's Mz on the left and -Mz
    on the right, and `F_rl [N]` = M / radius. They are two forms of one push: use one.
    Raises UsageError for a bad side or radius, CampaignError for a file that is no SMARTWheel recording.
    """
    path = Path(path)
    if not path.is_file():
        raise UsageError(f"no file {str(path)!r}; check the path")
    if side not in ("l", "r"):
        raise UsageError(f"a SMARTWheel has no side {side!r}; use 'l' or 'r'")
    if not radius > 0:
        raise UsageError(f"radius {radius} m is not positive; give the radius of the wheel in m")
    data = _fields(path, [_MOMENT_Z])
    moment = (1.0 if side == "l" else -1.0) * data[_MOMENT_Z].to_numpy()
    return pd.DataFrame(
        {"time [s]": np.arange(len(data)) / RATE, f"M_r{side} [N.m]": moment, f"F_r{side} [N]": moment / radius}
    )


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    try:
        return _push(path, file, options) if {"side", "radius"} & set(options) else _raw(path, file, options)
    except UsageError as error:
        fact, _, cure = str(error).partition("; ")
        return None, [run_fault(file, fact, f"{cure}, as side and radius of the run")]
    except CampaignError as error:
        return None, [run_fault(file, fault.fact, fault.cure) for fault in error.faults if isinstance(fault, Fault)]


def _push(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    """The push force alone, never force and moment."""
    side, radius = options.get("side"), options.get("radius")
    plain = float(radius) if isinstance(radius, int | float) else 0.0
    frame = read_smartwheel(path, side if isinstance(side, str) else "", plain)
    faults = []
    if frame.iloc[:, 2].mean() < 0:
        fact = f"the wheel brakes on the whole ({frame.iloc[:, 1].mean():.3g} N.m on average)"
        faults.append(run_fault(file, fact, "check on which side it was mounted", severity=WARNING))
    table = as_frame_table(file, frame.drop(columns=frame.columns[1]))
    table.time = 0
    return table, faults


def _raw(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    """The fields that are defined, under the names of their definition."""
    rate = options.get("rate")
    hz = float(rate) if isinstance(rate, int | float) and not isinstance(rate, bool) and rate > 0 else RATE
    frame = _fields(path, list(_COLUMNS)).rename(columns=_COLUMNS)
    counter = frame["counter"].to_numpy()
    rises = len(counter) > 1 and bool((np.diff(counter) > 0).all())
    frame.insert(0, "time [s]", (counter - counter[0] if rises else np.arange(len(frame))) / hz)
    by = "its counter" if rises else "the rows, as its counter does not rise"
    notes = ("SMARTWheel: columns and units by their places", f"time made from {by} at {hz:g} Hz")
    return FrameTable(file, tuple(frame.columns), notes=notes, time=0, frame=frame), []


FORMAT = Format(
    "smartwheel",
    "SMARTWheel",
    (),
    "Text without a header: counter, angle [deg] (4th field), Fx Fy Fz [N] (19th to 21st), Mx My Mz [N.m] (22nd to 24th) at "
    "240 Hz, as the wheel gives them. With side and radius, the push force alone: M = Mz on the left, -Mz on the right.",
    (
        Option("rate", "number", "Hz", "240", "samples per second"),
        Option("side", "text", "", "none: the fields as they are", 'where the wheel was mounted, "l" or "r"'),
        Option("radius", "number", "m", "none: the fields as they are", "radius of the wheel, by which its moment is a force"),
    ),
    None,
    _recognises,
    _read,
)
