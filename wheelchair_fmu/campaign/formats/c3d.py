"""C3D: motion capture and its analogue channels, by ezc3d."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ...tables import FrameTable
from ._defined import read_head
from ._markers import doubled, renamed
from ._record import Format, Option, Read
from ._support import by_library, one

PART = Option(
    "part", "text", "", "points, where there are any", '"points" for the markers, "analogs" for the analogue channels'
)
_AXES = "xyz"


def _recognises(path: Path, head: bytes) -> bool:
    return len(head) >= 512 and head[1] == 0x50 and 2 <= head[0] <= 20


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    def read(library: Any) -> Read:
        if not _recognises(path, read_head(path)):
            return one(file, "not a C3D file: its first bytes are not those of one", "export it again")
        c3d = library.c3d(str(path))
        points, analogs = c3d["data"]["points"], c3d["data"]["analogs"]
        part = options.get("part") or ("points" if points.shape[1] and points.shape[2] else "analogs")
        if part == "points" and points.shape[1] and points.shape[2]:
            return _points(file, c3d["parameters"]["POINT"], points, analogs.shape[1])
        if part == "analogs" and analogs.shape[1] and analogs.shape[2]:
            return _analogs(file, c3d["parameters"]["ANALOG"], analogs[0])
        return one(file, f"the file has no {part}", 'write part = "points" or part = "analogs", or export it again')

    return by_library(path, file, "ezc3d", read)


def _value(parameters: Any, name: str) -> list[Any]:
    return list(parameters[name]["value"]) if name in parameters else []


def _points(file: str, parameters: Any, points: np.ndarray, analogs: int) -> Read:
    """Markers; where a residual is negative, or all is zero, the cameras saw none."""
    unit = str((_value(parameters, "UNITS") or [""])[0]).strip()
    rate = float((_value(parameters, "RATE") or [0.0])[0])
    names = [str(name).strip() for name in _value(parameters, "LABELS")][: points.shape[1]]
    if not unit or not rate > 0 or len(names) < points.shape[1]:
        missing = "unit of its points" if not unit else "rate of its points" if not rate > 0 else "name for each point"
        return one(file, f"the file gives no {missing}", "export it again")
    if twice := list(doubled(file, names)):
        return None, twice
    xyz = np.where((points[:3] == 0).all(axis=0), np.nan, points[:3])
    time = np.arange(points.shape[2]) / rate
    columns = {"time [s]": time}
    columns |= {f"{name}.{axis} [{unit}]": xyz[k, i] for i, name in enumerate(names) for k, axis in enumerate(_AXES)}
    notes = [f"{len(names)} markers at {rate:g} Hz"]
    notes += [f'{analogs} analogue channels are left out; part = "analogs" reads them'] if analogs else []
    frame = pd.DataFrame(columns)
    units = ("s", *[unit] * (len(columns) - 1))
    odd = list(renamed(file, names, time, np.moveaxis(xyz, 0, 2).swapaxes(0, 1), unit))
    return FrameTable(file, tuple(columns), units, tuple(notes), time=0, frame=frame), odd


def _analogs(file: str, parameters: Any, analogs: np.ndarray) -> Read:
    rate = float((_value(parameters, "RATE") or [0.0])[0])
    names = [str(name).strip() for name in _value(parameters, "LABELS")][: len(analogs)]
    given = [str(unit).strip() for unit in _value(parameters, "UNITS")]
    if not rate > 0 or len(names) < len(analogs):
        return one(file, f"the file gives no {'rate' if not rate > 0 else 'name'} of its analogue channels", "export it again")
    units = tuple((given[i] if i < len(given) else "") or None for i in range(len(names)))
    frame = pd.DataFrame({"time [s]": np.arange(analogs.shape[1]) / rate} | dict(zip(names, analogs, strict=True)))
    notes = (f"{len(names)} analogue channels at {rate:g} Hz",)
    return FrameTable(file, tuple(frame.columns), ("s", *units), notes, time=0, frame=frame), []


FORMAT = Format(
    "c3d",
    "C3D (motion capture)",
    (".c3d",),
    "Markers as columns NAME.x, NAME.y, NAME.z in the file's unit, or the analogue channels; a hidden marker is a gap.",
    (PART,),
    "ezc3d",
    _recognises,
    _read,
)
