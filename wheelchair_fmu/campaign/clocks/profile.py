"""All lags at once: how well each explains what one device saw by what another saw."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy

from .equation import Equation

OVERLAP = 2.0  # s that two records must share
SHARE = 0.3  # of the shorter record, too


def profile(equations: Sequence[Equation]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """At all lags (m,): the seconds that the records share, and by how much the log likelihood of A's readings is larger with
    B than without, as if each sample stood alone. NaN where they share too little.

    Each equation's residual variance is its own, so n/2 · log of the ratio counts, which a short overlap cannot win by luck.
    """
    lags, seconds, gains = zip(*(_profile_of(e) for e in equations), strict=True)
    return lags[0], np.min(seconds, axis=0), np.sum(gains, axis=0)  # the equations of two devices share both grids


def _profile_of(e: Equation) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    step = float(e.time[1] - e.time[0])
    own_there = np.isfinite(e.target) & np.isfinite(e.own).all(axis=0)
    there = np.logical_and.reduce([np.isfinite(s.value) for s in e.seen])
    a = [np.where(own_there, v, 0.0) for v in (np.ones(len(e.time)), e.target, *e.own)]
    b = [np.where(there, v, 0.0) for v in (np.ones(len(there)), *(s.value for s in e.seen))]

    def along(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return scipy.signal.fftconvolve(x, y[::-1])

    lags = e.time[0] - e.seen[0].start + step * (np.arange(len(a[0]) + len(b[0]) - 1) - (len(b[0]) - 1))
    nj, nk = len(a) - 2, len(b) - 1
    count = np.round(along(a[0], b[0]))
    enough = count >= max(OVERLAP, SHARE * step * min(own_there.sum(), there.sum())) / step
    normal = np.zeros((len(lags), nj + nk, nj + nk))
    right = np.zeros((len(lags), nj + nk))
    for i in range(nj):
        right[:, i] = along(a[2 + i] * a[1], b[0])
        for j in range(i, nj):
            normal[:, i, j] = normal[:, j, i] = along(a[2 + i] * a[2 + j], b[0])
        for k in range(nk):
            normal[:, i, nj + k] = normal[:, nj + k, i] = along(a[2 + i], b[1 + k])
    for k in range(nk):
        right[:, nj + k] = along(a[1], b[1 + k])
        for m in range(k, nk):
            normal[:, nj + k, nj + m] = normal[:, nj + m, nj + k] = along(a[0], b[1 + k] * b[1 + m])
    power = along(a[1] ** 2, b[0])
    without, with_b = (_left(normal[enough, :m, :m], right[enough, :m], power[enough]) for m in (nj, nj + nk))
    floor = 1e-9 * max(power.max(), 1e-300)
    gain = np.full(len(lags), np.nan)
    gain[enough] = 0.5 * count[enough] * np.log((without + floor) / (with_b + floor))
    return lags, count * step, gain


def _left(normal: np.ndarray, right: np.ndarray, power: np.ndarray) -> np.ndarray:
    """Sum of squares (m,) that a regression leaves, from its normal equations (m, k, k) and (m, k)."""
    if normal.shape[1] == 0:
        return np.maximum(power, 0)
    scale = np.sqrt(np.maximum(np.einsum("mii->mi", normal), 1e-300))
    ridge = 1e-9 * np.eye(normal.shape[1])
    solved = np.linalg.solve(normal / scale[:, :, None] / scale[:, None, :] + ridge, (right / scale)[:, :, None])[:, :, 0]
    return np.maximum(power - np.sum(solved * right / scale, axis=1), 0)
