"""Every signal of every run on one page, before anything is concluded from it: a picture, and the same as HTML with all faults.

A row for each channel, a column for each run, so that a sign, a unit or a clock that is wrong in one run stands out beside the
others.
"""

from __future__ import annotations

import html
import io
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from ..campaign import BY_NAME, Recorded
from ..faults import ERROR
from .canvas import blank
from .figures import BLUE, GREY, ORANGE
from .saving import save_svg
from .words import CHANNELS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

POINTS = 1500  # of a curve; more is drawn as the range of each of so many pieces
ABREAST = 8  # runs in one picture
ROLES = {"holdout": "held out"}
ACROSS = 20  # letters of a signal's name in a line
STYLE = """body{font:16px/1.5 system-ui,sans-serif;margin:2rem auto;max-width:110rem;padding:0 1rem}
body{color:#1a1a1a;background:#fff}
h1{font-size:1.5rem}li{margin:.2rem 0}.error{color:#a01010}.warning{color:#7a5200}
.picture{overflow-x:auto}svg{max-width:100%;min-width:52rem;height:auto}
@media(prefers-color-scheme:dark){body{background:#16181c;color:#e8e8e8}.error{color:#ff9d9d}.warning{color:#ffd28a}
svg{background:#fff;filter:invert(.91) hue-rotate(180deg)}}"""


LEGEND = "Each row is a channel, each column a run; a row has one scale. Crosses are readings that were left out."
NOTHING = "No signal of these files is known yet: which column is what has to be found out, or written down, first."


@dataclass(frozen=True, eq=False)
class Signal:
    """One channel of one run: times and values (n,), NaN in gaps; `odd` (m,) are times of readings that were left out."""

    name: str
    unit: str
    device: str
    time: np.ndarray
    values: np.ndarray
    odd: np.ndarray


@dataclass(frozen=True, eq=False)
class Run:
    """A run's signals, by channel."""

    name: str
    role: str
    signals: dict[str, Signal]


def seen(recorded: Iterable[Recorded]) -> list[Run]:
    """Runs as their devices recorded them, but for those of which nothing is known yet: of these there is nothing to see."""
    runs = (Run(run.name, run.entry.text("role"), dict(_signals(run))) for run in recorded)
    return [run for run in runs if run.signals]


def _signals(run: Recorded) -> Iterator[tuple[str, Signal]]:
    for draft in run.drafts:
        for name, series in draft.values.items():
            if draft.time is not None:
                odd = draft.time[list(draft.spikes.get(name, {}))]
                yield name, Signal(name, BY_NAME[name].unit.name, draft.part.device.name, draft.time, series, odd)


def figures(runs: Sequence[Run]) -> list[Figure]:
    """One picture for each ABREAST runs; a channel has one scale in all of them."""
    within = {name: _extent(run.signals[name] for run in runs if name in run.signals) for run in runs for name in run.signals}
    return [_figure(runs[i : i + ABREAST], within) for i in range(0, len(runs), ABREAST)]


def _extent(signals: Iterable[Signal]) -> tuple[float, float]:
    """From the least to the greatest value, with some room about them."""
    values = np.concatenate([signal.values[np.isfinite(signal.values)] for signal in signals])
    low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
    room = 0.05 * (high - low) or 0.5
    return low - room, high + room


def page(title: str, drawn: Iterable[Figure], faults: Iterable[tuple[str, str, str]]) -> str:
    """The pictures and all faults (severity, where, what) as one HTML file that needs nothing else."""
    several = list(drawn)
    names = [f"Every signal, picture {i} of {len(several)}" for i in range(1, len(several) + 1)]
    region = '<div class="picture" tabindex="0" role="region" aria-label="{}">'  # wide on a phone
    pictures = "".join(f"{region.format(name)}{_svg(figure)}</div>" for name, figure in zip(names, several, strict=True))
    said = "".join(f'<li class="{html.escape(kind)}">{told}</li>' for kind, told in _by_cause(faults))
    listed = f"<h2>What is odd</h2><ul>{said}</ul>" if said else "<p>Nothing odd was found.</p>"
    view = '<meta name="viewport" content="width=device-width,initial-scale=1">'
    head = f'<meta charset="utf-8">{view}<title>{html.escape(title)}</title>'
    return (
        f'<!doctype html><html lang="en"><head>{head}<style>{STYLE}</style></head><body><main><h1>{html.escape(title)}</h1>'
        f"<p>{LEGEND if pictures else NOTHING}</p>{pictures}{listed}</main></body></html>\n"
    )


