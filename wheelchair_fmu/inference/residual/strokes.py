"""When strokes begin, by the recorded pushes, and where between two of them each moment is."""

from __future__ import annotations

import numpy as np

SMOOTHED = 0.1  # s over which pushes are averaged: a hand that strikes the rim is no stroke of its own
BEGINS, ENDS = 0.25, 0.1  # of the strongest push, at which a stroke begins and is over
SHORTEST = 0.3  # s from one stroke to the next
USUAL = 1.0  # s from one stroke to the next where there is but one


def begun(time: np.ndarray, push: np.ndarray) -> np.ndarray:
    """The moments (s) at which strokes begin, by the total push (n,) at times (n,); none where nobody pushes."""
    if len(time) < 2 or not np.ptp(push):
        return np.empty(0)
    step = float(np.median(np.diff(time)))
    grid = np.arange(time[0], time[-1], max(step, 1e-3))
    width = max(1, round(SMOOTHED / max(step, 1e-3)))
    level = np.convolve(np.interp(grid, time, push), np.ones(width) / width, "same")
    strongest = float(np.quantile(level, 0.98))
    starts: list[float] = []
    pushing = False
    for t, now in zip(grid, level, strict=True):
        if not pushing and now > BEGINS * strongest and (not starts or t - starts[-1] > SHORTEST):
            starts.append(float(t))
            pushing = True
        elif pushing and now < ENDS * strongest:
            pushing = False
    return np.array(starts)


def phase(time: np.ndarray, push: np.ndarray) -> np.ndarray:
    """Where (n,) between the beginnings of two strokes each moment is, from 0 to 1; NaN before the first and where the last
    one is longer ago than strokes usually are apart."""
    starts = begun(time, push)
    if not starts.size:
        return np.full(len(time), np.nan)
    usual = float(np.median(np.diff(starts))) if len(starts) > 1 else USUAL
    latest = np.searchsorted(starts, time, side="right") - 1
    since = time - starts[np.maximum(latest, 0)]
    cycle = np.append(np.minimum(np.diff(starts), 2 * usual), usual)[np.maximum(latest, 0)]
    return np.where((latest >= 0) & (since < cycle), since / cycle, np.nan)
