"""Runs are cut to where the chair rolls."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from wheelchair_fmu.campaign import moving, sets_off

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
