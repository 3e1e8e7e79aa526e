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

    shifts = len(a[0]) + len(b[0]) - 1
    padded = scipy.fft.next_fast_len(shifts, real=True)

    def of_a(*signals: np.ndarray) -> np.ndarray:
        return scipy.fft.rfft(signals, padded)

    def of_b(*signals: np.ndarray) -> np.ndarray:
        return scipy.fft.rfft([y[::-1] for y in signals], padded)

    def along(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """At every shift the sum of products of two signals, from their transforms."""
        return scipy.fft.irfft(x * y, padded)[:shifts]

    lags = e.time[0] - e.seen[0].start + step * (np.arange(shifts) - (len(b[0]) - 1))
    nj, nk = len(a) - 2, len(b) - 1
    (one_a, target, *own), (one_b, *seen) = of_a(*a), of_b(*b)
    count = np.round(along(one_a, one_b))
    enough = count >= max(OVERLAP, SHARE * step * min(own_there.sum(), there.sum())) / step
    normal = np.zeros((shifts, nj + nk, nj + nk))
    right = np.zeros((shifts, nj + nk))
    for i in range(nj):
        told, *squares = of_a(*(a[2 + i] * x for x in a[1:]))
        right[:, i] = along(told, one_b)
        for j in range(i, nj):
            normal[:, i, j] = normal[:, j, i] = along(squares[j], one_b)
        for k in range(nk):
            normal[:, i, nj + k] = normal[:, nj + k, i] = along(own[i], seen[k])
    for k in range(nk):
        right[:, nj + k] = along(target, seen[k])
        for m, square in zip(range(k, nk), of_b(*(b[1 + k] * y for y in b[1 + k :])), strict=True):
            normal[:, nj + k, nj + m] = normal[:, nj + m, nj + k] = along(one_a, square)
    power = along(of_a(a[1] ** 2)[0], one_b)
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
