"""Noise is told from what is smooth, and white from coloured."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from wheelchair_fmu.campaign import Run
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.noise import by_run, noise_model_of, shown
from wheelchair_fmu.inference.evidence.noise_model import NoiseModel
from wheelchair_fmu.model.variant import Variant

from .forces import ridden


def ar1(sigma: float, phi: float, seed: int, n: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    noise = np.empty(n)
    noise[0] = rng.normal(0, sigma)
    for i in range(1, n):
        noise[i] = phi * noise[i - 1] + rng.normal(0, sigma * np.sqrt(1 - phi**2))
    return noise


def gyro(time: np.ndarray, yaw_rate: np.ndarray) -> Run:
    return Run("turn", Path("turn.csv"), "turn", "fit", 1.0, {}, time, {}, {"yaw_rate": yaw_rate})


def coloured(sigma: float, phi: float, stated: float, seed: int = 0, n: int = 4000, times: float = 1.0, hertz: float = 0.3):
    """`noise_model_of` one run whose only channel has AR(1) noise on a smooth error so many `times` as large, by a filter
    for white noise of the `stated` size."""
    noise = ar1(sigma, phi, seed, n)
    smooth = times * sigma * np.sin(2 * np.pi * hertz * np.arange(n) * 0.01)
    run = gyro(0.01 * np.arange(n), noise + smooth)
    predicted = np.zeros((n, 1))
    r = (run.channels["yaw_rate"][:, None] - predicted) / stated
    evidence = SimpleNamespace(runs=[SimpleNamespace(run=run, channels=("yaw_rate",), followed=predicted, r=r, e=r)])
    return noise_model_of(evidence, {"yaw_rate": stated}, NoiseModel({"yaw_rate": stated}))


def test_white_noise_as_stated_is_left_alone():
    noise_model, notes = coloured(0.006, 0.0, 0.006)
    assert noise_model.sd == {"yaw_rate": 0.006} and not noise_model.ar and not notes


@pytest.mark.parametrize("seed", range(3))
def test_colour_is_seen(seed):
    noise_model, notes = coloured(0.006, 0.9, 0.006, seed)
    assert noise_model.ar["yaw_rate"] == pytest.approx(0.9, abs=0.01)
    assert not notes, "its size is as stated"


@pytest.mark.parametrize("seed", range(3))
def test_what_a_missing_effect_leaves_is_no_slow_noise(seed):
    """An error of strokes looks within fifteen samples as very slow noise, five times as large, does."""
    noise_model, notes = coloured(0.006, 0.9, 0.006, seed, times=10.0, hertz=1.0)
    assert noise_model.sd["yaw_rate"] == 0.006 and not notes
    assert noise_model.ar["yaw_rate"] == pytest.approx(0.9, abs=0.03)


@pytest.mark.parametrize("seed", range(3))
def test_coloured_noise_that_is_larger_than_stated_is_seen(seed):
    noise_model, notes = coloured(0.012, 0.9, 0.006, seed)
    assert noise_model.sd["yaw_rate"] == pytest.approx(0.012, rel=0.2) and notes
    assert noise_model.ar["yaw_rate"] == pytest.approx(0.9, abs=0.02)


def test_a_wrong_size_is_said():
    noise_model, notes = coloured(0.006, 0.0, 0.6)
    assert noise_model.sd["yaw_rate"] == pytest.approx(0.006, rel=0.1)
    assert notes == ["yaw_rate: its noise is about 0.006 rad/s, not the 0.6 stated; the data's own is used"]


def test_what_is_as_smooth_as_motion_tells_no_noise():
    """Markers that were filtered and interpolated show next to none of their own, and a model that is far off leaves smooth
    errors of them: noise of a micrometre would make every error a certainty."""
    noise_model, notes = coloured(1e-9, 0.0, 0.004, times=5e8, hertz=0.02)
    assert noise_model.sd["yaw_rate"] == 0.004 and not notes and not noise_model.ar.get("yaw_rate")


@pytest.mark.parametrize(("phi", "stated", "expected"), [(0.9, 0.4, 0.9), (0.0, 0.4, None), (0.0, 0.6, None)])
def test_pushes_noise_is_coloured_where_its_size_says_so(phi, stated, expected):
    """Strokes of 40 N with kinks, and noise of 0.4 N; white noise that was stated half as large again is none."""
    t = np.arange(4000) * 0.01
    strokes = 40 * np.maximum(0, np.sin(2 * np.pi * t))
    run = SimpleNamespace(channels={}, colours={}, inputs={"push.F_rl": strokes + ar1(0.4, phi, 1, len(t)), "push.F_rr": 0 * t})
    evidence = SimpleNamespace(runs=[SimpleNamespace(run=run, channels=())])
    noise_model, notes = noise_model_of(evidence, {"F_rl": stated, "F_rr": 0.0}, NoiseModel({"F_rl": stated, "F_rr": 0.0}))
    assert not notes and set(noise_model.ar) == ({"F_rl"} if expected else set())
    assert noise_model.ar.get("F_rl") == (expected and pytest.approx(expected, abs=0.02))


@pytest.mark.parametrize("every", [(2,), (3, 3, 4)], ids=["every second row", "30 Hz on a grid of 100 Hz"])
@pytest.mark.parametrize(("phi", "stated"), [(0.0, 0.6), (0.0, 0.006), (0.9, 0.006), (0.9, 0.0012)])
def test_a_slow_sensors_noise_is_told_by_its_own_readings(every, phi, stated):
    """Its coefficient is from one of its readings to the next, which the filter brings to its rows by their times."""
    noise = ar1(0.006, phi, 1, 12000)
    readings = np.full(noise.shape, np.nan)
    places = np.concatenate(([0], np.cumsum(np.tile(every, 12000 // sum(every) - 1))))
    readings[places] = noise[places]
    r = readings[:, None] / stated
    time = 0.01 * np.arange(len(noise))
    run = gyro(time, readings)
    one = SimpleNamespace(run=run, channels=("yaw_rate",), followed=np.zeros(r.shape), r=r, e=r)
    noise_model, notes = noise_model_of(SimpleNamespace(runs=[one]), {"yaw_rate": stated}, NoiseModel({"yaw_rate": stated}))
    assert noise_model.sd["yaw_rate"] == pytest.approx(0.006, rel=0.1)
    step = float(np.median(np.diff(time[places])))
    assert noise_model.ar.get("yaw_rate", 0.0) == pytest.approx(phi ** (step / 0.01), abs=0.03)
    assert bool(notes) == (stated != 0.006)


def test_a_chair_that_bumps_make_walk_at_random_is_no_noise_of_its_sensors(sample):
    """Each bump is over within a sample, and its momentum stays: speeds differ from the model's by a random walk."""
    fine = {**sample.noise, "wheel_speed_l": 8e-4, "wheel_speed_r": 8e-4}
    rng = np.random.default_rng(4)
    bumpy = ridden(replace(sample, noise=fine), rng, lambda run, without: (rng.normal(0, 160, len(run.time)), 0 * run.time))
    likelihood = Likelihood(bumpy, Variant())
    found, notes = noise_model_of(likelihood.evidence(bumpy.fit, {}, ()), fine, likelihood.noise_model)
    for name in ("wheel_speed_l", "wheel_speed_r"):
        assert found.sd[name] == fine[name] and not [note for note in notes if note.startswith(name)]


