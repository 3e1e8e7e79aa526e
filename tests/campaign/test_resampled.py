"""Readings that are none: repeated, or joined by straight lines, until a slow sensor's next one comes."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.campaign import check, read
from wheelchair_fmu.campaign.resampled import JOINED, REPEATED, resampled
from wheelchair_fmu.campaign.series import estimate

from .small import SI, csv_text, motion, rows

T = np.arange(0, 12, 0.01)
SEEDS = range(5)


def turning(t: np.ndarray) -> np.ndarray:
    return 0.6 * np.sin(2 * t) + 0.3 * np.sin(5.3 * t + 1)


def stopping(t: np.ndarray) -> np.ndarray:
    return np.maximum(0, np.sin(t))


def slow(seed: int, hertz: float, how=turning, noise: float = 0.006, step: float = 1e-6) -> tuple[np.ndarray, np.ndarray]:
    """Times and readings of a slow sensor."""
    t = np.arange(0, T[-1] + 1 / hertz, 1 / hertz)
    return t, np.round((how(t) + noise * np.random.default_rng(seed).standard_normal(len(t))) / step) * step


def repeated(t: np.ndarray, readings: np.ndarray) -> np.ndarray:
    return readings[np.searchsorted(t, T + 1e-9, side="right") - 1]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("hertz", [5, 10, 25, 30, 33, 50, 60, 75])
def test_a_repeated_reading_is_kept_where_it_was_new(seed, hertz):
    t, readings = slow(seed, hertz)
    found = resampled(repeated(t, readings))
    assert found and found.how == REPEATED and found.rows == pytest.approx(100 / hertz, rel=0.01)
    assert found.places.tolist() == np.unique(np.ceil(t[t <= T[-1]] * 100 - 1e-6)).astype(int).tolist()


@pytest.mark.parametrize("step", [0.006, 0.012, 0.02])
@pytest.mark.parametrize("seed", SEEDS)
def test_repeated_and_coarse(seed, step):
    found = resampled(repeated(*slow(seed, 30, step=step)))
    assert found and found.rows == pytest.approx(100 / 30, rel=0.02)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_chair_that_rests_is_measured_as_often_while_it_does(seed):
    values = repeated(*slow(seed, 25, stopping, noise=0.0))
    found = resampled(values)
    at_rest = np.flatnonzero(values == 0)
    assert found and np.isin(at_rest, found.places).sum() == pytest.approx(len(at_rest) / 4, rel=0.02)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("hertz", [5, 10, 25, 30, 50])
@pytest.mark.parametrize("digits", [4, 6, 15])
def test_of_straight_lines_the_knots_are_kept(seed, hertz, digits):
    t, readings = slow(seed, hertz)
    values = np.round(np.interp(T, t, readings), digits)
    found = resampled(values)
    assert found and found.how == JOINED and found.rows == pytest.approx(100 / hertz, rel=0.02)
    nearest = np.round(t[t <= T[-1]] * 100).astype(int)
    assert np.isin(found.places, nearest).mean() > 0.9, "but for where the slope hardly changes, or a knot is midway"
    if hertz >= 25:  # slower, the motion is not smooth over four readings
        kept = np.where(np.isin(np.arange(len(T)), found.places), values, np.nan)
        assert estimate([kept]) == pytest.approx(0.006, rel=0.35)


def encoder(seed: int) -> np.ndarray:
    """Counts of pulses from row to row, as a speed."""
    angle = np.cumsum(1 + 0.4 * turning(T)) * 0.01 / 0.3
    ticks = np.floor(angle * 1000 / (2 * np.pi) + np.random.default_rng(seed).random())
    return np.diff(ticks, prepend=ticks[0]) * 2 * np.pi / 1000 * 0.3 / 0.01


def lost(seed: int) -> np.ndarray:
    """A radio that loses one reading of ten and repeats the one before."""
    rng = np.random.default_rng(seed)
    values = turning(T) + 0.006 * rng.standard_normal(T.size)
    return values[np.maximum.accumulate(np.where(rng.random(T.size) < 0.1, 0, np.arange(T.size)))]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("steps", [0.1, 0.3, 0.5, 1, 2, 3, 5, 10, 100])
@pytest.mark.parametrize("how", [turning, stopping, np.zeros_like])
def test_a_coarse_converter_repeats_values_and_none_is_left_out(seed, steps, how):
    """Noise of so many steps, on a chair that turns, stops or stands."""
    step = 0.006 / steps
    assert resampled(np.round((how(T) + 0.006 * np.random.default_rng(seed).standard_normal(T.size)) / step) * step) is None


@pytest.mark.parametrize(
    "name",
    [
        "no noise",
        "six digits",
        "coarse ramp",
        "ramp",
        "coasts to rest",
        "square",
        "every third",
        "encoder",
        "lost",
        "slow noise",
    ],
)
@pytest.mark.parametrize("seed", SEEDS)
def test_what_is_sampled_in_each_row_is_left_alone(name, seed):
    rng = np.random.default_rng(seed)
    slow_noise = np.zeros(T.size)
    for i, new in enumerate(0.006 * rng.standard_normal(T.size - 1), start=1):
        slow_noise[i] = 0.95 * slow_noise[i - 1] + new
    ramp = 1 - 0.05 * T * rng.uniform(0.5, 2)
    series = {
        "no noise": turning(T),
        "six digits": np.round(turning(T) * rng.uniform(0.1, 2), 6),
        "coarse ramp": np.round(ramp, 2),
        "ramp": ramp,
        "coasts to rest": np.round(np.maximum(0, 4 * ramp - 3), 6),
        "square": 0.5 * np.sign(np.sin(T * rng.uniform(1, 9))),
        "every third": np.where(np.arange(T.size) % 3, np.nan, turning(T) + 0.006 * rng.standard_normal(T.size)),
        "encoder": encoder(seed),
        "lost": lost(seed),
        "slow noise": turning(T) + slow_noise,
    }
    assert resampled(series[name]) is None


def test_repeats_become_gaps_of_their_channel_and_are_named(campaign):
    data = motion(n=600)
    new = np.ceil(np.arange(0, 600, 10 / 3)).astype(int)
    data[:, 5] = data[new, 5][np.searchsorted(new, np.arange(600), side="right") - 1]
    data[:, 6] = np.round(np.interp(np.arange(600), np.arange(0, 600, 4), data[::4, 6]), 6)
    folder = campaign(files={"a.csv": csv_text(SI, rows(data))})
    said = [str(f) for f in check(folder)]
    assert said == [
        "warning: run a.csv column 'yaw_rate [rad/s]': yaw_rate changes only every 3 or 4 rows: it was sampled at about 30 Hz "
        "and repeated; what is no reading is left out; leave its cells empty in rows without a new reading",
        "warning: run a.csv column 'a_y [m/s2]': a_y changes its slope only every 4 rows: it was sampled at about 25 Hz and "
        "joined by straight lines; what is no reading is left out; leave its cells empty in rows without a new reading",
    ]
    run = read(folder).runs[0]
    assert np.flatnonzero(np.isfinite(run.channels["yaw_rate"])).tolist() == new.tolist()
    assert np.isfinite(run.channels["a_y"]).sum() == pytest.approx(150, abs=8)
    assert np.isfinite(run.channels["wheel_speed_l"]).all()


@pytest.mark.parametrize("every", [(2,), (3,), (3, 3, 4), (10,)])
@pytest.mark.parametrize("sd", [1e-3, 0.05])
def test_noise_of_a_slow_sensor_is_estimated_from_its_own_readings(every, sd):
    t = np.arange(0, 100, 0.01)
    series = np.full(t.size, np.nan)
    places = np.cumsum(np.tile(every, t.size // sum(every) - 1))
    series[places] = (0.3 * np.sin(0.6 * t) + sd * np.random.default_rng(1).standard_normal(t.size))[places]
    assert estimate([series]) == pytest.approx(sd, rel=0.1)