def _by_cause(faults: Iterable[tuple[str, str, str]]) -> Iterator[tuple[str, str]]:
    """(severity, HTML) of each cause: what is wrong alike in many places is said once, with the places behind it."""
    places: dict[tuple[str, str], list[str]] = {}
    for kind, where, what in faults:
        places.setdefault((kind, what), []).append(where)
    for (kind, what), found in places.items():
        said = "" if kind == ERROR else f"{kind}: "
        if len(found) > 1:
            inside = html.escape("; ".join(found))
            yield kind, f"<details><summary>{said}in {len(found)} places: {html.escape(what)}</summary>{inside}</details>"
        else:
            yield kind, html.escape(f"{said}{found[0]}: {what}" if found[0] else f"{said}{what}")


def _svg(figure: Figure) -> str:
    held = io.StringIO()
    save_svg(figure, held)
    return held.getvalue().partition("<svg")[1] + held.getvalue().partition("<svg")[2]


def _figure(runs: Sequence[Run], within: Mapping[str, tuple[float, float]]) -> Figure:
    names = list(dict.fromkeys(name for run in runs for name in run.signals))
    figure = blank(2.2 + 2.4 * len(runs), 0.8 + 1.1 * max(len(names), 1))
    axes = figure.subplots(max(len(names), 1), max(len(runs), 1), sharex="col", sharey="row", squeeze=False)
    for column, run in enumerate(runs):
        axes[0][column].set_title(f"{run.name} ({ROLES.get(run.role, run.role)})" if run.role else run.name, fontsize=9)
        axes[-1][column].set_xlabel("time [s]", fontsize=8)
        for row, name in enumerate(names):
            _panel(axes[row][column], run.signals.get(name))
    for row, name in enumerate(names):
        one = next(run.signals[name] for run in runs if name in run.signals)
        of = f"\n{one.device}" if one.device else ""
        axes[row][0].set_ylim(within[name])
        axes[row][0].set_ylabel(f"{_called(name)}\n[{one.unit}]{of}", fontsize=8, rotation=0, ha="right", va="center")
    return figure


def _called(name: str) -> str:
    """A channel as a reader meets it, in short lines."""
    words = CHANNELS.get(name, "").removeprefix("the ") or (
        BY_NAME[name].meaning.partition(",")[0] if name in BY_NAME else name
    )
    return fill(words, ACROSS)


def _panel(ax: Axes, signal: Signal | None) -> None:
    ax.tick_params(labelsize=7)
    ax.axhline(0, color=GREY, linewidth=0.5)
    if signal is None:
        ax.text(0.5, 0.5, "not recorded", transform=ax.transAxes, ha="center", va="center", fontsize=7, color=GREY)
        return
    there = np.isfinite(signal.values)
    time, values = signal.time[there], signal.values[there]
    if len(time) <= POINTS:
        ax.plot(time, values, color=BLUE, linewidth=0.7)
    else:
        pieces = np.array_split(np.arange(len(time)), POINTS // 2)
        low, high = (np.array([f(values[p]) for p in pieces]) for f in (np.min, np.max))
        ax.fill_between([time[p[0]] for p in pieces], low, high, color=BLUE, linewidth=0.5)
    if signal.odd.size and len(time):
        ax.plot(signal.odd, np.interp(signal.odd, time, values), "x", color=ORANGE, markersize=5)
