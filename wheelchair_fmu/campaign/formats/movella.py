"""Movella DOT exports: CSV, units by definition; its gyroscope counts degrees, not radians as Xsens' larger sensors do."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ...timestamps import Clock, Seconds, count_over
from ._defined import first_lines, read_defined
from ._record import TEXT, Format, Read

_XYZ = ("x", "y", "z")
_UNITS = {
    **{f"{name}_{axis}": "m/s2" for name in ("acc", "freeacc") for axis in _XYZ},
    **{f"{name}_{axis}": "deg/s" for name in ("gyr",) for axis in _XYZ},
    **{f"euler_{axis}": "deg" for axis in _XYZ},
    **{f"dv[{i}]": "m/s" for i in (1, 2, 3)},
    "packetcounter": "counts",
}
_MICROSECOND, _ROUND = 1e-6, 2.0**32  # of SampleTimeFine


def _recognises(path: Path, head: bytes) -> bool:
    text = first_lines(head)
    header = next((line for line in text.split("\n") if line.startswith("PacketCounter")), "")
    return "SampleTimeFine" in header and not text.lstrip("\ufeff").startswith("//")


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    table, faults = read_defined(path, file, options, _UNITS, "Movella DOT: units by their definition, m/s2, deg/s and deg")
    if table is not None and table.rate is None and "SampleTimeFine" in table.headers:
        i = table.headers.index("SampleTimeFine")
        table.clocks[i] = Clock(lambda ticks: Seconds(count_over(np.asarray(ticks), _ROUND) * _MICROSECOND))
        table.units = (*table.units[:i], "s", *table.units[i + 1 :])
        table.time = i
        table.notes += ("time from SampleTimeFine, in µs",)
    return table, faults


FORMAT = Format(
    "movella",
    "Movella DOT",
    (),
    "CSV with PacketCounter, SampleTimeFine [µs], Acc_X [m/s2], Gyr_X [deg/s], Euler_X [deg] and so on.",
    TEXT,
    None,
    _recognises,
    _read,
)