def test_a_sensor_that_shakes_more_in_one_run_is_seen(sample):
    """Twice the noise of a_y in one run; the others keep theirs, and a run not seen has what all have together."""
    rng, shaken = np.random.default_rng(4), sample.fit[2].name

    def shake(run):
        sd = sample.noise["a_y"] * (3**0.5 if run.name == shaken else 0.0)  # beside what it has
        return replace(run, channels={**run.channels, "a_y": run.channels["a_y"] + rng.normal(0, sd, len(run.time))})

    campaign = replace(sample, runs=tuple(shake(run) for run in sample.runs))
    taken = NoiseModel(campaign.noise)
    found = by_run(Likelihood(campaign, Variant(), taken).evidence(campaign.fit, {}, ()), taken)
    others = [times["a_y"] for run, times in found.items() if run != shaken]
    assert found[shaken]["a_y"] == pytest.approx(2 * np.mean(others), rel=0.1) and np.ptp(others) < 0.2
    known, runs = replace(taken, by_run=found), {run.name: run for run in campaign.runs}
    assert known.of("a_y", runs[shaken]) == pytest.approx(found[shaken]["a_y"] * taken.sd["a_y"])
    together = np.sqrt(np.mean([times["a_y"] ** 2 for times in found.values()]))
    assert known.of("a_y", replace(runs[shaken], name="another")) == pytest.approx(together * taken.sd["a_y"])


def test_a_new_run_shakes_its_sensors_as_its_readings_show(sample):
    """Where that tells the fitted runs apart."""
    rng, fit = np.random.default_rng(5), [run.name for run in sample.fit]

    def shake(run, times):
        sd = sample.noise["a_y"] * np.sqrt(times**2 - 1)  # beside what it has
        return replace(run, channels={**run.channels, "a_y": run.channels["a_y"] + rng.normal(0, sd, len(run.time))})

    runs = [shake(run, 1 + 0.5 * fit.index(run.name) if run.name in fit else 4.0) for run in sample.runs]
    campaign, taken = replace(sample, runs=tuple(runs)), NoiseModel(sample.noise)
    evidence = Likelihood(campaign, Variant(), taken).evidence(campaign.fit, {}, ())
    found = by_run(evidence, taken)
    known = replace(taken, by_run=found, shown=shown(evidence, found, taken))
    assert known.shown["a_y"] == pytest.approx(1.0, rel=0.1)
    for run in campaign.holdout:
        assert known.of("a_y", run) == pytest.approx(4.0 * sample.noise["a_y"], rel=0.15)
