"""Figures of tyres, as Figs. 4 to 9 of the paper: measured points, and the laws through them."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from ..tyres.identify import ConditionFit, Identified
from ..tyres.magic_formula import FORCE, TORQUE
from ..tyres.parameters import chosen
from ..tyres.records import CAMBER, SLIP
from .canvas import blank
from .figures import BAND, BLACK, BLUE, GREEN, GREY, ORANGE, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PANELS = (
    (SLIP, FORCE, "side slip force / load [1]", "slip angle λ [deg]"),
    (SLIP, TORQUE, "self-aligning torque / load [mm]", "slip angle λ [deg]"),
    (CAMBER, FORCE, "camber force / load [1]", "camber angle φ [deg]"),
    (CAMBER, TORQUE, "twisting torque / load [mm]", "camber angle φ [deg]"),
)
LOOKS = ((BLUE, "-", "o"), (ORANGE, "-", "s"), (BLUE, "--", "^"), (ORANGE, "--", "v"), (GREEN, "-", "D"), (BLACK, "-", "x"))
LONG = {"speed": "forward speed on the side slip force", "pressure": "inflation pressure", "load": "vertical load"}
SCALE = {FORCE: 1.0, TORQUE: 1e3}


def paper_figures(found: Identified) -> Iterator[tuple[str, Figure]]:
    """Figs. 4 to 9, as far as the conditions allow: a name and a figure each."""
    references = {tyre: chosen(found, tyre, None, None, None) for tyre in found.tyres}
    at = [f"tyre {tyre}: {_at(fit)}" for tyre, fit in references.items()]
    yield (
        "reference",
        comparison_figure("Forces and torques in the reference condition", list(zip(at, references.values(), strict=True))),
    )
    for name in ("speed", "pressure", "load"):
        curves = [(f"tyre {tyre}: {_at(f)}", f) for tyre, fit in references.items() for f in _varied(found, fit, name)]
        if name == "speed":
            curves = [(label, f) for label, f in curves if (SLIP, FORCE) in f.fits]
        if len(curves) > len(references):
            draw = single_figure if name == "speed" else comparison_figure
            yield name, draw(f"Effect of {LONG[name]}", curves)
    for tyre, fit in references.items():
        others = [f for name in ("pressure", "load") for f in _varied(found, fit, name) if f is not fit]
        labelled = [(_at(f), f) for f in (fit, *others)]
        for channel in (FORCE, TORQUE):
            if (SLIP, channel) not in fit.fits:
                continue
            what = "side slip force" if channel == FORCE else "self-aligning torque"
            figure = laws_figure(f"Tyre {tyre}: laws of the {what}", channel, labelled, found.tolerance)
            yield f"{_as_file_name(tyre)}-{channel}", figure


def _varied(found: Identified, reference: ConditionFit, name: str) -> list[ConditionFit]:
    """The reference and the conditions that differ from it in this alone."""
    same = {n: getattr(reference.condition, n) for n in ("tyre", "pressure", "load", "speed") if n != name}
    return [f for f in found.conditions if all(getattr(f.condition, n) == v for n, v in same.items())]


def _as_file_name(tyre: str) -> str:
    return re.sub(r"[^\w.-]+", "-", tyre)


def _at(fit: ConditionFit) -> str:
    return str(fit.condition).partition(", ")[2]


def comparison_figure(title: str, curves: Sequence[tuple[str, ConditionFit]]) -> Figure:
    """Forces and torques over the load, corrected for the curvature force, of labelled conditions: Figs. 4, 6 and 7."""
    figure = blank(10, 7.5)
    figure.suptitle(title)
    for ax, (kind, channel, above, below) in zip(figure.subplots(2, 2).flat, PANELS, strict=True):
        for (label, fit), look in zip(curves, cycle(LOOKS), strict=False):
            _normalised(ax, fit, kind, channel, label, look)
        ax.set_ylabel(above)
        ax.set_xlabel(below)
        _axes(ax)
    handles = {label: handle for ax in figure.axes for handle, label in zip(*ax.get_legend_handles_labels(), strict=True)}
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=2, frameon=False)
    return figure


def single_figure(title: str, curves: Sequence[tuple[str, ConditionFit]]) -> Figure:
    """The side slip force alone: Fig. 5."""
    figure = blank(6.5, 4.5)
    figure.suptitle(title)
    ax = figure.subplots()
    for (label, fit), look in zip(curves, cycle(LOOKS), strict=False):
        _normalised(ax, fit, SLIP, FORCE, label, look)
    ax.set_ylabel(PANELS[0][2])
    ax.set_xlabel(PANELS[0][3])
    ax.legend(frameon=False)
    _axes(ax)
    return figure


def laws_figure(title: str, channel: str, curves: Sequence[tuple[str, ConditionFit]], tolerance: float) -> Figure:
    """Measured points of each condition, and what the linear, Dugoff's and Pacejka's law make of them: Figs. 8 and 9.

    The band is where the linear law is within `tolerance` [1] of the Magic Formula.
    """
    figure = blank(4.2 * len(curves) + 0.5, 4.6)
    figure.suptitle(title)
    row = figure.subplots(1, len(curves), sharex=True, sharey=True, squeeze=False)[0]
    for ax, (label, fit) in zip(row, curves, strict=True):
        curve = fit.fits.get((SLIP, channel))
        if curve is None:
            continue
        ax.set_title(label, fontsize="medium")
        x = np.linspace(0, curve.curve.angle[-1], 300)
        ax.axvspan(0, np.degrees(curve.linear_to), color=BAND, lw=0, zorder=0, label=f"linear within {100 * tolerance:g} %")
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


def _normalised(ax: Axes, fit: ConditionFit, kind: str, channel: str, label: str, look: tuple[str, str, str]) -> None:
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
