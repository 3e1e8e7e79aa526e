"""Figures for print, as wide as a page's text: what a model leaves before and after, and estimates with their intervals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ...campaign import BY_NAME
from ...inference.residual.physical import READ_IN
from ..canvas import blank
from ..figures import BAND, BLACK, BLUE, GREY, ORANGE, tidy
from .case import EFFECT, OFFSET, Case, interval
from .replay import Replay

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MM = 1 / 25.4  # in
WIDE = 170 * MM
MANY = 4000  # samples, above which dots of a PDF are a picture
TALLEST = 225 * MM  # in, that leave room for a caption
LINEAR = 2.0  # of what an axis counts in, up to which it is linear
PRINT: Any = {
    "font.size": 8,
    "axes.titlesize": 8,
    "axes.labelsize": 8,
    "xtick.labelsize": 7,
    "ytick.labelsize": 7,
    "legend.fontsize": 7,
    "axes.linewidth": 0.6,
}


def residuals_figure(r: Replay, grew: bool) -> Figure:
    """Measured less simulated of each channel over time, as calibrated and, if the model `grew`, beside it with the last model.
    The band holds 95 % of what noise of the sensor alone would leave."""
    names, columns = list(r.after), _columns(r, grew)
    figure = blank(WIDE, min(TALLEST, (14 + 25 * len(names)) * MM))
    grid = figure.subplots(len(names), len(columns), sharex=True, sharey="row", squeeze=False)
    for name, row in zip(names, grid, strict=True):
        unit, factor = _shown(name)
        for ax, (_, series, colour) in zip(row, columns, strict=True):
            ax.axhspan(-1.96 * factor * r.sd[name], 1.96 * factor * r.sd[name], color=BAND, lw=0)
            ax.plot(r.time, factor * series[name], ".", ms=1.2, color=colour, rasterized=len(r.time) > MANY)
            tidy(ax)
        row[0].set_ylabel(f"{name}\n[{unit}]")
    for ax, (words, *_) in zip(grid[0], columns, strict=True):
        ax.set_title(words, loc="left")
    for ax in grid[-1]:
        ax.set_xlabel("time [s]")
        ax.set_xlim(float(r.time[0]), float(r.time[-1]))
    figure.align_ylabels(list(grid[:, 0]))
    return figure


def _columns(r: Replay, grew: bool) -> list[tuple[str, Mapping[str, np.ndarray], str]]:
    """Words, residuals by channel and colour of each column."""
    before = (f"{r.run}, as calibrated", r.before, ORANGE)
    return [before, (f"{r.run}, with the last model", r.after, BLUE)] if grew else [before]


def _shown(channel: str) -> tuple[str, float]:
    """The unit in which people read a channel, and its factor from SI."""
    unit = BY_NAME[channel].unit
    found = next((d for d in unit.display if d.name == READ_IN.get(unit.name)), None)
    name, factor = (found.name, found.factor) if found else (unit.name, 1.0)
    return name.replace("2", "²"), factor


def forest_figure(case: Case) -> Figure:
    """Every estimate with its 95 % interval: effects in smallest interesting sizes δ, calibrated values and sensor offsets in
    standard deviations of what was known before, or of the sensor's noise where nothing was."""
    panels = [(title, rows) for title, rows in _panels(case) if rows]
    heights = [len(rows) + 1.6 for _, rows in panels]
    figure = blank(WIDE, min(TALLEST, (6 + 6.5 * sum(heights)) * MM))
    axes = figure.subplots(len(panels), 1, squeeze=False, height_ratios=heights)[:, 0]
    for ax, (title, rows) in zip(axes, panels, strict=True):
        _forest(ax, rows)
        ax.set_xlabel(f"{title}; diamond: where the search stops" if any(row[-1] for row in rows) else title)
    return figure


Row = tuple[str, float, float, float, float, bool]  # name, estimate, ends, half the band, at bound


def _panels(case: Case) -> list[tuple[str, list[Row]]]:
    effects = [p for p in case.parameters if p["name"].startswith(EFFECT)]
    offsets = [p for p in case.parameters if p["name"].startswith(OFFSET)]
    values = [p for p in case.parameters if not p["name"].startswith((EFFECT, OFFSET))]
    sizes = {p["name"]: p["smallest_interesting"] or 1.0 for p in effects}
    noise = {p["name"]: case.told["noise"]["sd"][p["name"].removeprefix(OFFSET)] for p in offsets}
    return [
        ("effects: estimate / smallest interesting size δ; band: less than δ", _rows(effects, sizes, 1.0)),
        (
            "calibrated values: (estimate − prior) / standard deviation of the prior; band: 95 % of it",
            _rows(values, {p["name"]: p["prior_sd"] or p["se"] or 1.0 for p in values}, 1.96),
        ),
        ("sensor offsets: estimate / standard deviation of the sensor's noise", _rows(offsets, noise, 1.0)),
    ]


def _rows(some: Sequence[Mapping[str, Any]], scale: Mapping[str, float], band: float) -> list[Row]:
    found = []
    for p in some:
        zero = 0.0 if p["name"].startswith((EFFECT, OFFSET)) or p["prior"] is None else p["prior"]
        estimate, lower, upper = ((value - zero) / scale[p["name"]] for value in (p["estimate"], *interval(p)[:2]))
        found.append((p["name"].removeprefix(EFFECT), estimate, lower, upper, band, p["at_bound"]))
    return found


def _forest(ax: Axes, rows: Sequence[Row]) -> None:
    place = -np.arange(len(rows))
    names, estimate, lower, upper, band, stopped = zip(*rows, strict=True)
    ax.axvspan(-band[0], band[0], color=BAND, lw=0)
    ax.axvline(0, color=GREY, lw=0.6)
    ax.hlines(place, lower, upper, color=BLACK, lw=1.2)
    for x, y, at_bound in zip(estimate, place, stopped, strict=True):
        ax.plot(x, y, "D" if at_bound else "o", color=ORANGE if at_bound else BLACK, ms=3.5)
    ax.set_yticks(place, names)
    ax.set_ylim(place[-1] - 0.8, 0.8)
    reach = float(np.nanmax(np.abs([*estimate, *lower, *upper, *band])))
    if reach > 10 * LINEAR:
        ax.set_xscale("symlog", linthresh=LINEAR)
    tidy(ax)
