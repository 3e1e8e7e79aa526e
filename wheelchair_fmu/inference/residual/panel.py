"""A missing force against what orders it, and over the time of a run in which something happened: for figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..estimation.statistics import finite

KNOTS = 10  # of a variable, alike in how much was recorded about each
POINTS = 60  # at most, of a run's course
AROUND = 3.0  # s of a run's course that are shown before something happened, and after


@dataclass(frozen=True)
class Panel:
    """Estimates (k,) of a force, with standard errors, at `knots` of a variable in its unit; NaN where nothing is told."""

    variable: str
    unit: str
    knots: np.ndarray
    estimate: np.ndarray
    se: np.ndarray

    def as_json(self) -> dict[str, Any]:
        told = {name: [finite(v) for v in getattr(self, name)] for name in ("knots", "estimate", "se")}
        return {"variable": self.variable, "unit": self.unit, **told}


def against(variable: str, unit: str, by: Sequence[np.ndarray], values: Sequence[np.ndarray]) -> Panel:
    """The mean of a force over runs, (n,) of each, where a variable `by` (n,) is about so large; its standard error is by how
    far runs have it apart."""
    there = [np.isfinite(x) & np.isfinite(v) for x, v in zip(by, values, strict=True)]
    every = np.concatenate([x[t] for x, t in zip(by, there, strict=True)])
    edges = np.unique(np.quantile(every, np.linspace(0, 1, KNOTS + 1)[1:-1]))
    knots, told = np.full(len(edges) + 1, np.nan), np.full((len(by), len(edges) + 1), np.nan)
    places = np.digitize(every, edges)
    for k in np.unique(places):
        knots[k] = np.median(every[places == k])
    for run, x, v, t in zip(told, by, values, there, strict=True):
        place = np.digitize(x[t], edges)
        for k in np.unique(place):
            run[k] = np.mean(v[t][place == k])
    runs = np.sum(np.isfinite(told), axis=0)
    seen, several = runs > 0, runs > 1
    estimate, se = np.full((2, len(knots)), np.nan)
    estimate[seen] = np.nanmean(told[:, seen], axis=0)
    se[several] = np.nanstd(told[:, several], axis=0, ddof=1) / np.sqrt(runs[several])
    kept = several if several.any() else seen
    return Panel(variable, unit, knots[kept], estimate[kept], se[kept])


def in_run(run: str, time: np.ndarray, values: np.ndarray, sd: np.ndarray, begins: float, ends: float) -> Panel:
    """The course (n,) of a force in a run about the time in which something happened."""
    shown = np.flatnonzero((time >= begins - AROUND) & (time <= ends + AROUND))
    shown = shown[:: max(1, -(-len(shown) // POINTS))]
    return Panel(f"time in {run}", "s", time[shown], values[shown], sd[shown])
