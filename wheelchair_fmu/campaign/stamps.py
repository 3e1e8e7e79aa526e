"""Rows of a file in the order of their times, where a logger sent some twice or not quite in turn.

A packet that a radio sends again is written down twice, to the last digit, and one that was overtaken on its way stands behind
a later one. Its stamp is from before it was sent, so that both are harmless. A clock that was set back is not.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

NEIGHBOURS = 1.5  # usual steps: a row that changed places with its neighbour is behind by one


@dataclass(frozen=True)
class Stamps:
    """`rows` (m,) of a file that have a time, in its order; `copies` are rows left out, as the row before them says all that
    they say, and `overtaken` those put before a later one, by `by` seconds at most."""

    rows: np.ndarray
    copies: np.ndarray
    overtaken: np.ndarray
    by: float = 0.0


def stamps(time: np.ndarray, columns: Iterable[np.ndarray]) -> Stamps:
    """Of times (n,) in s, NaN where there is none, and the columns (n,) that are read. If any row is behind by more than its
    neighbour, all stay where they are: that is a fault, and not the network's doing."""
    rows = np.flatnonzero(np.isfinite(time))
    behind = _behind(time[rows])
    most = float(behind.max(initial=0.0))
    steps = np.diff(time[rows])
    usual = float(np.median(steps[steps > 0])) if (steps > 0).any() else 0.0
    overtaken = rows[behind > 0] if most < NEIGHBOURS * usual else rows[:0]
    if overtaken.size:
        rows = rows[np.argsort(time[rows], kind="stable")]
    same = np.diff(time[rows]) == 0
    for column in columns if same.any() else ():
        before, after = column[rows[:-1]], column[rows[1:]]
        same &= (before == after) | np.isnan(before) & np.isnan(after)
    copied = np.concatenate(([False], same)) if rows.size else np.empty(0, bool)
    return Stamps(rows[~copied], np.sort(rows[copied]), overtaken, most if overtaken.size else 0.0)


def _behind(time: np.ndarray) -> np.ndarray:
    """By how many seconds each row is earlier than some row before it (n,)."""
    return np.maximum.accumulate(time) - time if time.size else time
