"""Speeds and accelerations of a body from where a camera saw it."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.campaign.swinging import FASTEST, SLOWEST, _spline, half_left, swing

LEAN, HERTZ = 0.03, 1.2  # m and Hz, of a trunk
OMEGA = 2 * np.pi * HERTZ


def seen(rate: float, noise: float, seed: int = 0, seconds: float = 20.0) -> tuple[np.ndarray, np.ndarray]:
    time = np.arange(0, seconds, 1 / rate)
    return time, LEAN * np.sin(OMEGA * time) + noise * np.random.default_rng(seed).normal(size=len(time))


@pytest.mark.parametrize("rate", [60.0, 100.0, 240.0])
@pytest.mark.parametrize("noise", [2e-4, 2e-3])
def test_a_body_is_as_fast_and_gains_speed_as_it_does(rate, noise):
    """A tenth of the speed, and a quarter of how it changes, are the camera's at 2 mm; derivatives as such would be it several
    times over. The noise that is told is what chance does, without what is smoothed away."""
    time, path = seen(rate, noise)
    found = swing(time, path)
    inside = (time > 1) & (time < time[-1] - 1)
    speed, force = LEAN * OMEGA * np.cos(OMEGA * time), -LEAN * OMEGA**2 * np.sin(OMEGA * time)
    off, bent = (np.std((one - true)[inside]) for one, true in ((found.slope, speed), (found.bend, force)))
    assert off < 0.1 * np.std(speed) and bent < 0.25 * np.std(force)
    assert 0.7 * off < found.noise < 1.3 * off
    raw = np.gradient(np.gradient(path, time), time)
    assert np.std((raw - force)[inside]) > 5 * bent


def test_the_told_noise_is_that_of_many_cameras():
    """The same swing, filmed forty times: slopes scatter by what is said, where nothing bends the mean."""
    slopes, told = [], []
    for seed in range(40):
        found = swing(*seen(100.0, 1e-3, seed))
        slopes.append(found.slope)
        told.append(found.noise)
    scatter = float(np.sqrt(np.mean(np.var(slopes, axis=0)[200:-200])))
    assert np.mean(told) == pytest.approx(scatter, rel=0.15)


def test_of_a_swing_at_its_limit_half_is_left():
    """λ dt ω⁸ = 1: of what is slower nearly all, of what is twice as fast one 257th."""
    time = np.arange(0, 20, 0.005)
    for hertz, left in ((1.0, 1.0), (2.0, 1 / (1 + (2 / 3) ** 8)), (3.0, 0.5), (6.0, 1 / 257)):
        wave = np.sin(2 * np.pi * hertz * time)
        smoothed = _spline(time, wave, 0.005, 2 * np.pi * 3.0)(time)
        inside = (time > 2) & (time < 18)
        assert np.std(smoothed[inside]) / np.std(wave[inside]) == pytest.approx(left, rel=0.02, abs=0.001)


def test_a_quiet_camera_is_smoothed_less_and_a_still_body_most():
    quiet, loud = (half_left(*seen(100.0, noise)) for noise in (1e-4, 3e-3))
    assert SLOWEST <= loud < quiet <= FASTEST
    time = np.arange(0, 10, 0.01)
    assert half_left(time, 1e-3 * np.random.default_rng(2).normal(size=len(time))) == pytest.approx(SLOWEST, rel=0.1)


def test_gaps_are_bridged_and_too_few_readings_are_none():
    time, path = seen(100.0, 5e-4)
    path[700:712] = np.nan
    found, whole = swing(time, path), swing(*seen(100.0, 5e-4))
    assert np.isfinite(found.slope).all() and np.abs(found.slope - whole.slope)[650:760].max() < 0.03
    late = np.where(time > 10, time + 60, time)  # out of sight for a minute, over which it does not matter how it moved
    away, inside = swing(late, path), (time > 1) & (time < 9) | (time > 11) & (time < 19)
    assert np.abs(away.slope - whole.slope)[inside].max() < 0.03
    assert swing(time[:7], path[:7]) is None
    few = swing(0.001 * np.arange(10), path[:10])
    assert few is not None and np.isfinite(few.slope).all() and half_left(0.001 * np.arange(10), path[:10]) == FASTEST
    still = swing(time, 0 * time)
    assert not np.abs(still.slope).any() and still.noise == 0
