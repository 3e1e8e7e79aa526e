"""What an instrumented push rim shows when nobody touches it: a baseline, and a ripple once per turn of the wheel.

    recorded torque = true torque + baseline + ripple · sin(wheel angle + phase)

Both are found where no hand is on the rim: at a standstill before the first push, between pushes, when coasting. The signal
says where that is: hands make it leave the band of its own noise, a ripple does not. The baseline belongs to one run; the
ripple is the instrument's, and several runs can share it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .clocks.scatter import long_run

BLOCK = 0.1  # s over which the torque is averaged to see whether a hand is on the rim
WIDE = 4.0  # N m within which readings belong to the baseline at first, pushes being larger; it closes in
CLOSING = 0.8  # times each round, down to
CALM = 4.0  # standard deviations of a block's mean
ROUNDS = 40
ENOUGH = 1.0  # s hands off, and
SURE = 0.2  # N m to which a baseline must be known, a push having ten or more
SECTORS, TURNED = 12, 6  # of so many sectors of a turn so many must have been seen for a ripple


@dataclass(frozen=True, eq=False)
class Baseline:
    """`offset` (N m) of one run, and `ripple_sin`, `ripple_cos` (N m), so that recorded = true + offset + ripple_sin · sin θ +
    ripple_cos · cos θ; `covariance` (3, 3) of these three, zero for a ripple that was not looked for. `share_hands_off` of the
    run's samples were used. Where not `enough`, `why` says what is missing and the numbers are not to be used."""

    offset: float
    ripple_sin: float
    ripple_cos: float
    covariance: np.ndarray
    share_hands_off: float
    enough: bool
    why: str

    @property
    def offset_se(self) -> float:
        return float(np.sqrt(self.covariance[0, 0]))

    @property
    def ripple(self) -> float:
        """Amplitude, N m."""
        return float(np.hypot(self.ripple_sin, self.ripple_cos))

    @property
    def phase(self) -> float:
        """In ripple · sin(θ + phase), rad."""
        return float(np.arctan2(self.ripple_cos, self.ripple_sin))

    @property
    def ripple_se(self) -> float:
        along = np.array([np.cos(self.phase), np.sin(self.phase)])
        return float(np.sqrt(along @ self.covariance[1:, 1:] @ along))


Recording = tuple[np.ndarray, np.ndarray, np.ndarray | None]  # time (s), torque (N m), wheel angle (rad) or None, (n,) each


def baseline(time: np.ndarray, torque: np.ndarray, angle: np.ndarray | None = None) -> Baseline:
    """Of one run: torque (n,) in N m at times (n,) in s, NaN in gaps; with the wheel's angle (n,) in rad, from any zero, the
    ripple too."""
    return baselines({"": (time, torque, angle)})[""]


def corrected(torque: np.ndarray, angle: np.ndarray | None, found: Baseline) -> np.ndarray:
    """Torque (n,) without the baseline and the ripple."""
    ripple = 0.0 if angle is None else found.ripple_sin * np.sin(angle) + found.ripple_cos * np.cos(angle)
    return torque - found.offset - ripple


def baselines(runs: Mapping[str, Recording]) -> dict[str, Baseline]:
    """Of all runs of one wheel: an offset for each, and one ripple for those that recorded an angle, which must count from the
    same place on the wheel in all of them."""
    turning = {name: r for name, r in runs.items() if r[2] is not None}
    found = _together(turning) if turning else {}
    for name, r in runs.items():
        if name not in turning:
            found |= _together({name: r})
    return {name: found[name] for name in runs}


@dataclass(frozen=True, eq=False)
class _Pool:
    """All finite samples of some runs: which run, which block, torque, and [one column for each run, sin θ, cos θ]."""

    names: tuple[str, ...]
    run: np.ndarray
    block: np.ndarray
    torque: np.ndarray
    design: np.ndarray
    interval: np.ndarray  # s, of each run

    def means(self, values: np.ndarray) -> np.ndarray:
        """Mean of each block."""
        return np.bincount(self.block, values) / np.bincount(self.block)


def _pool(runs: Mapping[str, Recording]) -> _Pool:
    parts, first = [], 0
    for i, (time, torque, angle) in enumerate(runs.values()):
        good = np.isfinite(torque) & (np.isfinite(angle) if angle is not None else True)
        t, theta = time[good], angle[good] if angle is not None else None
        block = first + np.unique(np.floor((t - t[:1]) / BLOCK), return_inverse=True)[1] if t.size else np.empty(0, int)
        first = int(block.max()) + 1 if block.size else first
        wave = np.zeros((t.size, 2)) if theta is None else np.stack([np.sin(theta), np.cos(theta)], axis=1)
        mine = np.zeros((t.size, len(runs)))
        mine[:, i] = 1.0
        parts.append((np.full(t.size, i), block, torque[good], np.hstack([mine, wave])))
    interval = np.array([float(np.median(np.diff(time))) for time, _, _ in runs.values()])
    run, block, torque, design = (np.concatenate(p) for p in zip(*parts, strict=True))
    return _Pool(tuple(runs), run, block, torque, design, interval)


