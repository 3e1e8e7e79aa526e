"""Formats other than CSV, each by the library that knows it, loaded only when a campaign uses it."""

from __future__ import annotations

import importlib
import io
import re
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ..errors import CampaignError, UsageError
from ..faults import WARNING, Fault, once, run_fault
from ..tables import Rows, Table, as_frame_table, numbers, read_bytes, read_csv, unreadable
from .devices import Part
from .document import number

FORMATS = ("csv", "parquet", "mdf", "smartwheel")
OPTIONS = ("format", "side")  # what [[recording]] may say of how a file is read
_BY_SUFFIX = {".parquet": "parquet", ".mf4": "mdf", ".mdf": "mdf", ".dat": "mdf"}
SMARTWHEEL_RATE = 240.0  # Hz
_FORCE_X, _MOMENT_Z = 18, 23  # columns counted from 0: 18-20 are Fx Fy Fz, 21-23 Mx My Mz


def open_table(part: Part, path: Path) -> tuple[Table | None, list[Fault]]:
    """The recording of one run, in whatever format it is. The file exists."""
    kind = str(part.device.options.get("format") or "") or _BY_SUFFIX.get(path.suffix.lower(), "csv")
    if kind == "smartwheel":
        return _open_smartwheel(part, path)
    if kind == "parquet":
        return _by_library(part.file, path, "pyarrow.parquet",
                           lambda library: ParquetTable.of(part.file, library.ParquetFile(path)))  # fmt: skip
    if kind == "mdf":
        return _by_library(part.file, path, "asammdf", lambda library: as_frame_table(part.file, _mdf(library, path)))
    try:
        return read_csv(part.file, read_bytes(path))
    except OSError as error:
        return None, [unreadable(part.file, error)]


def _by_library(file: str, path: Path, name: str, read: Any) -> tuple[Table | None, list[Fault]]:
    """Reads by an optional library. Whatever it raises on a broken file becomes a fault that quotes it."""
    try:
        library = importlib.import_module(name)
    except ImportError:
        package = name.partition(".")[0]
        fact = f"{path.suffix} files need the library {package}, which is not installed"
        return None, [run_fault(file, fact, f"pip install {package}, or export the file as CSV")]
    try:
        table = read(library)
    except Exception as error:  # these libraries have no common base for errors
        return None, [_broken(file, name, error)]
    if not table.length:
        return None, [run_fault(file, "the file has no rows", "export it again, or leave it out")]
    return table, []


def _broken(file: str, library: str, error: Exception) -> Fault:
    what = " ".join(str(error).split()) or type(error).__name__
    return run_fault(file, f"{library.partition('.')[0]} cannot read the file: {what}", "export it again")


@dataclass
class ParquetTable:
    """A Parquet file, of which only those columns are read that are asked for."""

    file: str
    headers: tuple[str, ...]
    columns: tuple[str, ...]  # their names as the file has them
    length: int
    opened: Any = field(repr=False)

    @classmethod
    def of(cls, file: str, opened: Any) -> ParquetTable:
        columns = tuple(name for name in opened.schema_arrow.names if not re.fullmatch(r"__index_level_\d+__", name))
        return cls(file, tuple(name.strip() for name in columns), columns, opened.metadata.num_rows, opened)

    def rows(self, indices: Sequence[int]) -> Rows:
        values: dict[int, np.ndarray] = {}
        faults: list[Fault] = []
        for i in indices:
            try:
                column = self.opened.read(columns=[self.columns[i]]).column(0).to_pandas()
            except Exception as error:  # as above, where a page of the file is broken
                values[i] = np.full(self.length, np.nan)
                faults.append(_broken(self.file, "pyarrow", error))
                continue
            values[i], met = numbers(self.file, self.headers[i], column)
            faults += met
        return Rows(values, None, tuple(once(faults)))


def _mdf(library: Any, path: Path) -> pd.DataFrame:
    """All channels on one time axis; the unit of each goes into its header."""
    with library.MDF(str(path)) as mdf:
        frame = mdf.to_dataframe()
        units = {name: mdf.get(name).unit for name in frame.columns}
    frame = frame.rename(columns={name: f"{name} [{unit}]" for name, unit in units.items() if unit})
    frame.insert(0, "time [s]", frame.index.to_numpy(dtype=float))
    return frame


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
    try:
        text = read_bytes(path).decode("utf-8-sig", errors="replace").lstrip()
    except OSError as error:
        raise CampaignError([unreadable(path.name, error)]) from error
    separator = ";" if text.partition("\n")[0].count(";") > text.partition("\n")[0].count(",") else ","
    try:
        data = pd.read_csv(io.StringIO(text), sep=separator, header=None, usecols=[_FORCE_X, _MOMENT_Z], dtype=float)
    except ValueError as error:
        fact = f"not a SMARTWheel file ({' '.join(str(error).split())})"
        cure = "use one with 24 columns of numbers and no header, or read it as csv"
        raise CampaignError([run_fault(path.name, fact, cure)]) from error
    moment = (1.0 if side == "l" else -1.0) * data[_MOMENT_Z].to_numpy()
    return pd.DataFrame({
        "time [s]": np.arange(len(data)) / SMARTWHEEL_RATE,
        f"M_r{side} [N.m]": moment,
        f"F_r{side} [N]": moment / radius,
    })  # fmt: skip


def _open_smartwheel(part: Part, path: Path) -> tuple[Table | None, list[Fault]]:
    try:
        options = part.device.options
        frame = read_smartwheel(path, str(options.get("side", "")), number(options.get("radius")) or 0.0)
    except UsageError as error:
        fact, _, cure = str(error).partition("; ")
        return None, [run_fault(part.file, fact, f"{cure}, as side and radius of the run")]
    except CampaignError as error:
        return None, [
            run_fault(part.file, fault.fact, fault.cure) for fault in error.faults if isinstance(fault, Fault)
        ]
    faults = []
    if frame.iloc[:, 2].mean() < 0:
        fact = f"the wheel brakes on the whole ({frame.iloc[:, 1].mean():.3g} N.m on average)"
        faults.append(run_fault(part.file, fact, "check on which side it was mounted", severity=WARNING))
    return as_frame_table(part.file, frame.drop(columns=frame.columns[1])), faults  # force only, never both
