"""Which share of the held-out samples lies in the bands of 95 % about what a diagnosis' last model foretells."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from wheelchair_fmu.inference.decision.diagnosis import Diagnosis
from wheelchair_fmu.inference.estimation.statistics import sandwich
from wheelchair_fmu.inference.evidence.evidence import RunEvidence

NORMAL = 1.96  # standard deviations either side that hold 95 %
Counts = dict[str, tuple[int, int]]  # by channel, how many samples lie in their band, and how many there are


def inside(d: Diagnosis) -> Counts:
    """A band is as wide as noise, with forces that nobody recorded, and doubt of the fitted values have it."""
    found, likelihood = d.top, d.models.likelihood(d.included)

    def foretold(values: Mapping[str, float]) -> tuple[RunEvidence, ...]:
        return likelihood.evidence(d.models.campaign.holdout, values, tune_start=1).runs

    held, covariance, moved = foretold(found.values), sandwich(found), []
    for name, se in zip(found.names, np.sqrt(np.diag(covariance)), strict=True):
        record = likelihood.records[name]
        step = se if found.values[name] + se <= record.upper else -se
        there = foretold({**found.values, name: found.values[name] + step})
        moved.append([(b.predicted - a.predicted) / step for a, b in zip(held, there, strict=True)])
    counts: Counts = {}
    for i, e in enumerate(held):
        for channel, (within, there_are) in _of_run(e, np.stack([m[i] for m in moved], axis=2), covariance).items():
            before = counts.get(channel, (0, 0))
            counts[channel] = before[0] + within, before[1] + there_are
    return counts


def _of_run(e: RunEvidence, slopes: np.ndarray, covariance: np.ndarray) -> Counts:
    """`slopes` (n, nz, k) are by the values whose covariance (k, k) that is."""
    doubt = np.einsum("nzj,jk,nzk->nz", slopes, covariance, slopes)
    half = NORMAL * np.sqrt(1 / e.whitener.spread**2 + doubt)
    off = abs(e.measured - e.predicted)
    there = np.isfinite(off)
    return {c: (int((off <= half)[there[:, z], z].sum()), int(there[:, z].sum())) for z, c in enumerate(e.channels)}
