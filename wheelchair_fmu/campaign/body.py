"""Motion of the rider's body against the frame: from markers by a table of segments, and from a position its momentum.

The momentum is what the chair feels, m_s s' of a mass m_s at s; a position is smoothed as it is differentiated. Of markers, s
is how far the CM of the whole person has moved, Σ share · s over the segments, each share of the person's mass.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from .channels import FORCE, MOMENTUM, POSITION
from .clocks.smoothing import smooth
from .swinging import swing

SIDES = ("l", "r")
MARKERS = (  # of the body, as `markers` may name them
    "head",
    "c7",
    "sternum",
    *(f"{place}_{side}" for place in ("shoulder", "elbow", "wrist", "hand", "hip") for side in SIDES),
)
TRUNKS = frozenset({"shoulder_l", "shoulder_r", "c7", "sternum"})  # one of them tells where the trunk is
# Shares of a person's mass, and where a segment's CM lies between its ends, from the upper one: de Leva 1996, table 4, the
# means of men and women. The trunk's upper end is the shoulders' middle, else the seventh cervical vertebra, else the sternum.
TRUNK, HEAD, UPPER_ARM, FOREARM, HAND = 0.430, 0.068, 0.0263, 0.0150, 0.00585
TRUNK_CM = {"shoulder": 0.405, "c7": 0.505, "sternum": 0.432}
UPPER_ARM_CM, FOREARM_CM = 0.576, 0.457
WIDTH = 0.02  # s, standard deviation of the Gaussian by whose reach readings count as neighbours of a gap
HIDDEN = 0.3  # s for which a marker may be hidden: a body moves on smoothly for so long
STILL = 0.3  # s at the start by which positions are counted from where the body was
MISSED = 0.1  # share of its momentum that a few markers miss of a body, besides their noise

Path = np.ndarray


@dataclass(frozen=True)
class Body:
    """Position (m), momentum (N s) and its rate (N) of the body against the frame, each (n,), NaN where it was not seen, and
    the standard deviation of the momentum."""

    series: Mapping[str, np.ndarray]
    noise: float


def position(time: np.ndarray, ahead: Mapping[str, np.ndarray]) -> np.ndarray:
    """How far (n,) the CM of the whole person has moved forward, from how far each marker lies ahead of the axle (n,)."""
    moved = _one_by_the_other(time, {name: _from_rest(time, _filled(time, path)) for name, path in ahead.items()})
    upper, middle = _trunk(moved)
    if upper is None:
        return np.full(len(time), np.nan)
    hips = _mean([moved[f"hip_{side}"] for side in SIDES if f"hip_{side}" in moved])
    hips = np.zeros(len(time)) if hips is None else hips
    total = TRUNK * (middle * hips + (1 - middle) * upper) + HEAD * moved.get("head", upper)
    for side in SIDES:
        total = total + _arm(moved, side, upper)
    return total


def _trunk(moved: Mapping[str, Path]) -> tuple[Path | None, float]:
    """The way of the trunk's upper end, and how far from it its CM lies towards the hips."""
    shoulders = _mean([moved[f"shoulder_{side}"] for side in SIDES if f"shoulder_{side}" in moved])
    if shoulders is not None:
        return shoulders, TRUNK_CM["shoulder"]
    name = next((n for n in ("c7", "sternum") if n in moved), "")
    return (moved[name], TRUNK_CM[name]) if name else (None, 0.0)


def _arm(moved: Mapping[str, Path], side: str, upper: Path) -> Path:
    """What an arm adds; what does not show of it moves with what it hangs on."""
    shoulder = moved.get(f"shoulder_{side}", upper)
    elbow = moved.get(f"elbow_{side}", shoulder)
    wrist = moved.get(f"wrist_{side}", moved.get(f"hand_{side}", elbow))
    hand = moved.get(f"hand_{side}", wrist)
    upper_arm = (1 - UPPER_ARM_CM) * shoulder + UPPER_ARM_CM * elbow
    forearm = (1 - FOREARM_CM) * elbow + FOREARM_CM * wrist
    return UPPER_ARM * upper_arm + FOREARM * forearm + HAND * hand


def _one_by_the_other(time: np.ndarray, moved: Mapping[str, Path]) -> dict[str, Path]:
    """Where one of two shoulders, or hips, is hidden, it moves as the other one does."""
    found = dict(moved)
    for place in ("shoulder", "hip"):
        names = [f"{place}_{side}" for side in SIDES]
        if all(name in moved for name in names):
            found |= dict(zip(names, by_each_other(time, *(moved[name] for name in names)), strict=True))
    return found


