"""A column that holds another thing than its name says is named and left out; one that is right is not."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from wheelchair_fmu.campaign import Campaign
from wheelchair_fmu.inference.decision.improve import add
from wheelchair_fmu.inference.evidence.noise_model import NoiseModel
from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.preflight.wiring import SIDES, Wiring, wiring
from wheelchair_fmu.inference.search.beginning import begin
from wheelchair_fmu.inference.search.recordings import Taken, taken
from wheelchair_fmu.model.variant import Variant


def wired(campaign: Campaign, **factors: float) -> Campaign:
    """The campaign with some of its channels multiplied."""
    runs = (replace(r, channels={c: factors.get(c, 1.0) * v for c, v in r.channels.items()}) for r in campaign.runs)
    return replace(campaign, runs=tuple(runs))


def exchanged(campaign: Campaign, table: str, one: str, other: str) -> Campaign:
    """The campaign with two columns exchanged."""
    names = {one: other, other: one}
    runs = (replace(r, **{table: {names.get(n, n): v for n, v in getattr(r, table).items()}}) for r in campaign.runs)
    return replace(campaign, runs=tuple(runs))


def found(campaign: Campaign) -> Wiring:
    return wiring(ModelFactory(campaign, Variant()).likelihood(), {})


@pytest.mark.parametrize("channel", ["yaw_rate", "a_y"])
def test_a_channel_with_the_other_sign_is_left_out(sample, channel):
    begun = begin(Models.of(ModelFactory(wired(sample, **{channel: -1.0}), Variant())))
    assert begun.notes[0] == f"{channel} has the other sign than the model's, and is left out; turn its column round"
    assert all(channel not in e.channels for e in begun.calibrated.fit.evidence.runs)
    assert not begun.retimed


def test_axes_are_named_where_all_that_they_turn_is_turned(sample):
    r = found(wired(sample, yaw_rate=-1.0, a_y=-1.0))
    assert r.wrong == ("yaw_rate", "a_y")
    assert len(r.notes) == 1 and "check `axes`" in r.notes[0]


@pytest.mark.parametrize(
    ("factor", "words"),
    [
        (180 / np.pi, "times what the model reads, and is left out; see whether it is in deg/s"),
        (np.pi / 180, "see whether its header says deg/s of what is not"),
    ],
)
def test_another_unit_is_named(sample, factor, words):
    r = found(wired(sample, yaw_rate=factor))
    assert r.wrong == ("yaw_rate",)
    assert r.notes[0].endswith(words)


def test_exchanged_wheels_are_left_out(sample):
    r = found(exchanged(sample, "channels", *SIDES))
    assert r.wrong == SIDES
    assert r.notes == ("wheel_speed_l and wheel_speed_r seem to be exchanged, and are left out; exchange their columns",)


def test_exchanged_pushes_are_named_and_nothing_is_trusted(sample):
    r = found(exchanged(sample, "inputs", "push.F_rl", "push.F_rr"))
    assert r.wrong == () and not r.trusted
    assert "see whether the columns of F_rl and F_rr are exchanged" in r.notes[0]


def test_nothing_is_left_out_where_nothing_would_be_left(sample):
    runs = (replace(r, channels={"yaw_rate": -r.channels["yaw_rate"]}) for r in sample.runs)
    r = found(replace(sample, runs=tuple(runs)))
    assert r.wrong == () and not r.trusted
    assert r.notes[-1] == "nothing else was measured, so no verdict can be trusted"


def test_a_run_in_which_nothing_else_was_measured_is_left_out(sample):
    first, *others = wired(sample, yaw_rate=-1.0).runs
    alone = replace(first, channels={"yaw_rate": first.channels["yaw_rate"]})
    begun = begin(Models.of(ModelFactory(replace(sample, runs=(alone, *others)), Variant())))
    assert begun.notes[0].startswith("yaw_rate has the other sign")
    assert begun.notes[1:] == (f"{first.name}: nothing else was measured in it, so that it says nothing",)
    assert [r.name for r in begun.models.campaign.runs] == [r.name for r in others]


def test_a_missing_effect_and_a_poor_guess_are_no_wrong_column(sample):
    assert found(sample) == Wiring()
    assert found(replace(sample, known={**sample.known, "chair.I_z": 2 * sample.known["chair.I_z"]})) == Wiring()
    assert found(wired(sample, yaw_rate=1.4, a_y=0.7)) == Wiring()


def test_who_adds_an_effect_is_told_as_well(sample):
    better = add(wired(sample, yaw_rate=-1.0), Variant(), ["rolling_resistance_asymmetry"])
    assert [n for n in better.notes if n.startswith("yaw_rate has the other sign")]


def test_who_compares_is_told_as_well(sample):
    found = taken(wired(sample, yaw_rate=-1.0), Variant())
    assert found.notes == ("yaw_rate has the other sign than the model's, and is left out; turn its column round",)
    assert not any("yaw_rate" in run.channels for run in found.campaign.runs)


def test_who_has_no_run_to_fit_takes_recordings_as_they_are(sample):
    alone = replace(sample, runs=sample.holdout)
    assert taken(alone, Variant()) == Taken(alone, NoiseModel(alone.noise))
