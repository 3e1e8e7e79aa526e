"""OptiPush: tab separated text below lines that begin with %, units by definition."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ._defined import first_lines, read_defined
from ._record import TEXT, Format, Read

_UNITS = {
    **dict.fromkeys(("fx", "fy", "fz"), "N"),
    **dict.fromkeys(("tx", "ty", "tz"), "N.m"),
    "angle": "deg",
    "push start": "-",
    "push end": "-",
}


def _recognises(path: Path, head: bytes) -> bool:
    return bool(re.search(r"^%\s*Time\s*\(s\)\s*\tPush Start", first_lines(head), re.MULTILINE))


def _read(path: Path, file: str, options: Mapping[str, Any]) -> Read:
    return read_defined(path, file, options, _UNITS, "OptiPush: units by their definition, N, N.m and deg")


FORMAT = Format(
    "optipush",
    "OptiPush",
    (),
    "Tab separated text below lines that begin with %: Fx Fy Fz [N], Tx Ty Tz [N.m], Angle [deg], at 200 Hz.",
    TEXT,
    None,
    _recognises,
    _read,
)
