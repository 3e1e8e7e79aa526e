"""Tyre measurements from a file: CSV, TYDEX 1.3 or a tyre property file, by its ending."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from ..errors import Failure, FileError, unknown
from ..faults import ERROR, Fault
from ..given import what_is
from ..tables import read_bytes
from .records import ISO, SAE, Sweep
from .rig_csv import read_rig
from .rows import Rows, sweeps
from .tir import read_tir
from .tydex import read_tydex

Reader = Callable[[Path, bytes], tuple[Rows | None, list[Fault]]]
READERS: dict[str, Reader] = {".csv": read_rig, ".tdx": read_tydex, ".tir": read_tir}


@dataclass(frozen=True, eq=False)
class Measured:
    """The sweeps of a file, in the paper's axes, and warnings."""

    path: Path
    sweeps: tuple[Sweep, ...]
    warnings: tuple[Fault, ...]


def read(path: str | Path, axes: str = SAE) -> Measured:
    """Read a file; `axes` says of a CSV whether y points right (SAE) or left (ISO). The other formats say it themselves.

    Raises UsageError for an unknown ending and FileError with all faults of the file.
    """
    path = Path(path)
    if axes not in (SAE, ISO):
        raise unknown("axes", axes, (SAE, ISO))
    if kind := what_is(path):
        there = "no such file" if kind == "no file" else f"this is {kind}"
        raise Failure(f"{path}: {there}; give rig data as {', '.join(READERS)}")
    kind = path.with_suffix("").suffix if path.suffix == ".gz" else path.suffix
    if kind.lower() not in READERS:
        raise unknown("reader for tyre data that end in", kind, READERS)
    rows, faults = READERS[kind.lower()](path, read_bytes(path))
    if rows is None or any(f.severity == ERROR for f in faults):
        raise FileError([f for f in faults if f.severity == ERROR])
    if axes == ISO and kind.lower() == ".csv":
        rows = _to_sae(rows)
    found, met = sweeps(rows)
    if not found:
        raise Failure(f"{path}: no row has a slip or a camber angle other than zero; measure some")
    return Measured(path, found, (*faults, *met))


def _to_sae(rows: Rows) -> Rows:
    """Angles keep their sign (tan α = v_y/|v_x| with y left, −v_y/|v_x| with y right); force and torque change it."""
    turned = ("lateral_force", "yaw_torque")
    return replace(rows, columns={name: -v if name in turned else v for name, v in rows.columns.items()})
