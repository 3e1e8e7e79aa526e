"""Figures as files whose bytes depend on nothing but what they show."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.figure import Figure

STEADY: Any = {"svg.hashsalt": "wheelchair-fmu", "svg.fonttype": "path"}
UNDATED = {".svg": {"Date": None, "Creator": None}, ".png": {"Software": None}}


def save(figure: Figure, path: Path) -> None:
    """Write a figure as PNG or SVG, by the path's ending."""
    with matplotlib.rc_context(STEADY):
        figure.savefig(path, dpi=150, metadata=UNDATED[path.suffix])