def by_each_other(time: np.ndarray, one: Path, other: Path) -> tuple[Path, Path]:
    """Two paths (n,) whose distance changes slowly, each also where only the other was seen."""
    apart = other - one
    there = np.isfinite(apart)
    if not there.any():
        return one, other
    apart = np.interp(time, time[there], apart[there])
    return np.where(np.isfinite(one), one, other - apart), np.where(np.isfinite(other), other, one + apart)


def _mean(paths: list[Path]) -> Path | None:
    """Of those that are seen; None where there are none."""
    if not paths:
        return None
    seen = np.isfinite(paths)
    count = seen.sum(axis=0)
    return np.where(count > 0, np.where(seen, paths, 0.0).sum(axis=0) / np.maximum(count, 1), np.nan)


def _from_rest(time: np.ndarray, path: Path) -> Path:
    """Less where it was at first."""
    there = np.flatnonzero(np.isfinite(path))
    if not there.size:
        return path
    first = there[time[there] <= time[there[0]] + STILL]
    return path - float(np.median(path[first]))


def _filled(time: np.ndarray, path: Path) -> Path:
    """With the short times for which it was hidden as the cubic through both ends and their slopes has it."""
    there = np.isfinite(path)
    if there.sum() < 4:
        return path
    s = smooth(time[there], path[there], WIDTH)
    edges = np.diff(np.concatenate(([0], (~there).astype(int), [0])))
    out = path.copy()
    for start, stop in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True):
        if start == 0 or stop == len(path) or time[stop] - time[start - 1] > HIDDEN:
            continue
        ends = time[[start - 1, stop]] + 4 * WIDTH * np.array([-1.0, 1.0])
        value, slope = s.at(ends)
        straight = np.interp(time[start:stop], time[[start - 1, stop]], path[[start - 1, stop]])
        cubic = _hermite(time[start:stop], ends, value, slope)
        out[start:stop] = np.where(np.isfinite(cubic), cubic, straight)
    return out


def _hermite(time: np.ndarray, ends: np.ndarray, value: np.ndarray, slope: np.ndarray) -> np.ndarray:
    h = ends[1] - ends[0]
    s = (time - ends[0]) / h
    rise = value[1] - value[0]
    c, d = 3 * rise - h * (2 * slope[0] + slope[1]), h * (slope[0] + slope[1]) - 2 * rise
    return np.asarray(value[0] + s * (h * slope[0] + s * (c + s * d)))


def of_position(time: np.ndarray, s: np.ndarray, mass: float) -> Body:
    """What a mass (kg) at `s` (n,) does; nothing about a gap."""
    found, seen = swing(time, s), np.isfinite(smooth(time, s, WIDTH).at(time)[0])
    if found is None:
        return Body(dict.fromkeys((POSITION, MOMENTUM, FORCE), np.full(len(time), np.nan)), 0.0)
    value, momentum, force = (np.where(seen, v, np.nan) for v in (found.value, mass * found.slope, mass * found.bend))
    return Body(
        {POSITION: value, MOMENTUM: momentum, FORCE: force}, float(np.hypot(mass * found.noise, MISSED * _rms(momentum)))
    )


def rate(time: np.ndarray, momentum: np.ndarray) -> np.ndarray:
    """How fast a momentum (n,) changes, smoothed as a position is."""
    found = swing(time, momentum)
    return np.zeros(len(time)) if found is None else np.where(np.isfinite(momentum), found.slope, np.nan)


def _rms(values: np.ndarray) -> float:
    there = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(there**2))) if there.size else 0.0


def stretch(time: np.ndarray, series: np.ndarray, bridged: float) -> tuple[float, float]:
    """From when to when (s) a series (n,) has no gap that is longer than `bridged`: the longest such time."""
    there = time[np.isfinite(series)]
    if not there.size:
        return np.inf, -np.inf
    breaks = np.flatnonzero(np.diff(there) > bridged)
    starts, stops = np.concatenate([[0], breaks + 1]), np.concatenate([breaks, [len(there) - 1]])
    longest = int(np.argmax(there[stops] - there[starts]))
    return float(there[starts[longest]]), float(there[stops[longest]])
