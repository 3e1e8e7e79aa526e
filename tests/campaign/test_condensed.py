"""What a search looks at of recordings that are faster than a chair."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter

from wheelchair_fmu.campaign import Campaign, Run, windows
from wheelchair_fmu.campaign.condensed import SPAN, condensed
from wheelchair_fmu.campaign.records import Baseline

RATE, FREQUENCY, NOISE = 400.0, 2.0, 0.05


def motion(t):
    return np.sin(2 * np.pi * FREQUENCY * t + 0.3)


def a_run(rng, rate=RATE, late=0.0, seconds=6.0):
    """A wheel read at `rate`, a camera at 20 Hz by a clock of its own, and a push, in the rows of both."""
    fast, slow = np.arange(0, seconds, 1 / rate) + late, np.arange(0.013, seconds, 0.05)
    time = np.unique(np.concatenate([fast, slow]))
    wheel, camera = np.full(len(time), np.nan), np.full(len(time), np.nan)
    wheel[np.isin(time, fast)] = motion(fast) + NOISE * rng.standard_normal(len(fast))
    camera[np.isin(time, slow)] = motion(slow)
    push = np.interp(time, fast, 40 * np.maximum(0, np.sin(2 * np.pi * fast)))
    inputs, channels = {"push.F_rl": push}, {"wheel_speed_l": wheel, "u": camera}
    baseline = Baseline("push.F_rl", np.ones((len(time), 1)), np.eye(1))
    of_devices = {"baselines": (baseline,), "steps": {"push.F_rl": 1 / rate}, "devices": 2}
    return Run("a", Path("a.csv"), "straight", "fit", 0.0, {}, time, inputs, channels, **of_devices)


def a_campaign(*runs):
    noise = {"wheel_speed_l": NOISE, "u": 0.01, "F_rl": 1.0}
    return Campaign("c", Path("c"), "SAE-J670", {}, {}, noise, frozenset(), (), {}, tuple(runs), "")


@pytest.fixture
def rng():
    return np.random.default_rng(5)


def test_what_is_no_faster_than_a_chair_stays_as_it_is(rng):
    slow = a_campaign(a_run(rng, rate=60.0))
    assert condensed(slow) is slow and windows(slow) is slow


@pytest.mark.parametrize("late", [0.0, 0.0007, 0.0019])
def test_means_stand_where_they_belong_with_less_noise(rng, late):
    whole = a_campaign(a_run(rng, late=late))
    short = condensed(whole)
    run = short.runs[0]
    there = np.isfinite(run.channels["wheel_speed_l"])
    t, left = run.time[there], run.channels["wheel_speed_l"][there] - motion(run.time[there])
    shift = (left @ (2 * np.pi * FREQUENCY * np.cos(2 * np.pi * FREQUENCY * t + 0.3))) / np.sum(
        (2 * np.pi * FREQUENCY * np.cos(2 * np.pi * FREQUENCY * t + 0.3)) ** 2
    )
    assert abs(shift) < 4e-4, "seconds; three standard errors of the noise"
    assert run.noise_shares["wheel_speed_l"] == pytest.approx(1 / np.sqrt(SPAN * RATE), rel=0.1)
    assert left.std() == pytest.approx(NOISE * run.noise_shares["wheel_speed_l"], rel=0.15)
    assert run.steps["wheel_speed_l"] == pytest.approx(1 / RATE) and short.noise == whole.noise
    assert len(run.time) < 0.2 * len(whole.runs[0].time) and not short.thinned
    assert condensed(short) is short


@pytest.mark.parametrize("rate", [100.0, 240.0, 400.0])
@pytest.mark.parametrize("phi", [0.0, 0.5, 0.9, 0.97])
def test_a_mean_has_more_of_noise_that_neighbours_share(rng, rate, phi):
    runs = []
    for _ in range(4):
        run = a_run(rng, rate=rate, seconds=20.0)
        there = np.isfinite(run.channels["wheel_speed_l"])
        white = NOISE * np.sqrt(1 - phi**2) * rng.standard_normal(there.sum())
        run.channels["wheel_speed_l"][there] = motion(run.time[there]) + lfilter([1.0], [1.0, -phi], white)
        runs.append(run)
    left = [r.channels["wheel_speed_l"] - motion(r.time) for r in condensed(a_campaign(*runs)).runs]
    share = condensed(a_campaign(*runs)).runs[0].noise_shares["wheel_speed_l"]
    assert np.nanstd(np.concatenate(left)) == pytest.approx(NOISE * share, rel=0.15)


@pytest.mark.parametrize("phi", [0.0, 0.9])
def test_colour_of_pushes_is_of_their_own_samples(rng, phi):
    run = a_run(rng, seconds=20.0)
    own = np.arange(0, 20.0, 1 / RATE)
    noise = lfilter([1.0], [1.0, -phi], np.sqrt(1 - phi**2) * rng.standard_normal(len(own)))
    run.inputs["push.F_rl"] = np.interp(run.time, own, 40 * np.sin(2 * np.pi * own) + noise)
    assert condensed(a_campaign(run)).runs[0].colours["push.F_rl"] == pytest.approx(phi, abs=0.05)


def test_a_slow_channel_keeps_its_own_readings_at_their_own_times(rng):
    before, after = a_run(rng), condensed(a_campaign(a_run(rng))).runs[0]
    own, kept = (np.isfinite(r.channels["u"]) for r in (before, after))
    assert set(after.time[kept]) <= set(before.time[own]) and kept.sum() >= own.sum() - 2
    assert after.channels["u"][kept] == pytest.approx(motion(after.time[kept]), abs=1e-12)


def test_pushes_keep_their_momentum_and_the_noise_of_their_own_samples(rng):
    before, after = a_run(rng), condensed(a_campaign(a_run(rng))).runs[0]
    inside = slice(*np.searchsorted(before.time, [after.time[0], after.time[-1]]))
    momentum = np.trapezoid(before.inputs["push.F_rl"][inside], before.time[inside])
    assert np.trapezoid(after.inputs["push.F_rl"], after.time) == pytest.approx(momentum, rel=1e-3)
    assert after.steps["push.F_rl"] == 1 / RATE
    assert after.baselines[0].shapes == pytest.approx(np.ones((len(after.time), 1)))


def test_gaps_stay_gaps(rng):
    run = a_run(rng)
    gap = (run.time > 2.0) & (run.time < 3.0)
    run.channels["wheel_speed_l"][gap] = np.nan
    after = condensed(a_campaign(run)).runs[0]
    found = np.isfinite(after.channels["wheel_speed_l"])
    assert not found[(after.time > 2.0 + SPAN) & (after.time < 3.0 - SPAN)].any() and found.sum() > 200


def test_a_moment_of_a_recording_stays_as_it_is(rng):
    moment = a_campaign(a_run(rng, rate=1000.0, seconds=0.012))
    assert condensed(moment) is moment
