"""The lag to a small part of a sample, by Gauss and Newton from a lag that is near, with what it is worth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit

from .equation import Equation
from .scatter import long_run
from .smoothing import NODES

ROUNDS = 40
CLOSE = 1e-6  # s
LINEAR = 2  # coefficients that take part of the scores away, at least
NORMAL = 1.96  # half width of 95 % in standard deviations
TOGETHER = 4  # widths of the smoothing Gaussian
FARTHEST = 5.0  # grid steps from where it began


@dataclass(frozen=True, eq=False)
class Part:
    """One equation at one lag: residuals (n,), how what is explained moves with the lag, and how the target itself moves (both
    after the linear coefficients), NaN in gaps; the gains; sums of squares with B and without."""

    time: np.ndarray
    rest: np.ndarray
    moved: np.ndarray
    target_moved: np.ndarray
    gains: np.ndarray
    rest_power: float
    power: float


@dataclass(frozen=True, eq=False)
class Fine:
    """Lag s + drift · (t − middle) with standard errors (s, and s/s), where the two do not hang together at `middle` (s)."""

    seconds: float
    se: float
    drift: float
    drift_se: float
    middle: float
    parts: tuple[Part, ...]
    weights: tuple[float, ...]


def refine(equations: Sequence[Equation], start: float, step: float, drifting: Fine | None = None) -> Fine | None:
    """From a lag `start` that is right to about a grid `step` (s) to the least of Σ residuals² / variance; with `drifting`, a
    fit without drift, from there with one."""
    middle = drifting.middle if drifting else 0.0
    at = np.array([start, 0.0]) if drifting else np.array([start])
    before = np.inf
    for _ in range(ROUNDS):
        parts = [p for e in equations if (p := _part(e, at, middle)) is not None]
        weights = [np.isfinite(p.rest).sum() / max(p.rest_power, 1e-300) for p in parts]
        change = _change(parts, weights, len(at), middle)
        if change is None:
            return None
        change[0] = np.clip(change[0], -step, step)
        if abs(change[0]) >= 0.9 * before:
            change *= 0.5
        at, before = at + change, abs(change[0])
        if np.abs(change[0]) < CLOSE:
            break
        if abs(at[0] - start) > FARTHEST * step:
            return None
    return _judged(at, parts, weights)


def left(e: Equation, lag: float) -> float:
    """Mean square that an equation leaves at a lag (s), infinite where nothing can be read there."""
    part = _part(e, np.array([lag]), 0.0)
    return part.rest_power / float(np.isfinite(part.rest).sum()) if part else np.inf


def _change(parts: Sequence[Part], weights: Sequence[float], size: int, middle: float) -> np.ndarray | None:
    normal, right = np.zeros((size, size)), np.zeros(size)
    for p, w in zip(parts, weights, strict=True):
        moved = np.nan_to_num(p.moved) * np.stack([np.ones(len(p.time)), p.time - middle])[:size]
        normal += w * moved @ moved.T
        right += w * moved @ np.nan_to_num(p.rest)
    if not parts or not normal[0, 0]:
        return None
    return np.linalg.lstsq(normal, right, rcond=None)[0]


def _part(e: Equation, at: np.ndarray, middle: float) -> Part | None:
    lag = at[0] + (at[1] * (e.time - middle) if len(at) > 1 else 0.0)
    read = [smooth.at(e.time - lag) for smooth in e.seen]
    seen, speeds = np.array([r[0] for r in read]), np.array([r[1] for r in read])
    linear = np.concatenate([e.own, seen])
    there = np.isfinite(linear).all(axis=0) & np.isfinite(e.target) & np.isfinite(e.slope)
    if there.sum() <= len(linear) + 2:
        return None
    basis, y = linear[:, there].T, e.target[there]
    found = np.linalg.lstsq(basis, y, rcond=1e-9)[0]
    rest, gains = y - basis @ found, found[len(e.own) :]
    both = np.stack([-gains @ speeds[:, there], -e.slope[there]], axis=1)
    both -= basis @ np.linalg.lstsq(basis, both, rcond=1e-9)[0]
    own = basis[:, : len(e.own)]
    power = y - own @ np.linalg.lstsq(own, y, rcond=1e-9)[0] if len(e.own) else y
    full = np.full((3, len(e.time)), np.nan)
    full[:, there] = rest, both[:, 0], both[:, 1]
    return Part(e.time, full[0], full[1], full[2], gains, float(rest @ rest), float(power @ power))


def _judged(at: np.ndarray, parts: Sequence[Part], weights: Sequence[float]) -> Fine | None:
    """Standard errors from the scores, which hang together over time. How sharply the lag shows is taken from the target's
    slope times what is explained of it: the noise of B, which makes its own slope look larger, is not in both."""
    time = parts[0].time
    score, sharp = np.zeros(len(time)), np.zeros(len(time))
    for p, w in zip(parts, weights, strict=True):
        score += w * np.nan_to_num(p.rest * p.moved)
        sharp += w * np.nan_to_num(p.target_moved * p.moved)
    total = float(sharp.sum())
    if total <= 0:
        return None
    used = np.any([np.isfinite(p.rest) for p in parts], axis=0)
    middle = float((sharp * time).sum() / total)
    away = time - middle
    spread = float((sharp * away**2).sum())
    se = _se(score[used], total)
    drift_se = _se((score * away)[used], spread) if spread > 0 else np.inf
    drift = float(at[1]) if len(at) > 1 else 0.0
    return Fine(float(at[0]), se, drift, drift_se, middle, tuple(parts), tuple(weights))


def _se(scores: np.ndarray, sharpness: float) -> float:
    """Scores are summed over as long as the smoothing makes neighbours hang together, and what hangs together beyond that is
    for the sums to show. Where few of them count (three strokes in a minute), Student's t has as many degrees of freedom: the
    variance of independent sums by Satterthwaite (1946), a normal one's fourth moment being three."""
    sums = np.add.reduceat(scores, np.arange(0, len(scores), TOGETHER * NODES))
    variance, wider = long_run(sums, whitened=False)
    fourth = float(np.sum(sums**4))
    freedom = max(3 * float(sums @ sums) ** 2 / fourth - LINEAR, 1.0) if fourth else 1.0
    return wider * float(stdtrit(freedom, 0.975) / NORMAL) * float(np.sqrt(variance)) / sharpness
