"""One model has one error, whichever command it comes from: a search and `add` judge it by the same noise."""

from __future__ import annotations

import pytest

from benchmarks.independent.campaigns import make
from benchmarks.independent.hidden import usual
from wheelchair_fmu.campaign import read
from wheelchair_fmu.inference.decision.improve import add
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.evidence.noise_model import NoiseModel
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant


def test_what_a_search_puts_in_has_the_errors_that_add_says(tmp_path):
    """A trunk that moves leaves the pushes' noise smaller than without it."""
    campaign = read(make(tmp_path / "campaign", {"trunk_motion": usual("trunk_motion", 3.0)}, seed=5))
    chair = Variant(catalogue={effect: bundled()[effect] for effect in ("trunk_motion", "gyro_bias")})
    found = diagnose(campaign, chair)
    assert found.included == ("trunk_motion",) and found.models.setting.noise_model.differs(NoiseModel(campaign.noise))
    for here, there in zip(found.ladder, add(campaign, chair, "trunk_motion").ladder, strict=True):
        assert (here.name, here.fit, here.heldout) == (there.name, pytest.approx(there.fit), pytest.approx(there.heldout))
