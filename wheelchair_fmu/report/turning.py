"""Figures of steady turning: radius, slip and ΔF, and eigenvalues against speed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from .canvas import blank
from .figures import BLACK, BLUE, GREEN, GREY, ORANGE, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

LINES = ((BLUE, ":"), (BLACK, "-"), (GREEN, "-."), (ORANGE, "--"))
WIDEST = 10.0  # m; a larger radius is not drawn

Columns = Mapping[str, np.ndarray]


def turning_figure(title: str, curves: Mapping[float, Columns], locus: Columns, slip_limit: float) -> Figure:
    """Radius and slip against ΔF, ΔF against lateral acceleration, and eigenvalues against speed.

    `curves` are, by speed in m/s, columns (n,) delta_force [N], radius [m], slip [deg], a_y [m/s²], each ending at the first
    limit; `locus` holds speed (m,) and eigenvalues (m, k), complex, in 1/s; `slip_limit` is in degrees.
    """
    figure = blank(10, 7)
    axes = figure.subplot_mosaic([["radius", "force"], ["slip", "locus"]])
    figure.suptitle(title)
    for (speed, curve), (colour, style) in zip(curves.items(), LINES, strict=False):
        drawn = np.where(curve["radius"] <= WIDEST, curve["radius"], np.nan)
        for name, x, y in (
            ("radius", curve["delta_force"], drawn),
            ("slip", curve["delta_force"], curve["slip"]),
            ("force", curve["a_y"], curve["delta_force"]),
        ):
            axes[name].plot(x, y, style, color=colour, label=f"{speed:g} m/s")
            axes[name].plot(x[-1], y[-1], "x", color=colour, ms=7)
    axes["slip"].axhline(slip_limit, color=GREY, lw=0.8)
    for name, label in (("radius", "radius $R_c$ [m]"), ("slip", "larger slip angle [deg]"), ("force", "ΔF [N]")):
        axes[name].set_ylabel(label)
        axes[name].set_xlabel("lateral acceleration u ψ' [m/s²]" if name == "force" else "ΔF [N]")
        axes[name].set_ylim(bottom=0)
        axes[name].set_xlim(left=0)
        tidy(axes[name])
    axes["force"].legend(frameon=False, title="× first limit", alignment="left")
    _locus(axes["locus"], locus["speed"], locus["eigenvalues"])
    return figure


def _locus(ax: Axes, speed: np.ndarray, eigenvalues: np.ndarray) -> None:
    """Real parts on a logarithmic axis either side of zero; what swings and what grows is marked."""
    for k in range(eigenvalues.shape[1]):
        real, swings = eigenvalues[:, k].real, np.abs(eigenvalues[:, k].imag) > 1e-9
        ax.plot(speed, real, ".", color=BLUE, ms=2)
        ax.plot(speed[swings], real[swings], ".", color=ORANGE, ms=4)
        grows = real > 0
        ax.plot(speed[grows], real[grows], "x", color=BLACK, ms=4)
    for label, colour, marker in (("dies out", BLUE, "."), ("swings", ORANGE, "."), ("grows", BLACK, "x")):
        ax.plot([], [], marker, color=colour, label=label)
    ax.set_yscale("symlog", linthresh=0.1)
    ax.axhline(0, color=GREY, lw=0.8)
    ax.set_xlabel("forward speed u [m/s]")
    ax.set_ylabel("real part of the eigenvalues [1/s]")
    ax.legend(frameon=False, ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1.0), handletextpad=0.1)
    tidy(ax)
