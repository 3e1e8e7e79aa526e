"""Xsens MTw and MTi exports: text below lines that begin with //, units by definition."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ._defined import first_lines, read_defined, read_head
from ._record import TEXT, Format, Read

_XYZ = ("x", "y", "z")
_UNITS = {
    **{f"{name}_{axis}": "m/s2" for name in ("acc", "freeacc") for axis in (*_XYZ, "e", "n", "u")},
    **{f"gyr_{axis}": "rad/s" for axis in _XYZ},
    **{f"velinc_{axis}": "m/s" for axis in _XYZ},
    **dict.fromkeys(("roll", "pitch", "yaw"), "deg"),
    "pressure": "Pa",
    "packetcounter": "counts",
}
_RATE = re.compile(r"^//\s*Update\s*Rate\s*:\s*([\d.]+)\s*Hz", re.MULTILINE | re.IGNORECASE)


def _recognises(path: Path, head: bytes) -> bool:
    text = first_lines(head)
    return text.lstrip("\ufeff").startswith("//") and "PacketCounter" in text


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    """The time is made from the packet counter at the rate that the file gives: it begins again at 65536."""
    given = _RATE.search(first_lines(read_head(path)))
    rated = {**options, "rate": float(given[1])} if given and "rate" not in options else options
    return read_defined(path, file, rated, _UNITS, "Xsens: units by their definition, m/s2, rad/s and deg")


FORMAT = Format(
    "xsens",
    "Xsens MTw, MTi",
    (),
    "Text below lines that begin with //: Acc_X [m/s2], Gyr_X [rad/s], Roll [deg] and so on; time from PacketCounter and the "
    "update rate in the file.",
    TEXT,
    None,
    _recognises,
    _read,
)
