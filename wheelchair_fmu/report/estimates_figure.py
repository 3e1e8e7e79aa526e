"""Estimates of effects beside what would be of interest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .canvas import blank
from .figures import BAND, BLACK, BLUE, GREY, tidy

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LINEAR = 2.0  # δ, up to which the axis is linear
TICKS = (-100, -30, -10, -3, -1, 0, 1, 3, 10, 30, 100)


def estimates_figure(rows: Sequence[Mapping[str, Any]]) -> Figure:
    """Estimates with their intervals, in units of the smallest interesting size δ; |δ| < 1 is a band.

    A row has "name", "estimate", "lower", "upper" and "smallest_interesting", in one unit, with NaN for an end that there is
    not, and "found": is it in the model, or was it tried in the place of what is?
    """
    figure = blank(8, 1.4 + 0.34 * len(rows))
    ax = figure.subplots()
    delta = np.array([row["smallest_interesting"] for row in rows], float)
    estimate, lower, upper = (np.array([row[key] for row in rows], float) / delta for key in ("estimate", "lower", "upper"))
    place, found = -np.arange(len(rows)), np.array([row["found"] for row in rows], bool)
    ax.axvspan(-1, 1, color=BAND, lw=0, label="of no interest")
    ax.axvline(0, color=GREY, lw=0.8)
    for which, colour, marker, words in (
        (found, BLACK, "o", "found"),
        (~found, BLUE, "s", "each alone, in the place of what was found"),
    ):
        ax.hlines(place[which], lower[which], upper[which], color=colour, lw=2)
        ax.plot(
            estimate[which], place[which], marker, color=colour, mfc=colour if marker == "o" else "white", ms=5, label=words
        )
    ax.set_yticks(place, [str(row["name"]) for row in rows])
    ax.set_xscale("symlog", linthresh=LINEAR)
    low, high = ax.get_xlim()
    ax.set_xticks(
        [t for t in TICKS if low <= t <= high], [f"{t:g}".replace("-", "−") for t in TICKS if low <= t <= high], minor=False
    )
    ax.set_xticks([], minor=True)
    ax.set_xlabel("estimate with its 95 % interval, in smallest interesting sizes δ")
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False, ncols=3, columnspacing=1.0)
    tidy(ax)
    return figure
