"""Readings that are none: a slow sensor's, repeated or joined by straight lines until the next one comes.

A 30 Hz camera on a grid of 100 Hz has a new reading in every third or fourth row. What stands between was never measured, and
to take it for measured makes noise of none and certainty of little.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import bdtrc

REPEATED, JOINED = "repeated", "joined by straight lines"
SURE = 1e-6  # how improbable it must be that readings stand still by chance
BENT = 0.05  # of the RMS second difference, below which three readings lie on a straight line
ROUNDED = 2.5  # steps of the converter, as well: rounding bends a line by two
LEVELS = 50  # sizes of bends, below which a coarse converter makes them
LOOSE = 0.25  # share of the usual distance of new readings, or one row, by which one may differ,
REGULAR = 0.8  # and how many may not differ more
FEWEST = 10  # new readings


@dataclass(frozen=True)
class Rule:
    """What moves `leap` steps of its converter and more, in `leaps` of all its changes, does not stand still between two such:
    by noise of that size in `chance` of them at most. A channel where `still` of them do was repeated."""

    leap: float
    leaps: float
    chance: float
    still: float


FINE = Rule(3.5, 1 / 3, 0.1, 0.25)
COARSE = Rule(1.5, 0.1, 0.5, 0.9)  # a coarse converter is seen where nothing is new for several rows
STRAIGHT = Rule(0.0, 0.0, 0.1, 0.25)  # of noise, 4 % lie on a straight line with their neighbours


@dataclass(frozen=True)
class Resampled:
    """How a channel was brought onto its grid: new readings stand in `places`, every `rows` rows on average."""

    how: str
    places: np.ndarray
    rows: float


def resampled(series: np.ndarray) -> Resampled | None:
    """How a channel (n,), which may have gaps, came onto its grid; None where each reading is one."""
    there = np.flatnonzero(np.isfinite(series))
    values = series[there]
    if len(values) <= FEWEST or values.min() == values.max():
        return None
    values = values / np.abs(values).max()
    for how, find in ((REPEATED, _repeated), (JOINED, _joined)):
        new = find(values)
        if new is not None and (rows := _spacing(new)):
            return Resampled(how, there[_filled(new, rows, len(values))], rows)
    return None


def _repeated(values: np.ndarray) -> np.ndarray | None:
    """Where a value is new, if between two leaps it often stands still.

    A coarse converter repeats values, too, but then it moves by single steps; and a chair at rest, but not between leaps.
    """
    new = np.concatenate(([0], np.flatnonzero(np.diff(values)) + 1))
    if len(values) - len(new) < FEWEST or len(levels := np.unique(values)) < FEWEST:
        return None
    moved, rows = np.abs(np.diff(values[new])) / _step(levels), np.diff(new)[1:]
    for rule in (FINE, COARSE):
        leap = moved > rule.leap
        between = leap[:-1] & leap[1:]
        if leap.mean() >= rule.leaps and _still(int((rows[between] > 1).sum()), int(between.sum()), rule):
            return new
    return None


def _joined(values: np.ndarray) -> np.ndarray | None:
    """Where the slope is new, if it often does not change at all from row to row although the channel moves."""
    bend = np.diff(values, 2)
    scale = float(np.sqrt(np.mean(bend**2)))
    bent = np.abs(bend) > max(BENT * scale, ROUNDED * _step(np.unique(values)))
    moving = np.diff(values)[1:] != 0
    if not scale or not _still(int((moving & ~bent).sum()), int(moving.sum()), STRAIGHT):
        return None
    sizes = np.abs(bend[bent]) / scale
    if len(np.unique(np.round(sizes, 6))) < min(LEVELS, len(sizes) / 2):
        return None
    size = np.concatenate(([0.0], np.where(bent, np.abs(bend), 0.0), [0.0]))
    # a knot between two rows bends the line at both, more at the nearer
    knots = np.flatnonzero((size > 0) & (size >= np.roll(size, 1)) & (size > np.roll(size, -1)))
    return np.concatenate(([0], knots))


def _still(still: int, count: int, rule: Rule) -> bool:
    return still >= rule.still * count and float(bdtrc(still - 1, count, rule.chance)) < SURE


def _step(levels: np.ndarray) -> float:
    """The converter's: the smallest difference of two values, of which these are all, sorted; but for rounding."""
    steps = np.diff(levels)
    return float(steps[steps > 1e-9 * (levels[-1] - levels[0])].min())


def _spacing(new: np.ndarray) -> float | None:
    """Rows from one new reading to the next, if that is about the same throughout; longer where two in a row are equal."""
    apart = np.diff(new).astype(float)
    if apart.size < FEWEST:
        return None
    usual = apart[apart <= np.median(apart) + max(1.0, np.median(apart) / 2)]
    rows = float(usual.mean())
    regular = np.abs(apart - rows) <= max(1.0, LOOSE * rows)
    return rows if regular.mean() >= REGULAR and rows > 1 + LOOSE else None


def _filled(new: np.ndarray, rows: float, n: int) -> np.ndarray:
    """And those that must have been there where nothing changed for longer: a chair at rest is measured, too."""
    ends = np.append(new[1:], n)
    more = [
        start + np.arange(0, end - start - 0.5 * rows, rows).round().astype(int) if end - start > 1.5 * rows else [start]
        for start, end in zip(new, ends, strict=True)
    ]
    return np.concatenate(more)
