"""Recorded pushes for the pusher to replay, from a CSV with the columns of a campaign: time, F_rl, F_rr, in any unit."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...errors import Failure, FileError, UsageError
from ...faults import run_fault, suggestion
from ...fmu.companions import Recording
from ...given import what_is
from ...tables import CsvTable, read_bytes, read_csv
from ...units import UnitError, factor, split

COLUMNS = {"time": "s", "F_rl": "N", "F_rr": "N"}


def read_recording(path: Path) -> Recording:
    """The recording in a CSV file. Raises Failure, or FileError with every fault by line and column."""
    if kind := what_is(path):
        there = "no such file" if kind == "no file" else f"this is {kind}"
        raise Failure(f"{path}: {there}; give a CSV with the columns {', '.join(COLUMNS)}")
    table, faults = read_csv(path.name, read_bytes(path))
    if table is None or faults:
        raise FileError(faults)
    names = [split(header)[0].removeprefix("push.") for header in table.headers]
    if lost := [column for column in COLUMNS if column not in names]:
        raise FileError([run_fault(table.file, f"there is no column {c}", suggestion(c, names)) for c in lost])
    columns = {c: _column(table, names.index(c), unit) for c, unit in COLUMNS.items()}
    _refuse_gaps(table, columns, [names.index(c) for c in COLUMNS])
    try:
        return Recording(columns["time"], columns["F_rl"], columns["F_rr"])
    except UsageError as error:
        raise Failure(f"{path}: {error}") from None


def _column(table: CsvTable, index: int, si: str) -> np.ndarray:
    rows = table.rows([index])
    if rows.faults:
        raise FileError(rows.faults)
    unit = split(table.headers[index])[1]
    try:
        return rows.values[index] * (factor(unit, si) if unit else 1.0)
    except UnitError as error:
        raise FileError([run_fault(table.file, error.fact, error.cure, 1, table.headers[index])]) from None


def _refuse_gaps(table: CsvTable, columns: dict[str, np.ndarray], indices: list[int]) -> None:
    faults = []
    for (_, column), index in zip(columns.items(), indices, strict=True):
        for row in np.flatnonzero(~np.isfinite(column))[:1]:
            faults.append(
                run_fault(
                    table.file,
                    "a gap, which hands cannot replay",
                    "fill it, or cut the file there",
                    table.rows([index]).line(int(row)),
                    table.headers[index],
                )
            )
    if faults:
        raise FileError(faults)
