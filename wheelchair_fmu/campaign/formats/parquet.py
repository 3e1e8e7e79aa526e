"""Parquet, by pyarrow: units from the fields' metadata; of the columns only those are read that somebody asks for."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ...faults import Fault, once, run_fault
from ...tables import FrameTable, Headed, Rows, numbers
from ...timestamps import is_stamp, named_time
from ...units import split, suffixed
from ._record import DATES, RATE, Format, Read
from ._support import EMPTY, by_library, framed, stated

_PLAIN = ("int", "uint", "float", "double", "halffloat", "decimal", "bool")  # no times, unless they are called that


@dataclass(kw_only=True)
class ParquetTable(Headed):
    """A Parquet file. `times` holds the columns that may be times, read already."""

    times: Mapping[int, Any] = field(repr=False)
    columns: tuple[str, ...] = field(repr=False)  # their names in the file
    opened: Any = field(repr=False)

    def rows(self, indices: Sequence[int]) -> Rows:
        values: dict[int, np.ndarray] = {}
        faults: list[Fault] = []
        for i in indices:
            try:
                column = self.times[i] if i in self.times else self._read(i)
            except Exception as error:  # of a broken page, in whatever class pyarrow puts it
                values[i] = np.full(self.opened.metadata.num_rows, np.nan)
                what = " ".join(str(error).split()) or type(error).__name__
                faults.append(run_fault(self.file, f"pyarrow cannot read the file: {what}", "export it again"))
                continue
            values[i], met = numbers(self.file, self.headers[i], column)
            faults += met
        return Rows(values, None, tuple(once(faults)))

    def _read(self, i: int) -> Any:
        return self.opened.read(columns=[self.columns[i]]).column(0).to_pandas()


def _recognises(path: Path, head: bytes) -> bool:
    return head[:4] == b"PAR1"


def _may_be_time(opened: Any, name: str, kind: str) -> bool:
    """By its name or its type; text, by what stands in its first row."""
    if named_time(suffixed(split(name)[0])[0].rpartition(".")[2]):
        return True
    if "string" not in kind:
        return not kind.startswith(_PLAIN)
    first = next(opened.iter_batches(batch_size=1, columns=[name])).column(0).to_pylist()
    return any(is_stamp(str(cell)) for cell in first)


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    def read(_: Any) -> Read:
        from pyarrow.parquet import ParquetFile

        return _table(ParquetFile(path), file, options)

    return by_library(path, file, "pyarrow", read)


def _table(opened: Any, file: str, options: Mapping[str, Any]) -> Read:
    if not opened.metadata.num_rows:
        return None, [run_fault(file, "the file has no rows", EMPTY)]
    fields = list(opened.schema_arrow)
    names = tuple(f.name for f in fields)
    places = [i for i, f in enumerate(fields) if _may_be_time(opened, f.name, str(f.type))]
    frame = opened.read(columns=[fields[i].name for i in places]).to_pandas(ignore_metadata=True)
    if options.get("rate") is not None and not places:
        frame["rows"] = np.arange(opened.metadata.num_rows, dtype=float)
    headers = tuple("time" if re.fullmatch(r"__index_level_\d+__", f.name) else f.name.strip() for f in fields)
    frame.columns = [headers[i] for i in places] if places else frame.columns
    given = [(f.metadata or {}).get(b"unit") or (f.metadata or {}).get(b"units") or b"" for f in fields]
    units = [stated(h, unit.decode(errors="replace")) for h, unit in zip(headers, given, strict=True)]
    if frame.empty:
        return ParquetTable(file, headers, tuple(units), times={}, columns=names, opened=opened), []
    found, faults = framed(file, frame, options, [units[i] for i in places] if places else [None])
    if not isinstance(found, FrameTable):
        return found, faults
    made = len(found.headers) - len(frame.columns)  # a time that was made from a rate stands first
    columns = {
        (places[k - made] if k >= made else len(fields)): found.frame.iloc[:, k]
        for k in range(len(found.headers))
        if k < made or places
    }
    for k, i in enumerate(places):
        units[i] = found.units[k + made]
    time = None if found.time is None else len(fields) if found.time < made else places[found.time - made]
    more = (("time [s]",), ("s",)) if made else ((), ())
    moments = frozenset(places[i - made] for i in found.moments if i >= made)
    return ParquetTable(
        file,
        headers + more[0],
        (*units, *more[1]),
        found.notes,
        found.started,
        time,
        moments,
        times=columns,
        columns=names,
        opened=opened,
    ), faults


FORMAT = Format(
    "parquet",
    "Parquet",
    (".parquet", ".pq"),
    "Columns with timestamps, durations or numbers. A unit is taken from the header, or from `unit` in the field's metadata.",
    (DATES, RATE),
    None,
    _recognises,
    _read,
)
