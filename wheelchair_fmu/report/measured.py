"""Figure of a measured turn: what the rear tyres carried against their slip."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from .canvas import blank
from .figures import BAND, BLACK, BLUE, GREEN, ORANGE, tidy

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def carried_figure(
    title: str, slip: np.ndarray, carried: np.ndarray, lines: Mapping[str, tuple[np.ndarray, np.ndarray]]
) -> Figure:
    """Carried force over load against slip in degrees, samples in time order, and laws to compare.

    `slip` and `carried` are (3, n): a lower bound, the median and an upper bound; `lines` are slip [deg] and force/load by
    label.
    """
    figure = blank(8, 5)
    ax = figure.subplots()
    figure.suptitle(title)
    ax.errorbar(
        slip[1],
        carried[1],
        xerr=np.abs(slip[[0, 2]] - slip[1]),
        yerr=np.abs(carried[[0, 2]] - carried[1]),
        fmt="o-",
        ms=4,
        color=BLACK,
        ecolor=BAND,
        label="measured, with 90 % intervals",
    )
    for (label, (x, y)), (colour, style) in zip(lines.items(), ((BLUE, "-"), (ORANGE, "--"), (GREEN, "-.")), strict=False):
        ax.plot(x, y, style, color=colour, label=label)
    ax.set_xlabel("slip angle, mean of both wheels by load [deg]")
    ax.set_ylabel("lateral force by slip / rear load [1]")
    ax.set_xlim(0, float(slip[2].max()))
    ax.set_ylim(0, 1.4 * float(carried[1].max()))
    ax.legend(frameon=False, loc="upper left")
    tidy(ax)
    return figure
