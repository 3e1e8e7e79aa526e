"""Where a figure is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def blank(width: float, height: float) -> Figure:
    """An empty figure of this size [in]. matplotlib comes with the first: loading it takes longer than most commands."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained")
