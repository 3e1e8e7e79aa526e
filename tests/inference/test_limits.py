"""Models that are asked for more than they hold for."""

from __future__ import annotations

import pytest

from wheelchair_fmu.inference.evidence.limits import beyond
from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.model.variant import Variant


@pytest.mark.parametrize("height, runs", [(0.5, []), (4.0, ["coast-down", "straight-strokes"])])
def test_a_wheel_off_the_ground_is_said_of_each_run(sample, height, runs):
    likelihood = ModelFactory(sample, Variant()).likelihood(("longitudinal_load_transfer",))
    said = beyond(likelihood, likelihood.evidence(sample.fit, {"effect.longitudinal_load_transfer.h": height}))
    assert [words.partition(":")[0] for words in said] == runs
    assert all("a wheel has left the ground for " in words for words in said)
