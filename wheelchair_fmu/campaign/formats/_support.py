"""What readers share: libraries that may be missing, frames whose columns may be times, and grids of cells."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Mapping, Sequence
from datetime import datetime, time
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ...dialect import bare
from ...faults import Fault, run_fault
from ...tables import FrameTable
from ...timestamps import ClockError, Seconds, counted, datetimes, durations, is_stamp, named_time, stamps
from ...units import split, suffixed, unit_of
from ._record import Read

_PACKAGES = {"odf": "odfpy", "scipy.io": "scipy"}  # as pip names them
EMPTY = "export it again, or leave it out"


def by_library(path: Path, file: str, library: str, read: Callable[[Any], Read]) -> Read:
    """What `read` makes of a file by a library, or a sentence that it is missing, or what it said of a broken file."""
    try:
        module = importlib.import_module(library)
    except ImportError:
        package = _PACKAGES.get(library, library)
        fact = f"{path.suffix} files need the library {package}, which is not installed"
        return None, [run_fault(file, fact, f"pip install {package}, or export the file as CSV")]
    try:
        return read(module)
    except ClockError as error:
        return None, [run_fault(file, error.fact, error.cure)]
    except Exception as error:  # these libraries have no common base for errors
        if path.stat().st_size == 0:
            return None, [run_fault(file, "the file is empty", EMPTY)]
        what = " ".join(str(error).split()) or type(error).__name__
        package = _PACKAGES.get(library, library)
        return None, [run_fault(file, f"{package} cannot read the file: {what}", "export it again")]


def framed(
    file: str, frame: pd.DataFrame, options: Mapping[str, Any], units: Sequence[str | None] = (), notes: Sequence[str] = ()
) -> Read:
    """A table of a frame whose column names are headers; its stamps become seconds. Raises ClockError."""
    if frame.empty:
        return None, [run_fault(file, "the file has no rows", EMPTY)]
    headers = tuple(str(name).strip() for name in frame.columns)
    table = FrameTable(file, headers, tuple(units), tuple(notes), frame=frame)
    units_found = list(table.units)
    times = []
    for i, header in enumerate(headers):
        name = suffixed(split(header)[0])[0].rpartition(".")[2]
        found = _seconds(frame.iloc[:, i], str(options.get("dates") or ""))
        clock = None
        if found is None and named_time(name) and pd.api.types.is_numeric_dtype(frame.dtypes.iloc[i]):
            numbers = frame.iloc[:, i].to_numpy(dtype=float, na_value=np.nan)
            clock = counted(header, units_found[i], numbers[:200])
            found = None if clock is None else clock.seconds(numbers)
        if found is not None:
            frame = frame.assign(**{frame.columns[i]: found.values}) if headers.count(header) == 1 else frame
            units_found[i] = "s" if clock is None else clock.unit
            table.moments |= {i} if clock is None or clock.moment else frozenset()
            table.started = table.started or found.started
            table.notes += (f"column {header!r}: {found.note}",) if found.note else ()
        if named_time(name) or found is not None:
            times.append((name != "time", found is None, i))
    table.frame, table.units = frame, tuple(units_found)
    table.time = min(times)[2] if times else None
    return rated(table, options)


def rated(table: FrameTable, options: Mapping[str, Any]) -> Read:
    """With a rate, a first column of time made from the rows."""
    rate = options.get("rate")
    if not isinstance(rate, int | float) or isinstance(rate, bool):
        return table, []
    if table.time is not None or rate <= 0:
        fact = f"the rate {rate:g} Hz is given, but the file has a time of its own" if rate > 0 else f"a rate of {rate:g} Hz"
        return None, [run_fault(table.file, fact, "leave it out" if rate > 0 else "give the samples per second")]
    frame = pd.concat(
        [pd.Series(np.arange(len(table.frame)) / rate, name="time [s]", index=table.frame.index), table.frame], axis=1
    )
    note = f"time made from the rows at {rate:g} Hz"
    return FrameTable(
        table.file, ("time [s]", *table.headers), ("s", *table.units), (*table.notes, note), table.started, time=0, frame=frame
    ), []


def _seconds(column: pd.Series, order: str) -> Seconds | None:
    """Stamps, durations and times of day in s; None for anything else."""
    if pd.api.types.is_datetime64_any_dtype(column):
        return datetimes(column)
    if pd.api.types.is_timedelta64_dtype(column):
        return Seconds(durations(column))
    if column.dtype != object and not pd.api.types.is_string_dtype(column):
        return None
    cells = column.dropna()
    if cells.empty:
        return None
    if all(isinstance(cell, datetime) for cell in cells[:50]):
        return datetimes(pd.to_datetime(column, errors="coerce"))
    if all(isinstance(cell, time) for cell in cells[:50]):
        return stamps([str(cell) for cell in column], order)
    if all(isinstance(cell, str) and is_stamp(cell) for cell in cells[:50]):
        return stamps(column.fillna("").astype(str).tolist(), order)
    return None


def stated(header: str, unit: str | None) -> str | None:
    """The unit of an attribute or a row, else of the header."""
    return bare(unit) if unit and unit.strip() else unit_of(header)


def one(file: str, fact: str, cure: str, line: int | None = None) -> tuple[None, list[Fault]]:
    """No table, and one sentence."""
    return None, [run_fault(file, fact, cure, line)]
