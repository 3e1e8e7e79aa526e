"""Casters that dry friction of their bearings holds, among forces that nobody recorded."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.labs import CASTERS, drawn, imported
from wheelchair_fmu.campaign import read
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.evidence.noise_model import NoiseModel
from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.models.setting import Setting
from wheelchair_fmu.inference.search.screen import screen
from wheelchair_fmu.model.variant import Variant

from .forces import ridden, wandering

TRAIL, M, RATE = "effect.caster_trail.c", "effect.caster_friction.M", "effect.caster_friction.rate"
WORN = 1  # seed of a lab


def test_friction_is_seen_by_the_likelihood_where_no_slope_tells_of_it(sample):
    """Among forces as strong as a model without it needs, on whose path nothing holds."""
    rng = np.random.default_rng(1)

    def floor(run, without):
        return wandering(rng, run.time, 2.0), wandering(rng, run.time, 0.2)

    few = replace(sample, runs=tuple(r for r in sample.runs if r.name in ("coast-down", "straight-strokes", "random-steps")))
    casters = Variant().with_effects(["caster_trail", "caster_friction"])
    campaign = ridden(few, rng, floor, casters, {TRAIL: 0.05, M: 0.2, RATE: 0.05})
    known = replace(campaign, known={**campaign.known, TRAIL: 0.05})
    noise = NoiseModel(
        known.noise, force=2.0, moment=1.0, tremor=1.0, bumps=2.0, mass=80.0
    )  # as a model without friction needs
    models, base, *_ = Models(ModelFactory(known, Variant()).led(), Setting(noise)).calibrated()
    (found,) = screen(models, base, ["caster_friction"])
    score = found.score
    assert score.likelihood_ratio > 50 and score.p < 1e-3 and score.estimate[0] >= 0.1


@pytest.mark.nightly
def test_casters_of_a_worn_chair_are_named(tmp_path):
    """By somebody else's simulator, of a filmed rider of 118 kg who went straight: what would turn such casters stands in for
    the forces that no floor has, and values that nothing bends are right."""
    lab = drawn(tmp_path / "raw", WORN, worn=True)
    lab = replace(lab, sizes={**lab.sizes, **CASTERS})
    diagnosis = diagnose(read(imported(lab, tmp_path / "chair")))
    hidden, values = lab.answer["hidden"], diagnosis.final.values
    assert diagnosis.verdict == "missing" and diagnosis.effects == ("caster_friction",)
    assert values[M] == pytest.approx(hidden["caster_friction"], rel=0.25)
    assert values["chair.a"] == pytest.approx(hidden["a"], abs=0.02)
    floor = 9.81 * hidden["floor_slope_rms"] * hidden["m"]
    assert diagnosis.unexplained.after.whole == pytest.approx((floor, floor * hidden["b"]), rel=0.5)
