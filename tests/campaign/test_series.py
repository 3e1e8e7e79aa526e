"""What a series of readings shows by itself."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.campaign import check, read
from wheelchair_fmu.campaign.series import RARE, began, estimate, scatter, spikes, third_differences

from .small import SI, csv_text, motion, rows

T = np.arange(2000) * 0.01


def readings(seed: int, sd: float = 0.05) -> np.ndarray:
    """(2000,) of a smooth motion with noise."""
    return 3 * np.sin(2 * np.pi * 0.5 * T) + sd * np.random.default_rng(seed).standard_normal(T.size)


@pytest.mark.parametrize("sd", [1e-3, 0.05, 2.0])
def test_estimate_within_ten_percent_on_a_smooth_signal(sd):
    t = np.arange(2000) * 0.01
    smooth = 3 * np.sin(2 * np.pi * 0.5 * t) + 0.1 * t**2
    noisy = smooth + sd * np.random.default_rng(1).standard_normal(t.size)
    noisy[700:720] = np.nan
    noisy[1000] += 50.0
    assert estimate([noisy]) == pytest.approx(sd, rel=0.1)


def test_estimate_of_a_coarse_converter():
    t = np.arange(3000) * 0.01
    assert estimate([np.round(np.sin(0.2 * t), 1)]) == pytest.approx(0.1 / np.sqrt(12), rel=0.5)


@pytest.mark.parametrize("step", [0.0, 1e-4, 0.05])
def test_a_long_series_is_glanced_at_with_the_same_result(step):
    """However coarse the converter is beside noise of 0.01."""
    rng = np.random.default_rng(1)
    long = np.sin(0.001 * np.arange(50_000)) + 0.01 * rng.standard_normal(50_000)
    long = np.round(long / step) * step if step else long
    long[100:200] = np.nan
    levels = np.unique(long[np.isfinite(long)])
    expected = max(scatter(third_differences(long)), np.diff(levels).min() / np.sqrt(12))
    assert estimate([long]) == expected and estimate([long[:20_000], long[20_000:]]) == pytest.approx(expected, rel=1e-3)


def test_nothing_to_estimate_from():
    assert estimate([]) is None
    assert estimate([np.arange(5.0)]) is None
    assert estimate([np.ones(100)]) is None


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("size", [30, -30, 1000])
def test_a_reading_that_stands_alone_is_found_wherever_it_is(seed, size):
    places = np.sort(np.random.default_rng(seed).choice(np.arange(0, 2000, 10), 8, replace=False))
    for at in (*places, 0, 1999):
        series = readings(seed)
        series[at] += size * 0.05
        assert spikes(series).tolist() == [at]


def test_several_are_found_beside_gaps():
    series = readings(1)
    series[[100, 500, 1500]] += 5.0
    series[600:640] = np.nan
    assert spikes(series).tolist() == [100, 500, 1500]


@pytest.mark.parametrize("seed", range(20))
def test_noise_is_no_spike(seed):
    assert not spikes(readings(seed)).size


@pytest.mark.parametrize("name", ["step", "peak of three", "coarse converter", "coasting to rest", "all the same"])
def test_what_moves_is_no_spike(name):
    noise = 0.01 * np.random.default_rng(0).standard_normal(T.size)
    peak = np.zeros(T.size)
    peak[1000:1003] = 0.7, 1.0, 0.7
    series = {
        "step": np.where(T < 10, 0.0, 5.0) + noise,
        "peak of three": 3 * peak + noise,
        "coarse converter": np.round(np.sin(0.2 * T), 1),
        "coasting to rest": np.maximum(1.5 - 0.2 * T, 0) + noise,
        "all the same": np.ones(T.size),
    }
    assert not spikes(series[name]).size


def test_what_happens_often_is_how_the_sensor_reads():
    series = readings(2)
    series[:: int(0.5 / RARE)] += 3.0
    assert not spikes(series).size


def test_a_spike_is_left_out_of_its_channel_and_of_no_other(campaign):
    data = motion()
    data[50, 5] += 4.0
    data[[80, 120], 6] -= 9.0
    data[60, 1] += 50.0  # a push may be as short as that
    c = read(campaign(files={"a.csv": csv_text(SI, rows(data))}))
    run = c.runs[0]
    assert np.flatnonzero(np.isnan(run.channels["yaw_rate"])).tolist() == [50]
    assert np.flatnonzero(np.isnan(run.channels["a_y"])).tolist() == [80, 120]
    assert not any(np.isnan(run.channels[n]).any() for n in ("wheel_speed_l", "wheel_speed_r"))
    assert run.inputs["push.F_rl"][60] == data[60, 1]
    said = [str(w) for w in check(c.path)]
    assert said[0].startswith("warning: run a.csv line 52 column 'yaw_rate [rad/s]': yaw_rate reads 4.")
    assert "at 0.5 s, alone between readings that agree, and is left out there" in said[0]
    assert "a_y has 2 readings that stand alone and are left out, the farthest -" in said[1]
    assert len(said) == 2


def test_in_a_coarse_recording_nothing_stands_alone(campaign):
    data = motion()
    data[:, 0] *= 6.0
    data[50, 5] += 4.0
    assert not np.isnan(read(campaign(files={"a.csv": csv_text(SI, rows(data))})).runs[0].channels["yaw_rate"]).any()


def test_a_series_that_grows_begins_where_its_line_does():
    """A chair that is being pushed gains speed, however often it is read; one glitch says nothing of it."""
    time = 3.0 + np.arange(0, 1, 0.01)
    speeds = 0.4 + 1.5 * (time - 3.0) + np.random.default_rng(2).normal(0, 0.002, len(time))
    speeds[4], speeds[7] = 40.0, np.nan
    assert began(time, speeds) == pytest.approx(0.4, abs=0.005)
    assert began(time[::5], speeds[::5]) == pytest.approx(0.4, abs=0.01)
    assert began(time[::30], speeds[::30]) == speeds[0]
    assert began(time, np.full(len(time), np.nan)) is None


def test_steps_of_the_way_are_no_converters():
    """A marker of 0.2 mm that moves on at 2.7 m/s is never at one place twice; a counter of 0.5 mm is."""
    time, rng = np.arange(0, 0.75, 1 / 120), np.random.default_rng(3)
    way = 2.7 * time + 0.3 * time**2 + rng.normal(0, 2e-4, len(time))
    assert estimate([way]) == pytest.approx(2e-4, rel=0.35)
    assert estimate([0.01 * np.round(2.7 * time / 0.01)]) >= 0.01 / np.sqrt(12)
