"""Figures of tyres, as Figs. 4 to 9 of the paper: measured points, and the laws through them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..tyres.identify import ConditionFit
from ..tyres.magic_formula import FORCE, TORQUE
from ..tyres.records import CAMBER, SLIP
from .figures import BAND, BLACK, BLUE, GREEN, GREY, ORANGE, tidy

PANELS = (
    (SLIP, FORCE, "side slip force / load [1]", "slip angle λ [deg]"),
    (SLIP, TORQUE, "self-aligning torque / load [mm]", "slip angle λ [deg]"),
    (CAMBER, FORCE, "camber force / load [1]", "camber angle φ [deg]"),
    (CAMBER, TORQUE, "twisting torque / load [mm]", "camber angle φ [deg]"),
)
LOOKS = ((BLUE, "-", "o"), (ORANGE, "-", "s"), (BLUE, "--", "^"), (ORANGE, "--", "v"), (GREEN, "-", "D"), (BLACK, "-", "x"))
SCALE = {FORCE: 1.0, TORQUE: 1e3}


def comparison_figure(title: str, curves: Sequence[tuple[str, ConditionFit]]) -> Figure:
    """Forces and torques over the load, corrected for the curvature force, of labelled conditions: Figs. 4, 6 and 7."""
    figure = Figure(figsize=(10, 7.5), layout="constrained")
    figure.suptitle(title)
    for ax, (kind, channel, above, below) in zip(figure.subplots(2, 2).flat, PANELS, strict=True):
        for (label, fit), look in zip(curves, LOOKS, strict=False):
            _normalised(ax, fit, kind, channel, label, look)
        ax.set_ylabel(above)
        ax.set_xlabel(below)
        _axes(ax)
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2, frameon=False)
    return figure


def single_figure(title: str, curves: Sequence[tuple[str, ConditionFit]]) -> Figure:
    """The side slip force alone: Fig. 5."""
    figure = Figure(figsize=(6.5, 4.5), layout="constrained")
    figure.suptitle(title)
    ax = figure.subplots()
    for (label, fit), look in zip(curves, LOOKS, strict=False):
        _normalised(ax, fit, SLIP, FORCE, label, look)
    ax.set_ylabel(PANELS[0][2])
    ax.set_xlabel(PANELS[0][3])
    ax.legend(frameon=False)
    _axes(ax)
    return figure


def laws_figure(
    title: str, channel: str, curves: Sequence[tuple[str, ConditionFit]], tolerance: float
) -> Figure:
    """Measured points of each condition, and what the linear, Dugoff's and Pacejka's law make of them: Figs. 8 and 9.

    The band is where the linear law is within `tolerance` [1] of the Magic Formula.
    """
    figure = Figure(figsize=(4.2 * len(curves) + 0.5, 4.6), layout="constrained")
    figure.suptitle(title)
    row = figure.subplots(1, len(curves), sharex=True, sharey=True, squeeze=False)[0]
    for ax, (label, fit) in zip(row, curves, strict=True):
        curve = fit.fits.get((SLIP, channel))
        if curve is None:
            continue
        ax.set_title(label, fontsize="medium")
        x = np.linspace(0, curve.curve.angle[-1], 300)
        ax.axvspan(0, np.degrees(curve.linear_to), color=BAND, lw=0, zorder=0,
                   label=f"linear within {100 * tolerance:g} %")  # fmt: skip
        ax.plot(np.degrees(x), curve.K.value * x, ":", color=GREY, label="linear")
        if fit.dugoff is not None and (channel == FORCE or fit.dugoff.c_p is not None):
            y = fit.dugoff.force(x) if channel == FORCE else fit.dugoff.torque(x)
            ax.plot(np.degrees(x), y, "--", color=ORANGE, label="Dugoff")
        if curve.magic is not None:
            ax.plot(np.degrees(x), curve.magic(x), "-", color=BLUE, label="Magic Formula")
        ax.plot(np.degrees(curve.curve.angle), curve.curve.value, "o", color=BLACK, ms=4, label="measured")
        ax.set_xlabel("slip angle λ [deg]")
        _axes(ax)
    reach = 1.15 * max((fit.fits[SLIP, channel].curve.largest for _, fit in curves if (SLIP, channel) in fit.fits), default=1)
    row[0].set_ylim((0, reach) if channel == FORCE else (-reach, 0))
    row[0].set_ylabel("side slip force [N]" if channel == FORCE else "self-aligning torque [N m]")
    handles, labels = row[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5, frameon=False)
    return figure


def _normalised(
    ax: Axes, fit: ConditionFit, kind: str, channel: str, label: str, look: tuple[str, str, str]
) -> None:
    curve = fit.fits.get((kind, channel))
    if curve is None:
        return
    colour, line, marker = look
    scale = SCALE[channel] / fit.condition.load
    x = np.linspace(0, curve.curve.angle[-1], 200)
    law = curve.K.value * x if curve.magic is None else curve.magic(x)
    ax.plot(np.degrees(x), scale * law, line, color=colour)
    ax.plot(np.degrees(curve.curve.angle), scale * curve.curve.value, marker, color=colour, ms=4, mfc="white")
    ax.plot([], [], line, marker=marker, mfc="white", ms=4, color=colour, label=label)


def _axes(ax: Axes) -> None:
    ax.axhline(0, color=GREY, lw=0.6, zorder=0)
    ax.margins(x=0.02)
    tidy(ax)
