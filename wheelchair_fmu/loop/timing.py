"""Runs whose pushes and readings do not belong to the same time.

A logger that was started by hand is a second early or late. No effect of a chair does that, but a search finds one that
seems to; so such a run is found before the search, by reading its pushes earlier and later.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ..errors import SimulationError
from .evidence import Bench, Evidence, RunEvidence

SHIFTS = np.arange(0.2, 2.05, 0.1)  # s, each way; less is what a delay of the force record is for
SUSPECT = 2.0  # RMS innovation below which nobody looks
EXPLAINED = 0.25  # share of the mean square innovation that may remain


def late(bench: Bench, evidence: Evidence, values: Mapping[str, float]) -> dict[str, float]:
    """By how much (s) the pushes were recorded early, for each run where reading them later explains most of its error."""
    found = {}
    for e in evidence.runs:
        if float(np.nanmean(e.r**2)) < SUSPECT**2:
            continue
        left = {t: _left(bench, e, values, t) for t in (*-SHIFTS, *SHIFTS)}
        best = min(left, key=lambda t: left[t])
        if left[best] < EXPLAINED and abs(best) > SHIFTS[0]:  # at the smallest, less might do as well
            found[e.run.name] = round(float(best), 1)
    return found


def _left(bench: Bench, e: RunEvidence, values: Mapping[str, float], seconds: float) -> float:
    """Share of the squared innovations that is left with the pushes read `seconds` later than they are recorded.

    What is missing at either end is not counted, nor is what another start of the run could do.
    """
    t = e.run.time
    moved = replace(e.run, inputs={name: np.interp(t - seconds, t, push) for name, push in e.run.inputs.items()})
    try:
        again = bench.again(Evidence((replace(e, run=moved),), ()), values).runs[0]
    except SimulationError:
        return float("inf")
    inside = (t >= t[0] + abs(seconds)) & (t <= t[-1] - abs(seconds))
    counted = inside[:, None] & np.isfinite(e.r)
    if not counted.any():
        return float("inf")
    start = e.start_S[counted]
    before, after = (r[counted] - start @ np.linalg.lstsq(start, r[counted], rcond=None)[0] for r in (e.r, again.r))
    return float(after @ after / (before @ before))
