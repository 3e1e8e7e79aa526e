"""Runs whose pushes and readings do not belong to the same time.

A logger that was started by hand is a second early or late. No effect of a chair does that, but a search finds one that
seems to; so such a run is found before the search, by reading its pushes earlier and later.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np

from ..errors import SimulationError
from .evidence import Bench, Evidence, RunEvidence
from .score import projector

SHIFTS = np.arange(0.2, 2.05, 0.2)  # s, each way; less is what a delay of the force record is for
FINER = 0.1  # s, either side of the best of these
SUSPECT = 2.0  # RMS innovation below which nobody looks
EXPLAINED = 0.25  # share of the mean square innovation that may remain,
HOPEFUL = 0.6  # or so near it


def late(bench: Bench, evidence: Evidence, values: Mapping[str, float]) -> dict[str, float]:
    """By how much (s) the pushes were recorded early, for each run where reading them later explains most of its error."""
    found = {}
    for e in evidence.runs:
        if float(np.nanmean(e.r**2)) < SUSPECT**2:
            continue
        left = _left(bench, e, values, [*-SHIFTS, *SHIFTS])
        best = min(left, key=lambda t: left[t])
        if left[best] < HOPEFUL:
            finer = (best + side for side in (-FINER, FINER) if abs(best + side) > SHIFTS[0])
            left |= _left(bench, e, values, finer)
            best = min(left, key=lambda t: left[t])
        if left[best] < EXPLAINED and abs(best) > SHIFTS[0]:  # at the smallest, less might do as well
            found[e.run.name] = round(float(best), 1)
    return found


def _left(bench: Bench, e: RunEvidence, values: Mapping[str, float], later: Iterable[float]) -> dict[float, float]:
    """By how many seconds `later` than recorded the pushes are read, the share of the squared innovations that is left."""
    shifts = [float(t) for t in later]
    moved = [_moved(e, seconds) for seconds in shifts]
    try:
        again = bench.again(Evidence(tuple(moved), ()), values).runs  # all at once, on all cores
    except SimulationError:
        again = tuple(_alone(bench, m, values) for m in moved)
    return {t: _share(e, a, t) if a else float("inf") for t, a in zip(shifts, again, strict=True)}


def _moved(e: RunEvidence, seconds: float) -> RunEvidence:
    t = e.run.time
    return replace(e, run=replace(e.run, inputs={name: np.interp(t - seconds, t, push) for name, push in e.run.inputs.items()}))


def _alone(bench: Bench, e: RunEvidence, values: Mapping[str, float]) -> RunEvidence | None:
    try:
        return bench.again(Evidence((e,), ()), values).runs[0]
    except SimulationError:
        return None


def _share(e: RunEvidence, again: RunEvidence, seconds: float) -> float:
    """What is missing at either end is not counted, nor is what another start of the run could do."""
    t = e.run.time
    inside = (t >= t[0] + abs(seconds)) & (t <= t[-1] - abs(seconds))
    counted = inside[:, None] & np.isfinite(e.r)
    if not counted.any():
        return float("inf")
    start = e.start_S[counted]
    off = projector(start, np.zeros((start.shape[1], start.shape[1])))
    before, after = (off(r[counted]) for r in (e.r, again.r))
    return float(after @ after / (before @ before))
