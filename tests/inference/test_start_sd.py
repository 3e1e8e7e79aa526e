"""How sure it is where a run starts."""

from __future__ import annotations

from dataclasses import replace

import pytest

from wheelchair_fmu.campaign.windows import PUSHED, between
from wheelchair_fmu.inference.evidence.initial_state import START_SD, start_sd


@pytest.mark.parametrize(
    ("rolls", "turns", "share"), [(0.0, 0.0, 0.0), (0.01, 0.0, 0.01), (1.0, 0.0, 0.99), (-1.0, 0.0, 0.99), (0.0, 5.0, 0.99)]
)
def test_a_chair_that_stands_does_not_slide(sample, rolls, turns, share):
    """A sideways speed of millimetres per second, of wheels that stand, would be a slip of their whole speed: a force as large
    as tyres have for a radian, at the first sample alone."""
    run = sample.fit[0]
    still = {name: 0 * values for name, values in run.channels.items()}
    still["yaw_rate"] = still["yaw_rate"] + turns
    found = start_sd(replace(run, channels=still, u0=rolls, set={}))
    assert found["start.v"] == pytest.approx(share * START_SD["start.v"], rel=0.05, abs=1e-3 * START_SD["start.v"])
    assert found["start.u"] == START_SD["start.u"] and found["start.psi_dot"] == START_SD["start.psi_dot"]


def test_a_piece_begins_in_mid_stroke(sample):
    """At a speed that its first samples say less surely, as hands change it meanwhile."""
    run = sample.fit[0]
    piece, start = between(run, run.time[0] + 1.0, run.time[-1]), between(run, run.time[0], run.time[0] + 3.0)
    assert start_sd(piece)["start.u"] == PUSHED > 2 * START_SD["start.u"] == 2 * start_sd(start)["start.u"]
