"""NGIMU of x-io: CSV whose headers give their units in parentheses."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ._defined import first_lines, read_defined
from ._record import TEXT, Format, Read


def _recognises(path: Path, head: bytes) -> bool:
    first = first_lines(head).partition("\n")[0]
    return first.lstrip("\ufeff").startswith("Time (s)") and "Gyroscope X (deg/s)" in first and "Accelerometer X (g)" in first


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    return read_defined(path, file, options, {}, "NGIMU: units as its headers give them")


FORMAT = Format(
    "ngimu",
    "NGIMU",
    (),
    "sensors.csv of an NGIMU: Time (s), Gyroscope X (deg/s), Accelerometer X (g) and so on.",
    TEXT,
    None,
    _recognises,
    _read,
)
