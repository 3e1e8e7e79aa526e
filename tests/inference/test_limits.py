"""Models that are asked for more than they hold for."""

from __future__ import annotations

from dataclasses import replace

import pytest

from wheelchair_fmu.api.comparing import compared
from wheelchair_fmu.inference.evidence.limits import beyond
from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.inference.residual.compare import together
from wheelchair_fmu.model.variant import Variant


@pytest.mark.parametrize("height, runs", [(0.5, []), (4.0, ["coast-down", "straight-strokes"])])
def test_a_wheel_off_the_ground_is_said_of_each_run(sample, height, runs):
    likelihood = ModelFactory(sample, Variant()).likelihood(("longitudinal_load_transfer",))
    said = beyond(likelihood, likelihood.evidence(sample.fit, {"effect.longitudinal_load_transfer.h": height}))
    assert [words.partition(":")[0] for words in said] == runs
    assert all("a wheel has left the ground for " in words for words in said)


def test_a_push_beyond_friction_is_said_with_the_law_that_has_it(sample):
    likelihood = ModelFactory(sample, Variant().with_values({"tyre.mu": 0.05})).likelihood(())
    said = beyond(likelihood, likelihood.evidence(sample.fit, {}))
    assert any(words.startswith("straight-strokes: as fitted, a rear wheel is pushed beyond friction") for words in said)
    assert all(words.endswith('wheel = "spinning" in the [laws] of a variant') for words in said)


def test_a_comparison_says_where_its_model_holds_no_longer(sample):
    """The coast-down and the strokes of the sample under a CM so high that casters lift, each run in its whole length."""
    found = compared(
        sample, Variant().with_values({"effect.longitudinal_load_transfer.h": 2.0, "chair.b": 0.1}), (), lambda words: None
    )
    assert [note.partition(":")[0] for note in found.notes] == ["coast-down", "straight-strokes", "holdout-strokes"]
    assert all(": as simulated, a wheel has left the ground for " in note for note in found.notes)
    (strokes,) = [r for r in found.errors.runs if r.name == "straight-strokes"]
    (share,) = strokes.beyond.values()
    assert f" {share:.1%} of the time" in found.notes[1]
    halves = [replace(strokes, e=strokes.e[:400]), replace(strokes, e=strokes.e[400:], beyond={})]
    assert together("both", halves).beyond == {o: share * 400 / len(strokes.e) for o, share in strokes.beyond.items()}
    assert compared(sample, Variant(), (), lambda words: None).notes == []
