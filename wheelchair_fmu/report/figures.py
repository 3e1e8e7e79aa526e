"""Figures: data in, a matplotlib Figure out; nothing is read or written here.

Colours are those of Okabe and Ito, told apart by every kind of colour vision; lines differ in style too.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from .canvas import blank

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BLACK, BLUE, ORANGE, GREEN, GREY = "#000000", "#0072B2", "#D55E00", "#009E73", "#767676"
BAND = "#CFE3EF"
STRAIGHT = 50.0  # m; a larger radius of curvature is called straight
FLOOR = 1.0  # whitened RMS of a model whose errors are nothing but the sensors' noise

# What the last panel of a manoeuvre may show: axis label and factor from SI.
WATCHED = {
    "push.total_needed": ("push needed [N]", 1.0),
    "chair.u": ("forward speed u [m/s]", 1.0),
    "chair.psi_dot": ("yaw rate ψ' [deg/s]", 180 / np.pi),
}


def manoeuvre_figure(title: str, time: np.ndarray, columns: Mapping[str, np.ndarray], watch: str) -> Figure:
    """Path, slip angles and radius of curvature of a manoeuvre, as in Figs. 12 to 19, and one result more.

    `time` is (n,) in s; `columns` hold (n,) each, SI units, by FMI name: chair.x, chair.y, slip.rl, slip.rr,
    chair.curvature and `watch`, which WATCHED may have words for. x (forward) points up and y to the right, with equal scales.
    """
    figure = blank(10, 7)
    axes = figure.subplot_mosaic([["path", "slip"], ["path", "radius"], ["path", "watch"]], width_ratios=[1, 1.25])
    figure.suptitle(title)
    _path(axes["path"], time, columns["chair.x"], columns["chair.y"])
    for name, text, colour, style in (("slip.rl", "left", BLUE, "-"), ("slip.rr", "right", ORANGE, "--")):
        axes["slip"].plot(time, np.degrees(columns[name]), style, color=colour, label=f"{text} rear wheel")
    axes["slip"].set_ylabel("slip angle λ [deg]")
    axes["slip"].legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False, ncols=2)
    _radius(axes["radius"], time, columns["chair.curvature"])
    label, factor = WATCHED.get(watch, (f"{watch}, SI units", 1.0))
    axes["watch"].plot(time, factor * columns[watch], color=BLACK)
    axes["watch"].set_ylabel(label)
    axes["watch"].set_xlabel("time [s]")
    for name in ("slip", "radius", "watch"):
        tidy(axes[name])
        axes[name].set_xlim(time[0], time[-1])
        _steady_axis(axes[name])
    for name in ("slip", "radius"):
        axes[name].tick_params(labelbottom=False)
    figure.align_ylabels([axes[name] for name in ("slip", "radius", "watch")])
    return figure


def _path(ax: Axes, time: np.ndarray, x: np.ndarray, y: np.ndarray) -> None:
    seconds = np.searchsorted(time, np.arange(np.ceil(time[0]), time[-1] + 1e-9))
    ax.plot(y, x, color=BLUE)
    ax.plot(y[seconds], x[seconds], ".", color=BLUE, ms=5, label="every second")
    ax.plot(y[0], x[0], "o", color=ORANGE, ms=8, label="start", zorder=3)
    ax.plot(y[-1], x[-1], "s", mfc="white", mec=BLACK, ms=7, label="end", zorder=3)
    ax.set_aspect("equal", adjustable="datalim")
    ax.margins(0.08)
    ax.locator_params(axis="x", nbins=6)
    ax.set_xlabel("y of the CM, to the right [m]")
    ax.set_ylabel("x of the CM, forward [m]")
    ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), frameon=False, ncols=3, columnspacing=1.0, handletextpad=0.2)
    tidy(ax)


def _radius(ax: Axes, time: np.ndarray, curvature: np.ndarray) -> None:
    """R_c where it is not next to infinite; the axis ends at some times the tightest turn."""
    turning = np.abs(curvature) > 1 / STRAIGHT
    ax.set_ylabel("radius $R_c$ [m]")
    if not turning.any():
        ax.text(
            0.5,
            0.5,
            f"straight: $|R_c|$ > {STRAIGHT:g} m throughout",
            ha="center",
            va="center",
            transform=ax.transAxes,
            color=GREY,
        )
        ax.set_yticks([])
        ax.set_ylim(0, 1)
        return
    radius = np.full_like(curvature, np.nan)
    radius[turning] = 1 / curvature[turning]
    most = float(np.clip(6 * np.nanpercentile(np.abs(radius), 5), 0.5, STRAIGHT))
    radius[np.abs(radius) > 1.5 * most] = np.nan  # so that the line does not cross from +∞ to −∞
    ax.plot(time, radius, color=GREEN)
    ax.set_ylim(-most if np.nanmin(radius) < 0 else 0, most if np.nanmax(radius) > 0 else 0)


def overlay_figure(
    run: str,
    time: np.ndarray,
    measured: Mapping[str, np.ndarray],
    predicted: Mapping[str, np.ndarray],
    sigma: Mapping[str, float],
    units: Mapping[str, str] | None = None,
    offsets: Mapping[str, float] | None = None,
) -> Figure:
    """What sensors read and what the model predicts, channel by channel, each with its residual below.

    `time` is (n,) in s; `measured` (with NaN in gaps) and `predicted` hold (n,) by channel name, in one unit;
    `sigma` is one standard deviation of each channel's noise in that unit. Residuals, measured less predicted, are in
    sigmas over a band of ±2, where 95 % of a perfect model's lie. `offsets` are what was estimated of sensors' offsets, which
    is taken off what they read, and said above the channel.
    """
    names = list(measured)
    figure = blank(10, 0.6 + 2.6 * len(names))
    figure.suptitle(run, y=1 - 0.1 / figure.get_figheight(), va="top")
    grid = _stacked(figure, [2, 1] * len(names))
    for name, above, below in zip(names, grid[::2], grid[1::2], strict=True):
        unit = (units or {}).get(name, "")
        read = measured[name]
        if offset := (offsets or {}).get(name):
            read = read - offset
            above.set_title(f"measured, less its estimated offset of {offset:.3g} {unit}", loc="left", fontsize=9)
        above.plot(time, read, ".", color=GREY, ms=2, label="measured")
        above.plot(time, predicted[name], color=BLUE, label="model")
        above.set_ylabel(f"{name} [{unit}]" if unit else name)
        below.axhspan(-2, 2, color=BAND, lw=0, label="±2 σ")
        below.plot(time, (read - predicted[name]) / sigma[name], ".", color=ORANGE, ms=2)
        below.set_ylabel("residual [σ]")
        _at_least(below, 4)
        for ax in (above, below):
            tidy(ax)
    handles = [*grid[0].get_legend_handles_labels()[0], *grid[1].get_legend_handles_labels()[0]]
    grid[0].legend(handles=handles, loc="lower right", bbox_to_anchor=(1, 1), frameon=False, ncols=3, markerscale=4)
    grid[-1].set_xlabel("time [s]")
    grid[-1].set_xlim(time[0], time[-1])
    return figure


def _stacked(figure: Figure, heights: Sequence[float]) -> np.ndarray:
    """Panels below each other (n,), with the labels of their axes in one line: in places that are known, as to find such ones
    takes many panels four times as long to draw."""
    width, height = figure.get_size_inches()
    left, right, bottom, top = 0.85, 0.15, 0.55, 0.65  # in
    figure.set_layout_engine("none")
    places = {"left": left / width, "right": 1 - right / width, "bottom": bottom / height, "top": 1 - top / height}
    grid: np.ndarray = figure.subplots(
        len(heights), 1, sharex=True, squeeze=False, height_ratios=heights, gridspec_kw={**places, "hspace": 0.22}
    )[:, 0]
    for ax in grid:
        ax.yaxis.set_label_coords(-0.65 / (width - left - right), 0.5)
    return grid


def staircase_figure(ladder: Sequence[Mapping[str, Any]]) -> Figure:
    """The error falling, step by step.

    `ladder` is a sequence of {"step": name, "fit": whitened RMS, "heldout": whitened RMS or None}, in order; the noise
    floor of 1.0 is marked.
    """
    figure = blank(1.6 + 1.5 * max(len(ladder), 2), 4.2)
    ax = figure.subplots()
    place = np.arange(len(ladder))
    width = 0.38
    for key, text, side, colour, hatch in (("fit", "fit runs", -1, BLUE, ""), ("heldout", "held-out runs", 1, ORANGE, "//")):
        heights = np.array([np.nan if step.get(key) is None else float(step[key]) for step in ladder])
        bars = ax.bar(place + side * width / 2, heights, width, color=colour, hatch=hatch, ec="white", label=text)
        ax.bar_label(bars, ["" if np.isnan(h) else f"{h:.2f}" for h in heights], padding=2, fontsize=9)
    ax.axhline(FLOOR, color=BLACK, ls="--", lw=1)
    ax.annotate(
        "noise floor",
        (1, FLOOR),
        xycoords=("axes fraction", "data"),
        xytext=(4, 0),
        textcoords="offset points",
        va="center",
        annotation_clip=False,
    )
    ax.set_xticks(place, [str(step["step"]).replace("_", "_\n") for step in ladder])
    ax.set_ylabel("whitened RMS error [1]")
    ax.set_ylim(0, 1.15 * max([FLOOR, *ax.get_ylim()]))
    ax.legend(loc="lower right", bbox_to_anchor=(1, 1), frameon=False, ncols=2)
    tidy(ax, grid="y")
    return figure


def where_figure(runs: Sequence[str], channels: Sequence[str], rms: np.ndarray) -> Figure:
    """Where the error is: whitened RMS of each run (rows) and channel (columns), `rms` (runs, channels).

    NaN, for a channel that a run lacks, stays white. 1.0 is the noise floor; the colours are logarithmic.
    """
    figure = blank(2.6 + 1.15 * len(channels), 1.4 + 0.42 * len(runs))
    ax = figure.subplots()
    shown = np.log10(np.maximum(np.asarray(rms, float), FLOOR))
    most = max(1.0, float(np.nanmax(shown)) if np.isfinite(shown).any() else 1.0)
    image = ax.imshow(np.ma.masked_invalid(shown), cmap="cividis_r", vmin=0, vmax=most, aspect="auto")
    for (i, j), value in np.ndenumerate(np.asarray(rms, float)):
        if np.isfinite(value):
            ax.text(j, i, f"{value:#.3g}", ha="center", va="center", color="white" if shown[i, j] > 0.5 * most else "black")
    ax.set_xticks(range(len(channels)), [name.replace("wheel_speed", "wheel\nspeed") for name in channels])
    ax.set_yticks(range(len(runs)), runs)
    ax.tick_params(length=0, top=True, labeltop=True, bottom=False, labelbottom=False)
    ax.spines[:].set_visible(False)
    bar = figure.colorbar(image, ax=ax, label="whitened RMS error [1]")
    decades = np.arange(0, most + 1e-9, 0.5)
    bar.set_ticks(list(decades), labels=[f"{10**d:.3g}" for d in decades])
    return figure


def tidy(ax: Axes, grid: Literal["both", "y"] = "both") -> None:
    ax.grid(axis=grid, color="#E4E4E4", lw=0.6)
    ax.set_axisbelow(True)
    ax.spines[["top", "right"]].set_visible(False)


def _steady_axis(ax: Axes) -> None:
    """Zero is marked, and rounding errors are not stretched over the whole axis."""
    low, high = ax.get_ylim()
    if high - low < 1e-6:
        ax.set_ylim(low - 0.5, high + 0.5)
    if low < 0 < high:
        ax.axhline(0, color=GREY, lw=0.6, zorder=0)
    ax.ticklabel_format(axis="y", useOffset=False)


def _at_least(ax: Axes, reach: float) -> None:
    """The axis shows ±reach, or more where the data need it."""
    low, high = ax.get_ylim()
    ax.set_ylim(min(low, -reach), max(high, reach))


def missing_figure(words: str, unit: str, panels: Sequence[Mapping[str, Any]]) -> Figure:
    """What is missing against each variable, with its 95 % band.

    `words` and `unit` say what is missing; a panel is {"variable": words, "unit": its unit, "knots": (k,), "estimate": (k,),
    "se": (k,)}, with NaN where the data say nothing.
    """
    figure = blank(3.4 * min(3, len(panels)), 0.5 + 2.8 * math.ceil(len(panels) / 3))
    figure.suptitle(f"estimated missing {words}, with its 95 % band")
    axes = figure.subplots(math.ceil(len(panels) / 3), min(3, len(panels)), squeeze=False, sharey=True).ravel()
    for ax, panel in zip(axes, panels, strict=False):
        knots, estimate, se = (np.asarray(panel[key], float) for key in ("knots", "estimate", "se"))
        seen = np.isfinite(estimate)
        ax.axhline(0, color=GREY, lw=0.8)
        ax.fill_between(knots[seen], (estimate - 1.96 * se)[seen], (estimate + 1.96 * se)[seen], color=BLUE, alpha=0.25, lw=0)
        ax.plot(knots[seen], estimate[seen], "o-", color=BLUE, ms=3)
        ax.set_xlabel(f"{panel['variable']} [{panel['unit']}]")
        tidy(ax)
    for ax in axes[len(panels) :]:
        ax.set_axis_off()
    for row in axes[:: min(3, len(panels))]:
        row.set_ylabel(f"[{unit}]")
    return figure
