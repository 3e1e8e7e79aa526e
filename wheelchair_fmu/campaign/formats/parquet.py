"""Parquet, by pyarrow: units from the fields' metadata."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pandas as pd

from ._record import DATES, RATE, Format, Read
from ._support import by_library, framed, stated


def _recognises(path: Path, head: bytes) -> bool:
    return head[:4] == b"PAR1"


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    def read(_: Any) -> Read:
        import pyarrow.parquet as pq

        frame = pd.read_parquet(path)
        if not isinstance(frame.index, pd.RangeIndex):
            frame = frame.reset_index(names=frame.index.name or "time")
        fields = {field.name: field.metadata or {} for field in pq.read_schema(path)}
        given = [fields.get(str(name), {}) for name in frame.columns]
        units = [(meta.get(b"unit") or meta.get(b"units") or b"").decode(errors="replace") for meta in given]
        return framed(file, frame, options, [stated(str(h), u) for h, u in zip(frame.columns, units, strict=True)])

    return by_library(path, file, "pyarrow", read)


FORMAT = Format(
    "parquet", "Parquet", (".parquet", ".pq"),
    "Columns with timestamps, durations or numbers. A unit is taken from the header, or from `unit` in the field's metadata.",
    (DATES, RATE), None, _recognises, _read,
)  # fmt: skip
