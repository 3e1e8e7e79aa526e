"""Signals of any rate, with gaps, as smooth functions of time that can be read between samples.

Two sensors see the same motion through different filters and rates. Both are smoothed by the same Gaussian, which is much
wider than either's sampling, so that what is left of each is limited to the same band and shifted by nothing: the kernel is
symmetric, and where it is not (at an end, beside a gap) nothing is read.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

WIDTH = 0.04  # s, standard deviation of the Gaussian: 3 Hz at half power, where the motion of a chair ends
REACH = 3.0  # standard deviations on either side that must be there,
HOLES = 0.5  # of which so much may be missing at most, from one sample to the next, in standard deviations
NODES = 2  # grid points in one standard deviation


@dataclass(frozen=True, eq=False)
class Smooth:
    """A smoothed signal on a grid: at start + i · step (s) its value and slope (n,), NaN where the kernel is not full."""

    start: float
    step: float
    value: np.ndarray
    slope: np.ndarray

    @property
    def time(self) -> np.ndarray:
        return self.start + self.step * np.arange(len(self.value))

    def at(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Value and slope at any times (m,), by the cubic through both ends of a grid interval."""
        place = (np.asarray(time, float) - self.start) / self.step
        last = len(self.value) - 2
        if last < 0:
            return np.full(place.shape, np.nan), np.full(place.shape, np.nan)
        inside = (place >= 0) & (place <= last + 1)
        i = np.clip(np.floor(np.where(inside, place, 0)).astype(int), 0, last)
        s = np.where(inside, place - i, np.nan)
        y0, y1, d0, d1 = self.value[i], self.value[i + 1], self.slope[i] * self.step, self.slope[i + 1] * self.step
        c, d = 3 * (y1 - y0) - 2 * d0 - d1, 2 * (y0 - y1) + d0 + d1
        return y0 + s * (d0 + s * (c + s * d)), (d0 + s * (2 * c + 3 * d * s)) / self.step


def smooth(time: np.ndarray, values: np.ndarray, width: float = WIDTH) -> Smooth:
    """Values (n,) at times (n,) in s, rising, both with NaN where nothing was read, smoothed by a Gaussian of this sd (s).

    At each grid point a straight line is fitted with the kernel as weights (Fan and Gijbels 1996, Local Polynomial
    Modelling); among evenly spaced samples that is the convolution with the kernel, and with its derivative.
    """
    good = np.isfinite(values) & np.isfinite(time)
    t, y = np.asarray(time, float)[good], np.asarray(values, float)[good]
    step = width / NODES
    if len(t) < 3:
        return Smooth(0.0, step, np.empty(0), np.empty(0))
    start = np.floor(t[0] / step) * step
    grid = start + step * np.arange(int((t[-1] - start) / step) + 2)
    ends = np.searchsorted(t, np.array([grid - REACH * width, grid + REACH * width]))
    most = int((ends[1] - ends[0]).max())
    moments = np.zeros((5, len(grid)))  # of weights: 1, τ, τ²; of weighted values: 1, τ
    for k in range(most):
        at = np.minimum(ends[0] + k, len(t) - 1)
        tau = t[at] - grid
        w = np.where(ends[0] + k < ends[1], np.exp(-0.5 * (tau / width) ** 2), 0.0)
        moments += np.stack([w, w * tau, w * tau**2, w * y[at], w * tau * y[at]])
    s0, s1, s2, r0, r1 = moments
    full = _full(t, grid, width) & (ends[1] - ends[0] >= 3)
    with np.errstate(invalid="ignore", divide="ignore"):
        det = s0 * s2 - s1**2
        value = np.where(full, (s2 * r0 - s1 * r1) / det, np.nan)
        slope = np.where(full, (s0 * r1 - s1 * r0) / det, np.nan)
    return Smooth(float(start), step, value, slope)


def _full(t: np.ndarray, grid: np.ndarray, width: float) -> np.ndarray:
    """Where samples lie on both sides of a grid point as far as the kernel reaches, without a hole."""
    usual = float(np.median(np.diff(t)))
    hole = np.flatnonzero(np.diff(t) > max(HOLES * width, 1.5 * usual))
    starts, stops = np.concatenate([[t[0]], t[hole + 1]]), np.concatenate([t[hole], [t[-1]]])
    piece = np.clip(np.searchsorted(starts, grid, side="right") - 1, 0, len(starts) - 1)
    slack = 0.5 * usual
    return (grid - REACH * width >= starts[piece] - slack) & (grid + REACH * width <= stops[piece] + slack)
