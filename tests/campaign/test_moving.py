"""Runs are cut to where the chair rolls."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from wheelchair_fmu.campaign import moving, pace, sets_off

from .test_condensed import a_campaign, a_run


def rolling(time, *spans):
    """Wheel speed that is 1 m/s within these spans of time, with ramps of half a second."""
    return np.max([np.clip(np.minimum(time - a, b - time) / 0.5, 0, 1) for a, b in spans], axis=0)


def the_run(*spans, seconds=20.0, **more):
    run = a_run(np.random.default_rng(1), rate=100.0, seconds=seconds)
    there = np.isfinite(run.channels["wheel_speed_l"])
    wheel = np.where(there, rolling(run.time, *spans) + np.random.default_rng(2).normal(0, 0.01, len(run.time)), np.nan)
    return replace(run, channels={"wheel_speed_l": wheel}, **more)


def test_rest_before_and_after_is_left_out():
    (run,) = moving(a_campaign(the_run((3.0, 15.0)))).runs
    assert 3.0 < run.time[0] < 3.3 and 14.7 < run.time[-1] < 15.1 and run.name == "a"
    assert 0.1 < run.u0 < 0.5, "the speed at its own first samples"
    assert all(len(v) == len(run.time) for v in (*run.inputs.values(), *run.channels.values(), run.baselines[0].shapes))


def test_how_far_a_chair_has_rolled_since_it_stood_is_known_where_it_stood():
    """From 0 to 0.2 m/s at 2 m/s² it rolls 1 cm."""
    (run,) = moving(a_campaign(the_run((3.0, 15.0)))).runs
    assert 0.005 < run.way < 0.03
    (rolling_in,) = moving(a_campaign(the_run((-1.0, 15.0)))).runs
    assert rolling_in.way is None


def test_a_chair_sets_off_where_it_stands_and_then_rolls():
    assert sets_off(a_campaign(the_run((3.0, 15.0))))
    assert not sets_off(a_campaign(the_run((-1.0, 15.0))))  # it comes to rest, and that is all
    assert not sets_off(a_campaign(the_run((3.0, 3.1))))


def test_a_rest_between_makes_two_runs_with_names_of_their_own():
    first, second = moving(a_campaign(the_run((1.0, 8.0), (10.0, 19.0), (19.5, 20.0), role="holdout"))).runs
    assert first.time[-1] < 8.2 and 10.0 < second.time[0] < 10.3
    assert first.name != second.name and first.role == second.role == "holdout"


def test_what_never_rolls_for_long_and_what_tells_no_speed_stays_whole():
    still, mute = the_run((3.0, 4.5)), the_run((3.0, 15.0))
    mute = replace(mute, channels={"yaw_rate": mute.channels["wheel_speed_l"]})
    assert moving(a_campaign(still, mute)).runs == (still, mute)


@pytest.mark.parametrize("speed", [0.4, 1.7])
def test_places_tell_how_fast_a_chair_rolls_where_its_wheels_do_not(speed):
    """On a circle of 2 m, by a marker that is 2 mm off at each moment, with some of its moments lost."""
    run, random = the_run((3.0, 15.0)), np.random.default_rng(4)
    seen = random.uniform(size=len(run.time)) < 0.6
    at = {"x": 2.0 * np.sin(speed * run.time / 2.0), "y": -2.0 * np.cos(speed * run.time / 2.0)}
    at = {name: np.where(seen, where + random.normal(0, 0.002, len(where)), np.nan) for name, where in at.items()}
    assert np.allclose(pace(replace(run, channels=at)), speed, rtol=0.03, atol=0.01)


def test_a_chair_that_stands_by_its_places_or_tells_nothing_has_a_pace_still():
    run = the_run((3.0, 15.0))
    stands = replace(run, channels=dict.fromkeys("xy", np.zeros(len(run.time))))
    nothing = replace(run, channels={"yaw_rate": run.channels["wheel_speed_l"]})
    assert np.all(pace(stands) == 0.1) and np.all(pace(nothing) == 1.0)