def _together(runs: Mapping[str, Recording]) -> dict[str, Baseline]:
    pool = _pool(runs)
    off = _hands_off(pool)
    columns = _columns(pool, off)
    found, rest = _fit(pool, off, columns)
    normal = pool.design[off][:, columns]
    spread = _spread(rest, normal.shape[1])
    covariance = np.zeros((pool.design.shape[1],) * 2)
    if np.isfinite(spread):
        covariance[np.ix_(columns, columns)] = spread * np.linalg.pinv(normal.T @ normal)
    else:
        np.fill_diagonal(covariance, np.inf)
    return {name: _baseline(pool, i, off, found, covariance) for i, name in enumerate(pool.names)}


def _spread(rest: np.ndarray, unknowns: int) -> float:
    """Variance of one residual times the number of residuals (m,) that count as one, for the least squares' covariance."""
    if len(rest) < unknowns + 4:
        return np.inf
    if not rest.any():
        return 0.0  # a wheel that reports nothing below a threshold, or a column of zeros for one that measures nothing
    variance, wider = long_run(rest)
    independent = len(rest) * float(rest @ rest) / variance
    return variance / len(rest) * wider**2 * independent / max(independent - unknowns, 1.0)


def _baseline(pool: _Pool, i: int, off: np.ndarray, found: np.ndarray, covariance: np.ndarray) -> Baseline:
    own, n = pool.run == i, len(pool.names)
    seconds = float((own & off).sum() * pool.interval[i])
    share = float((own & off).sum() / max(own.sum(), 1))
    at = [i, n, n + 1]
    se = float(np.sqrt(covariance[i, i]))
    cure = "let the chair stand, hands in the lap, before the first push"
    why = ""
    if seconds < ENOUGH:
        why = f"only {seconds:.1f} s are without a hand on the rim, and {ENOUGH:g} s are needed: {cure}"
    elif not se < SURE:
        why = f"no stretch is plainly without a hand on the rim (the baseline would be known to {se:.2g} N m): {cure}"
    offset, sine, cosine = (float(found[j]) for j in at)
    return Baseline(offset, sine, cosine, covariance[np.ix_(at, at)], share, not why, why)


def _hands_off(pool: _Pool) -> np.ndarray:
    """Which samples (n,) were recorded without a hand on the rim.

    A band about baseline and ripple closes in on the samples in it, from one that is wider than any ripple to one that blocks
    of mere noise do not leave. What a hand begins or ends in is not counted, either.
    """
    calm, width = _first(pool), WIDE
    for _ in range(ROUNDS):
        found, _ = _fit(pool, calm, _columns(pool, calm))
        away = np.abs(pool.means(pool.torque - pool.design @ found))
        scatter = 1.4826 * float(np.median(away[away < width])) if (away < width).any() else 0.0
        least = CALM * scatter
        width = max(CLOSING * width, least)
        calm = (away < width)[pool.block]
        if width <= least:
            break
    touched = ~(away < width)
    beside = touched.copy()
    beside[1:] |= touched[:-1]
    beside[:-1] |= touched[1:]
    return ~beside[pool.block]


def _first(pool: _Pool) -> np.ndarray:
    """In each run the samples near the level at which its blocks crowd most."""
    means, run = pool.means(pool.torque), pool.means(pool.run).round().astype(int)
    near = np.zeros(len(means), bool)
    for i in range(len(pool.names)):
        own = means[run == i]
        if own.size:
            crowd = (np.abs(own[:, None] - own[None, :]) < WIDE / 2).sum(axis=1)
            level = float(np.median(own[crowd == crowd.max()]))
            near |= (run == i) & (np.abs(means - level) < WIDE / 2)
    return near[pool.block]


def _columns(pool: _Pool, off: np.ndarray) -> np.ndarray:
    """The unknowns that these samples tell: offsets, and a ripple where the wheel turned."""
    wave = pool.design[off][:, -2:]
    moved = wave[np.any(wave != 0, axis=1)]
    sectors = np.unique(np.floor(np.arctan2(moved[:, 0], moved[:, 1]) / (2 * np.pi) * SECTORS))
    n = len(pool.names)
    there = [i for i in range(n) if (pool.run[off] == i).any()]
    return np.array(there + ([n, n + 1] if len(sectors) >= TURNED else []), int)


def _fit(pool: _Pool, off: np.ndarray, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """All unknowns, those that are not told being zero, and what is left (m,) of the samples used."""
    found = np.zeros(pool.design.shape[1])
    used = pool.design[off][:, columns]
    if used.size:
        found[columns] = np.linalg.lstsq(used, pool.torque[off], rcond=None)[0]
    return found, pool.torque[off] - pool.design[off] @ found
