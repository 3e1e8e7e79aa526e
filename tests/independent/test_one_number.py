"""One model has one error, whichever command it comes from: a search, `add` and `compare` judge it by the same noise."""

from __future__ import annotations

from dataclasses import replace

import pytest

from benchmarks.independent.campaigns import make
from benchmarks.independent.hidden import usual
from wheelchair_fmu.api.comparing import compared
from wheelchair_fmu.campaign import condensed, read
from wheelchair_fmu.inference.decision.improve import add, after
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.noise_model import NoiseModel
from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.search.beginning import begin
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant


@pytest.mark.nightly
def test_what_a_search_puts_in_has_the_errors_that_add_and_compare_say(tmp_path):
    """A trunk that moves leaves the pushes' noise smaller than without it. `compare` simulates with the FMU, to 1e-4."""
    campaign = read(make(tmp_path / "campaign", {"trunk_motion": usual("trunk_motion", 3.0)}, seed=5))
    chair = Variant(catalogue={effect: bundled()[effect] for effect in ("trunk_motion", "gyro_bias")})
    found = diagnose(campaign, chair)
    assert found.included == ("trunk_motion",) and found.models.setting.noise_model.differs(NoiseModel(campaign.noise))
    for here, there in zip(found.ladder, add(campaign, chair, ["trunk_motion"]).ladder, strict=True):
        assert (here.name, here.fit, here.heldout) == (there.name, pytest.approx(there.fit), pytest.approx(there.heldout))
    better = compared(campaign, after(found, chair, campaign), (), lambda words: None)
    by_what_was_stated = Likelihood(campaign, chair.with_effects(found.included))
    stated = by_what_was_stated.evidence(campaign.fit, found.final.values, tune_start=2)
    assert better.errors.rms("fit") == pytest.approx(found.ladder[-1].fit, abs=0.003)
    assert better.errors.rms("holdout") == pytest.approx(found.ladder[-1].heldout, abs=0.003)
    assert abs(stated.rms - found.ladder[-1].fit) > 0.03, "the noise that was stated makes a difference here"


def test_a_chair_as_given_has_the_error_that_compare_says_where_a_sensor_has_an_offset(tmp_path):
    """An offset is nobody's error, before calibration as after it, and a run starts where its readings want it."""
    told = read(make(tmp_path / "campaign", {}, seed=5))
    runs = (replace(r, channels={**r.channels, "yaw_rate": r.channels["yaw_rate"] + 0.03}) for r in told.runs)
    campaign = replace(told, runs=tuple(runs), nuisance=("yaw_rate",))
    nominal = begin(Models.of(ModelFactory(condensed(campaign), Variant()).narrowed())).ladder[0]
    errors = compared(campaign, Variant(), (), lambda words: None).errors
    assert (nominal.name, nominal.fit) == ("nominal", pytest.approx(errors.rms("fit"), abs=0.003))
    assert nominal.heldout == pytest.approx(errors.rms("holdout"), abs=0.003)
