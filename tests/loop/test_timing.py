"""A run whose pushes were recorded early or late is found, named and left out; one that is right is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from wheelchair_fmu.loop.diagnose import Search, begin
from wheelchair_fmu.loop.timing import late
from wheelchair_fmu.loop.workshop import Workshop
from wheelchair_fmu.model.variant import Variant


def shifted(run, seconds):
    """The run with its pushes recorded `seconds` early."""
    return replace(run, inputs={n: np.interp(run.time + seconds, run.time, w) for n, w in run.inputs.items()})


@pytest.mark.parametrize(("which", "seconds"), [("fit", 1.0), ("fit", -0.7), ("holdout", 1.0)])
def test_a_shifted_run_is_left_out(sample, which, seconds):
    wrong = getattr(sample, which)[-1]
    campaign = replace(sample, runs=tuple(shifted(r, seconds) if r is wrong else r for r in sample.runs))
    search = Search(Workshop(campaign, Variant()))
    begin(search, lambda words: None)
    side = "early" if seconds > 0 else "late"
    assert [n for n in search.notes if n.startswith(f"{wrong.name}: ") and f"{abs(seconds)} s too {side}" in n]
    assert [r.name for r in search.workshop.campaign.runs] == [r.name for r in sample.runs if r is not wrong]


def test_a_missing_effect_is_not_taken_for_a_shift(sample):
    bench = Workshop(sample, Variant()).bench()
    evidence = bench.evidence(sample.runs, {}, ())
    assert max(e.rms["yaw_rate"] for e in evidence.runs) > 3  # there is something to explain
    assert late(bench, evidence, {}) == {}
