"""When strokes begin, by the recorded pushes, and where between two of them each moment is."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from scipy.interpolate import PchipInterpolator

from .channels import MOMENTUM, PHASE, PHASE_RATE, PUSHES

SMOOTHED = 0.1  # s over which pushes are averaged: a hand that strikes the rim is no stroke of its own
BEGINS, ENDS = 0.25, 0.1  # of the strongest push, at which a stroke begins and is over
SHORTEST = 0.3  # s from one stroke to the next
USUAL = 1.0  # s from one stroke to the next where there is but one
FEWEST = 3  # strokes that have a rhythm,
RHYTHM = 0.2  # if half of the times between them are within this share of the usual one
REST = 2.5  # times as long from one stroke to the next is more than a stroke that was left out


def begun(time: np.ndarray, push: np.ndarray) -> np.ndarray:
    """The moments (s) at which strokes begin, by the total push (n,) at times (n,); none where nobody pushes."""
    if len(time) < 2 or not np.ptp(push):
        return np.empty(0)
    step = float(np.median(np.diff(time)))
    grid = np.arange(time[0], time[-1], max(step, 1e-3))
    width = max(1, round(SMOOTHED / max(step, 1e-3)))
    if width > len(grid):
        return np.empty(0)  # a recording that is over before a stroke is
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


def steady(time: np.ndarray, push: np.ndarray) -> tuple[np.ndarray, np.ndarray] | None:
    """Phase (1) and its rate (Hz), each (n,), of strokes that have a rhythm, by the total push (n,); None of others.

    The phase grows by 1 from the beginning of a stroke to that of the next, along the monotone cubics of Fritsch and Carlson
    (1980), so that the rate has no jumps. A cycle precedes the first stroke and one follows the last; where nobody strokes for
    longer, it stands at whole numbers.
    """
    starts = begun(time, push)
    apart = np.diff(starts)
    if len(starts) < FEWEST:
        return None
    usual = float(np.median(apart))
    if float(np.median(np.abs(apart - usual))) > RHYTHM * usual:
        return None
    at, counted = [starts[0] - 2 * usual, starts[0] - usual], [0.0, 0.0]
    for start, ahead in zip(starts, np.append(apart, np.inf), strict=True):
        at.append(start)
        counted.append(counted[-1] + 1)
        if ahead > REST * usual:  # nobody strokes for a while
            at.append(start + usual)
            counted.append(counted[-1] + 1)
            at.append(start + (ahead if np.isfinite(ahead) else 3 * usual) - usual)
            counted.append(counted[-1])
    phase = PchipInterpolator(at, counted)
    inside = np.clip(time, at[0], at[-1])
    return phase(inside), phase(inside, 1)


def with_strokes(time: np.ndarray, inputs: Mapping[str, np.ndarray], radius: float) -> dict[str, np.ndarray]:
    """The inputs (n,) by name, and the phase of their strokes where they have a rhythm; as they are where somebody says how the
    body moved. `radius` (m) turns axle torques into pushes."""
    found = dict(inputs)
    if PHASE in found:
        found.setdefault(PHASE_RATE, np.gradient(found[PHASE], time))
    elif MOMENTUM not in found:
        forces = [found[name] for name in PUSHES if name in found]
        torques = [found[name] / radius for name in PUSHES.values() if name in found]
        told = steady(time, np.sum([np.zeros(len(time)), *forces, *torques], axis=0))
        found |= {} if told is None else dict(zip((PHASE, PHASE_RATE), told, strict=True))
    return found
