"""Errors in the units of the channels: closed forms, and sums that do not depend on how runs are cut."""

from dataclasses import replace
from math import nan, pi, sqrt

import numpy as np
import pytest

from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.residual.physical import ChannelError, as_json, channel_errors, pooled
from wheelchair_fmu.inference.residual.staircase import Step
from wheelchair_fmu.model.variant import Variant

TIME = np.arange(1000) / 1000


def test_a_sine_that_is_foretold_by_half():
    """RMS A/2·1/√2 of an sd A/√2 is a share of a half; a constant leaves the sd; degrees where the channel is an angle."""
    measured = 0.2 * np.sin(2 * pi * 5 * TIME) + 3.0
    error = ChannelError.of("yaw", measured, 0.1 * np.sin(2 * pi * 5 * TIME) + 3.0)
    assert error.unit == "deg"
    assert error.rms == pytest.approx(np.degrees(0.1 / sqrt(2)))
    assert error.sd == pytest.approx(np.degrees(0.2 / sqrt(2)))
    assert error.constant == pytest.approx(error.sd)
    assert error.share == pytest.approx(0.5)


def test_a_constant_is_each_runs_own_and_the_spread_is_that_of_all():
    """Two runs at 1 and 3 m/s, each with an sd of 0.1: constants leave 0.1, the readings vary by √(1 + 0.01)."""
    wave = 0.1 * sqrt(2) * np.sin(2 * pi * 5 * TIME)
    runs = [{"u": ChannelError.of("u", level + wave, level + 0 * wave)} for level in (1.0, 3.0)]
    both = pooled(runs)["u"]
    assert both.unit == "m/s"
    assert both.constant == pytest.approx(0.1)
    assert both.rms == pytest.approx(0.1)
    assert both.sd == pytest.approx(sqrt(1.01))


def test_gaps_count_for_nothing():
    measured, predicted = np.array([1.0, nan, 3.0, 5.0]), np.array([1.5, 2.0, nan, 5.0])
    error = ChannelError.of("x", measured, predicted)
    assert (error.count, error.rms) == (2, pytest.approx(sqrt(0.125)))


def test_a_channel_without_a_reading_has_no_error():
    told = as_json({"a": {"u": ChannelError.of("u", np.array([nan]), np.array([1.0]))}}, {})["u"]
    assert (told["fit_rms"], told["heldout_rms"], told["share_of_sd"], told["constant_rms"]) == (None, None, None, None)


def test_held_out_runs_come_first_and_every_run_is_told():
    one, other = ({"u": ChannelError.of("u", np.array([0.0, 2.0]), np.array([e, 2.0 + e]))} for e in (1.0, 0.5))
    told = as_json({"a": one}, {"b": other})["u"]
    assert (told["fit_rms"], told["heldout_rms"], told["share_of_sd"], told["constant_rms"]) == (1.0, 0.5, 0.5, 1.0)
    assert told["runs"] == {"a": 1.0, "b": 0.5}
    assert as_json({"a": one}, {})["u"]["share_of_sd"] == 1.0


def test_the_sample_is_off_by_what_its_channels_say(sample):
    """Of simulation and readings, by hand, through the evidence that a staircase's step is made from."""
    run = replace(sample.fit[0], role="holdout")
    likelihood = Likelihood(sample, Variant())
    evidence = likelihood.evidence([run], {})
    _, measured, predicted = likelihood.readings(run, {}, likelihood.begins[run.name].start)
    at = evidence.runs[0].channels.index("yaw_rate")
    by_hand = np.degrees(np.sqrt(np.nanmean((measured - predicted)[:, at] ** 2)))
    step = Step.of("nominal", likelihood.evidence([], {}), evidence, {})
    assert step.as_json()["physical"]["yaw_rate"] == pytest.approx(by_hand)
    assert channel_errors(evidence)[run.name]["yaw_rate"].rms == pytest.approx(by_hand)
    told = step.as_json()["channels"]["yaw_rate"]
    assert told["heldout_rms"] == pytest.approx(by_hand) and told["fit_rms"] is told["fit"] is None
    assert told["heldout"] == pytest.approx(evidence.runs[0].rms["yaw_rate"])
