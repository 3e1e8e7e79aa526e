"""From recordings as loggers left them to a campaign.toml: who recorded what, and which column is what.

::

    taking: files ── gathering: tables ── naming: runs and devices ── guesses: what headers say
                                                                         │
    writing: campaign.toml ── deciding: wheels, frames, markers ── turning, together: what signals say

Names propose; signals decide what names cannot, and contradict them where they must. What neither tells is left to the user.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import ceil
from pathlib import Path

import numpy as np

from ...errors import Failure, unknown
from ...faults import Fault
from ..clocks import Signal
from . import wheels
from .choices import Choice, Plan
from .deciding import RADIUS, decide
from .gathering import opened, sources
from .taking import taken
from .unsure import Unsure, doubts, unsure
from .writing import BOUNDS, SIZES, Wanted, axes_of, needs_radius, open_axes, text

__all__ = [
    "BOUNDS",
    "RADIUS",
    "SIZES",
    "Choice",
    "Found",
    "Plan",
    "Unsure",
    "Wanted",
    "aside",
    "axes_of",
    "doubts",
    "find",
    "held_out",
    "needs_radius",
    "open_axes",
    "still",
    "text",
    "unsure",
]

HOLDOUT = "holdout"
SHARE = 5  # of so many runs one is kept for checking,
FEWEST = 3  # from so many on
STILL = 0.05  # m/s
FIRST = 20  # samples


@dataclass(frozen=True)
class Found:
    """What was found: the devices and how they are read, the runs in order, each run's files by device, what was odd."""

    plans: Sequence[Plan]
    runs: Sequence[str]
    files: Mapping[str, Mapping[str, tuple[Path, str]]]
    faults: Sequence[Fault]


def find(paths: Sequence[Path], radius: float | None, on: Mapping[str, str] = {}) -> Found:
    """Everything that recordings tell; `on` is which wheel ("l", "r") a device is on, where no name tells it.

    Raises UsageError for a path that is none, Failure where there is no recording."""
    files, twice = taken(paths)
    tables, others = opened(files)
    if not tables:
        what = "no recording was found" if files else "there is no file"
        raise Failure(
            "\n".join([f"{what} in {', '.join(map(str, paths))}; give the files that the loggers wrote", *map(str, others)])
        )
    devices, runs = sources(tables, on)
    plans = decide(devices, runs, radius)
    of = {run: {s.name: (s.files[run].path, s.files[run].file) for s in devices if run in s.files} for run in runs}
    return Found(plans, runs, of, [*twice, *others])


def aside(found: Found) -> dict[str, list[Signal]]:
    """By run what was left to another device that measured it too: no campaign reads it twice, but it tells of the clocks."""
    of: dict[str, list[Signal]] = {run: [] for run in found.runs}
    for plan in found.plans:
        for choice in (c for c in plan.choices if c.beside and c.settled):
            for run in plan.source.files.keys() & of.keys():
                series = plan.series(run, choice)
                if series is not None:
                    of[run].append(Signal(plan.name, choice.channel, *series))
    return of


def held_out(runs: Sequence[str], named: Sequence[str]) -> list[str]:
    """The runs that are kept for checking: those that are named, else those that are called so, else the last fifth.

    Raises UsageError for a name that no run has.
    """
    for name in named:
        if name not in runs:
            raise unknown("run", name, runs)
    called = [run for run in runs if HOLDOUT in run.lower()]
    last = runs[len(runs) - ceil(len(runs) / SHARE) :] if len(runs) >= FEWEST else []
    return list(named or called or last)


def still(found: Found, radius: float | None) -> dict[str, bool]:
    """The runs in which every wheel stands still at first."""
    result = {}
    for run in found.runs:
        rolled = [series for plan in found.plans for _, series in wheels.rolling(plan, run, radius or RADIUS)]
        starts = [abs(float(np.nanmedian(v[:FIRST]))) for _, v in rolled if np.isfinite(v[:FIRST]).any()]
        result[run] = bool(starts) and max(starts) < STILL
    return result
