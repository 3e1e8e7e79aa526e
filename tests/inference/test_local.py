"""Clocks and baselines of single runs: against dense linear algebra, and found again where they were put in."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from wheelchair_fmu.campaign import Baseline, Clock
from wheelchair_fmu.engine.innovations import Noise, Whitener
from wheelchair_fmu.errors import SimulationError
from wheelchair_fmu.inference.estimation.fit import fit
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.local import Marginal
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies.measured import PREDICTS

from ..engine.test_innovations import drawn

NAMES = ("resistance.f_r",)
GYRO = Clock("gyro", frozenset({"yaw_rate"}), frozenset(), 0.05)
HANDS = Clock("hands", frozenset(), frozenset({"push.F_rl", "push.F_rr"}), 0.05)


def test_constants_are_taken_out_by_their_covariance():
    rng = np.random.default_rng(0)
    n, nx, nz = 10, 2, 2
    noise = Noise(np.full(1, 0.1), np.zeros(1), np.array([0.3, 0.5]), np.zeros(nz), np.diag([0.1, 0.2]) ** 2)
    filter_ = Whitener(drawn(rng, n, nx, nz, 0.3), [0, 1], noise, np.ones((n, nz), bool))
    L, signals = rng.normal(size=(n, nz, 3)), rng.normal(size=(n, nz, 2))
    signals[4, 1, 0] = np.nan
    filter_ = Whitener(drawn(np.random.default_rng(0), n, nx, nz, 0.3), [0, 1], noise, ~np.isnan(signals[:, :, 0]))
    mean = np.array([0.0, 0.0, 0.5, -1.0, 0.2])
    both = Marginal(filter_, L)
    found = both(signals, mean)

    there = ~np.isnan(signals[:, :, 0])
    white = filter_(signals, np.zeros(nx))[there]
    by_constant = filter_(np.concatenate((np.zeros((n, nz, 1)), L), axis=2), np.zeros(nx))[:, :, 1:][there]
    V = np.eye(len(white)) + by_constant @ by_constant.T
    white[:, 0] -= by_constant @ mean[2:]
    np.testing.assert_allclose(found[there].T @ found[there], white.T @ np.linalg.solve(V, white), rtol=1e-10)
    assert both.logdet == pytest.approx(filter_.logdet + np.linalg.slogdet(V)[1], rel=1e-10)
    assert np.isnan(found[4, 1, 0])


@pytest.fixture(scope="module")
def recorded(sample):
    """A run of the sample campaign as the model itself would have it, with noise, and its campaign."""
    run = sample.fit[5]
    likelihood = Likelihood(replace(sample, runs=(run,)), Variant())
    results = likelihood.evidence([run], {}).runs[0].results
    names, rng = [o.name for o in likelihood.variant.model().outputs], np.random.default_rng(1)
    read = {c: results[:, names.index(PREDICTS[c])] + rng.normal(0, sample.noise[c], len(run.time)) for c in run.channels}
    return replace(sample, runs=(replace(run, channels=read),))


def later(series: np.ndarray, time: np.ndarray, seconds: float) -> np.ndarray:
    """As a logger writes it whose clock started so much later than the others': it has what happened then."""
    return np.interp(time + seconds, time, series)


@pytest.mark.parametrize("seconds", [0.03, -0.02])
def test_a_gyro_with_a_clock_of_its_own(recorded, seconds):
    (run,) = recorded.runs
    moved = {**run.channels, "yaw_rate": later(run.channels["yaw_rate"], run.time, seconds)}
    run = replace(run, channels=moved, clocks=(GYRO,))
    likelihood = Likelihood(replace(recorded, runs=(run,)), Variant())
    (e,) = likelihood.evidence([run], {}, (), tune_start=3).runs
    assert e.start["clock.gyro"] == pytest.approx(seconds, abs=0.002)
    assert e.rms["yaw_rate"] == pytest.approx(1.0, abs=0.05)
    (without,) = likelihood.evidence([replace(run, clocks=())], {}, (), tune_start=3).runs
    assert without.rms["yaw_rate"] > 1.2, "the shift can be seen"


@pytest.mark.parametrize("seconds", [0.03, -0.02])
def test_pushes_with_a_clock_of_their_own(recorded, seconds):
    (run,) = recorded.runs
    run = replace(run, inputs={n: later(v, run.time, seconds) for n, v in run.inputs.items()}, clocks=(HANDS,))
    likelihood = Likelihood(replace(recorded, runs=(run,)), Variant())
    (e,) = likelihood.evidence([run], {}, (), tune_start=3).runs
    assert e.start["clock.hands"] == pytest.approx(seconds, abs=0.003)
    assert max(e.rms.values()) < 1.1


def test_a_baseline_of_a_push_is_nobody_elses(recorded):
    """A rim that shows 3 N and a ripple where nobody pushes: what is not allowed for becomes rolling resistance."""
    (run,) = recorded.runs
    angle = np.cumsum(run.channels["wheel_speed_l"]) * 0.01 / 0.31
    shapes = np.stack([np.ones_like(angle), np.sin(angle), np.cos(angle)], axis=1)
    pushes = {**run.inputs, "push.F_rl": run.inputs["push.F_rl"] + shapes @ [3.0, 2.0, -1.0]}
    wrong = replace(run, inputs=pushes)
    right = replace(wrong, baselines=(Baseline("push.F_rl", shapes, np.diag([2.0, 2.0, 2.0]) ** 2),))
    found = {}
    for name, one in (("wrong", wrong), ("right", right)):
        likelihood = Likelihood(replace(recorded, runs=(one,)), Variant())
        start = {n: likelihood.records[n].default for n in NAMES}
        found[name] = fit(likelihood, NAMES, start, likelihood.evidence([one], start, NAMES, tune_start=3))
    true = Variant().vector()[[p.name for p in Variant().parameters()].index(NAMES[0])]
    errors = {k: abs(f.values[NAMES[0]] - true) / np.sqrt(f.covariance[0, 0]) for k, f in found.items()}
    assert errors["right"] < 3 < errors["wrong"]
    (e,) = found["right"].evidence.runs
    sizes = np.array([e.start[f"baseline.push.F_rl.{i}"] for i in range(3)])
    np.testing.assert_allclose(right.baselines[0].independent @ sizes, shapes @ [3.0, 2.0, -1.0], atol=1.0)


def test_a_run_whose_start_is_known_may_have_an_uncertain_clock(recorded):
    """Where nothing of the start is to be found, the clock is."""
    (run,) = recorded.runs
    likelihood = Likelihood(recorded, Variant())
    known = {**run.set, **likelihood.begins[run.name].start}
    moved = {**run.channels, "yaw_rate": later(run.channels["yaw_rate"], run.time, 0.03)}
    fixed = replace(run, set=known, channels=moved, clocks=(GYRO,))
    (e,) = likelihood.evidence([fixed], {}, (), tune_start=3).runs
    assert e.start["clock.gyro"] == pytest.approx(0.03, abs=0.002)


def test_slopes_beyond_all_numbers_are_said_and_no_fault_of_the_program(sample):
    """As where a model is linearised about a motion that no chair makes."""
    (e, *_) = Likelihood(sample, Variant()).evidence(sample.fit[:1], {}, ()).runs
    with pytest.raises(SimulationError, match="grows beyond all numbers"):
        Marginal(e.whitener.whitener, np.full((*e.r.shape, 1), np.inf))
