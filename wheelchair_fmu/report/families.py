"""Figures of several runs that differ in one value: path and slip angles, or the radius, as Figs. 12 to 19 have them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from .canvas import blank
from .figures import BLACK, BLUE, GREY, ORANGE, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STYLES = ((BLUE, "-."), (BLACK, "-"), (ORANGE, "--"))  # less, reference, more
WIDEST = 15.0  # m; a larger radius is not drawn
ELONGATED = 4.0  # a path so many times longer than wide is drawn wider

Columns = Mapping[str, np.ndarray]


def family_figure(title: str, time: np.ndarray, runs: Mapping[str, Columns]) -> Figure:
    """The CM's paths and both slip angles of up to three runs by label.

    `time` is (n,) in s; each run holds (n,) of chair.x, chair.y, slip.rl and slip.rr, SI units. x points up, y to the right.
    """
    figure = blank(10, 5)
    axes = figure.subplot_mosaic([["path", "left"], ["path", "right"]], width_ratios=[1, 1.2])
    figure.suptitle(title)
    for (label, run), (colour, style) in zip(runs.items(), STYLES, strict=False):
        axes["path"].plot(run["chair.y"], run["chair.x"], style, color=colour, label=label)
        for side in ("left", "right"):
            axes[side].plot(time, np.degrees(run[f"slip.r{side[0]}"]), style, color=colour)
    _scaled(axes["path"], list(runs.values()))
    figure.legend(*axes["path"].get_legend_handles_labels(), loc="outside lower center", frameon=False, ncols=len(runs))
    for side in ("left", "right"):
        axes[side].set_ylabel(f"slip λ, {side} [deg]")
        axes[side].set_xlim(time[0], time[-1])
        _zero(axes[side])
    axes["left"].tick_params(labelbottom=False)
    axes["right"].set_xlabel("time [s]")
    figure.align_ylabels([axes["left"], axes["right"]])
    return figure


def radius_family_figure(title: str, time: np.ndarray, runs: Mapping[str, Columns]) -> Figure:
    """The radius of curvature of up to three runs by label, where it is not next to infinite.

    `time` is (n,) in s; each run holds chair.curvature (n,), in 1/m.
    """
    figure = blank(10, 4)
    ax = figure.subplots()
    figure.suptitle(title)
    for (label, run), (colour, style) in zip(runs.items(), STYLES, strict=False):
        curvature = run["chair.curvature"]
        radius = np.full_like(curvature, np.nan)  # gaps, so that no line crosses from +∞ to −∞
        drawn = np.abs(curvature) > 1 / WIDEST
        radius[drawn] = 1 / curvature[drawn]
        ax.plot(time, radius, style, color=colour, label=label)
    ax.set_ylabel("radius $R_c$ [m]")
    ax.set_xlabel("time [s]")
    ax.set_xlim(time[0], time[-1])
    ax.set_ylim(-WIDEST, WIDEST)
    figure.legend(*ax.get_legend_handles_labels(), loc="outside lower center", frameon=False, ncols=len(runs))
    _zero(ax)
    return figure


def _scaled(ax: Axes, runs: Sequence[Columns]) -> None:
    """A path with equal scales, unless it is too long for that."""
    along, across = (max(float(np.ptp(run[name])) for run in runs) for name in ("chair.x", "chair.y"))
    note = ""
    if along < ELONGATED * across:
        ax.set_aspect("equal", adjustable="datalim")
    else:
        note = " (stretched)"
    ax.margins(0.06)
    ax.set_xlabel(f"y of the CM, to the right [m]{note}")
    ax.set_ylabel("x of the CM, forward [m]")
    tidy(ax)


def _zero(ax: Axes) -> None:
    ax.axhline(0, color=GREY, lw=0.6, zorder=0)
    tidy(ax)
