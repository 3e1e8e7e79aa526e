"""Markers that sit away from the centre of mass: given by the campaign, and found where they are not."""

from __future__ import annotations

import pytest

from benchmarks.independent.campaigns import ROOM_CHANNELS, make
from tests.inference.conftest import among
from wheelchair_fmu.campaign import read
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.model.variant import Variant

AXLE = {"marker_offset": {"x": -0.2, "y": 0.05}}
RUNS = ["coast-down", "straight-strokes", "steady-right", "slalom-slow", "slalom-quick", "holdout-slalom"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Recorded with a marker on the rear axle."""
    return make(tmp_path_factory.mktemp("axle") / "c", AXLE, channels=(*ROOM_CHANNELS, "u", "v"), manoeuvres=RUNS, seed=4)


def test_a_point_that_is_given_is_where_the_marker_is_read(folder, tmp_path):
    """Starts are the centre of mass's, and the marker's path and speed are as near to the model's as other readings."""
    text = (folder / "campaign.toml").read_text()
    there = folder.parent / "there"
    there.mkdir()
    (there / "runs").symlink_to(folder / "runs")
    (there / "campaign.toml").write_text(text + "\n[sensor]\nx.at = [-0.2, 0.05]\ny.at = [-0.2, 0.05]\nu.at = [-0.2, 0.05]\n")
    with_point, without = read(there), read(folder)
    assert with_point.known["effect.marker_offset.x"] == -0.2 and with_point.known["effect.marker_offset.y"] == 0.05
    assert "marker_offset" in with_point.effects
    told, at_cm = (Likelihood(c, Variant()).evidence(c.fit, {}, tune_start=2) for c in (with_point, without))
    for channel in ("x", "y", "v"):
        before, after = (max(e.rms[channel] for e in evidence.runs) for evidence in (at_cm, told))
        assert after < 1.1 < 1.5 < before


@pytest.mark.nightly
@among("marker_offset", "gyro_scale", "toe_misalignment", "wheel_radius_error")
def test_a_point_that_nobody_gave_is_found(folder, chair):
    found = diagnose(read(folder), chair)
    assert found.verdict == "missing" and found.effects == ("marker_offset",)
    assert found.final.values["effect.marker_offset.x"] == pytest.approx(-0.2, abs=0.01)
    assert found.final.values["effect.marker_offset.y"] == pytest.approx(0.05, abs=0.01)
