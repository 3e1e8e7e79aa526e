"""Picture of clocks that were found: what two devices see alike, before and after their times are brought together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..campaign.syncing import RunClocks, alike
from .canvas import blank
from .figures import BLUE, GREEN, GREY, ORANGE, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = (BLUE, ORANGE, GREEN, GREY)
Curve = tuple[np.ndarray, np.ndarray]


def sync_figure(found: Sequence[RunClocks]) -> Figure:
    """A row for each run: one motion as each device saw it, by its own clock and by the run's, in units of its own range."""
    figure = blank(11, 0.6 + 1.9 * len(found))
    axes = figure.subplots(len(found), 2, squeeze=False)
    for row, one in zip(axes, found, strict=True):
        title, curves = alike(one.run)
        for ax, shift in zip(row, (False, True), strict=True):
            _panel(ax, curves, {d: one.seconds(d) if shift else 0.0 for d in curves})
        row[0].set_ylabel(f"{one.run.name}\n{title}", fontsize=8)
    axes[0][0].set_title("by each device's own clock", fontsize=10)
    axes[0][1].set_title("by the clocks that were found", fontsize=10)
    for ax in axes[-1]:
        ax.set_xlabel("time [s]")
    axes[0][0].legend(frameon=False, fontsize=8, loc="upper left")
    return figure


def _panel(ax: Axes, curves: Mapping[str, Curve], offsets: Mapping[str, float]) -> None:
    for i, (device, (time, values)) in enumerate(curves.items()):
        late = offsets[device] if np.isfinite(offsets[device]) else 0.0
        ax.plot(time + late, values, color=COLOURS[i % len(COLOURS)], linewidth=0.8, label=device or "recording")
    ax.set_yticks([])
    tidy(ax)
