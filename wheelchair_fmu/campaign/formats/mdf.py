"""MDF 3 and 4 of measuring instruments in cars, by asammdf."""

from __future__ import annotations

from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from typing import Any

from ...tables import FrameTable
from ._record import Format, Read
from ._support import EMPTY, by_library, one, stated


def _recognises(path: Path, head: bytes) -> bool:
    return head[:8] in (b"MDF     ", b"UnFinMF ")


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    def read(library: Any) -> Read:
        with library.MDF(str(path)) as mdf:
            frame = mdf.to_dataframe(use_interpolation=False)  # a channel of another rate has gaps, not made-up readings
            units = [_unit(mdf, str(name)) for name in frame.columns]
            started = getattr(mdf, "start_time", None)
        if frame.empty:
            return one(file, "the file has no rows", EMPTY)
        names = tuple(str(name).strip() for name in frame.columns)
        frame.insert(0, "time [s]", frame.index.to_numpy(dtype=float))
        known = [stated(name, unit) for name, unit in zip(names, units, strict=True)]
        started = started if isinstance(started, datetime) else None
        return FrameTable(file, ("time [s]", *names), ("s", *known), started=started, time=0, frame=frame), []

    return by_library(path, file, "asammdf", read)


def _unit(mdf: Any, name: str) -> str:
    """The unit of a channel; of several that have one name, the first one's."""
    places = getattr(mdf, "channels_db", {}).get(name, ())
    if len(places) > 1:
        group, index = places[0]
        return str(mdf.get(group=group, index=index).unit or "")
    return str(mdf.get(name).unit or "")


FORMAT = Format(
    "mdf",
    "MDF 3 and 4",
    (".mf4", ".mdf"),
    "All channels on one axis of time, each with the unit that the file gives it, and with gaps where it was not sampled.",
    (),
    "asammdf",
    _recognises,
    _read,
)
