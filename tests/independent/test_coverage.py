"""A short piece of `make bench-diagnosis`: intervals of what was found hold what was hidden."""

from __future__ import annotations

import pytest

from benchmarks.diagnosis.cases import Case
from benchmarks.diagnosis.table import covered_by, named
from benchmarks.diagnosis.trial import trial
from benchmarks.independent.hidden import EFFECTS


@pytest.mark.parametrize("effect", [pytest.param("gyro_bias", marks=pytest.mark.nightly), "wheel_radius_error"])
def test_intervals_hold_what_was_hidden(effect):
    """Profile likelihood and block bootstrap, where both simulators mean the same by a parameter; seed 1 of the benchmark."""
    found = trial(Case("effect", (effect,), 3.0, seed=1), with_baselines=False)

    assert named(found) == {effect}
    for kind in ("profile", "bootstrap"):
        inside = covered_by(found, kind)
        assert inside and all(inside)
        for name in found["hidden"][effect]:
            low, high = found["intervals"][kind][f"effect.{effect}.{name}"]
            assert high - low < EFFECTS[effect].parameters[name].delta  # and say something
