"""Estimates of effects beside what would be of interest."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .canvas import blank
from .figures import BAND, BLACK, BLUE, GREY, tidy

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def estimates_figure(rows: Sequence[Mapping[str, Any]]) -> Figure:
    """Estimates with their intervals, in units of the smallest interesting size δ; |δ| < 1 is a band.

    A row has "name", "estimate", "lower", "upper" and "smallest_interesting", in one unit; NaN ends are not drawn.
    """
    figure = blank(8, 1.2 + 0.34 * len(rows))
    ax = figure.subplots()
    delta = np.array([row["smallest_interesting"] for row in rows], float)
    estimate, lower, upper = (np.array([row[key] for row in rows], float) / delta for key in ("estimate", "lower", "upper"))
    place = -np.arange(len(rows))
    ax.axvspan(-1, 1, color=BAND, lw=0)
    ax.axvline(0, color=GREY, lw=0.8)
    ax.hlines(place, lower, upper, color=BLUE, lw=2)
    ax.plot(estimate, place, "o", color=BLACK, ms=4)
    ax.set_yticks(place, [str(row["name"]) for row in rows])
    ax.set_xscale("symlog", linthresh=2)
    ax.set_xlabel("estimate with its 95 % interval, in smallest interesting sizes δ")
    tidy(ax)
    return figure
