"""Evidence by the short way and the long way; offsets; robust variances against sums written out."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest

from wheelchair_fmu.inference.estimation.fit import fit
from wheelchair_fmu.inference.estimation.problem import prior_of
from wheelchair_fmu.inference.estimation.score import _long_run_variance
from wheelchair_fmu.inference.evidence.evidence import Begin
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.noise_model import pushes_of
from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.search.refitting import candidate
from wheelchair_fmu.inference.search.screen import screen
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import Choice
from wheelchair_fmu.studies.measured import PREDICTS

NAMES = ("tyre.C_lambda", "resistance.f_r")
BIAS = 0.02  # rad/s
DRAG = "effect.rolling_resistance_asymmetry.D"
CHAIR = Variant().with_values({DRAG: 1.6066})  # with what was hidden in the sample


@pytest.fixture(scope="module")
def short(sample):
    return replace(sample, runs=(sample.fit[0], sample.fit[2], sample.holdout[2]))


@pytest.fixture(scope="module")
def biased(short):
    """The same recordings with a gyro that is off by BIAS, which the campaign says it may be."""
    runs = tuple(replace(r, channels={**r.channels, "yaw_rate": r.channels["yaw_rate"] + BIAS}) for r in short.runs)
    return replace(short, runs=runs, nuisance=("yaw_rate",))


def test_again_is_the_evidence_itself_where_nothing_moved(short):
    likelihood = Likelihood(short, Variant())
    here = likelihood.evidence(short.fit, {}, NAMES)
    again = likelihood.resimulated(here, {})
    np.testing.assert_allclose(again.r, here.r, atol=1e-9)
    assert again.rms == pytest.approx(here.rms, rel=1e-9)


def test_a_filter_is_all_that_it_keeps_of_an_evaluation(short):
    """What lies between its arrays would otherwise stay in memory as long as they do, for every model that a search fits."""
    (evidence,) = Likelihood(short, Variant()).evidence(short.runs[:1], {}, ["chair.m"]).runs
    whitener = evidence.filter.whitener
    kept = [*whitener.arrays.values(), whitener._gain, whitener._scale]
    assert all(array.base is None or array.base.nbytes == array.nbytes for array in kept)


def test_position_is_judged_by_what_each_reading_adds(short):
    """A chair as modelled, whose pushes were recorded with noise: wherever it drifts to, its whitened error is one."""
    rng, runs = np.random.default_rng(1), []
    likelihood, noise = Likelihood(short, Variant()), {**short.noise, "x": 0.003, "y": 0.003, "yaw": 0.004}
    for run in short.runs * 4:
        results = likelihood.evidence([run], {}).runs[0].results
        names = [o.name for o in likelihood.variant.model().outputs]
        true = {c: results[:, names.index(PREDICTS[c])] for c in noise if c in PREDICTS}
        read = {c: v + rng.normal(0, noise[c], len(v)) for c, v in true.items()}
        pushed = {n: v + rng.normal(0, 0.4, len(v)) for n, v in run.inputs.items()}
        runs.append(replace(run, name=f"{run.name} {len(runs)}", channels=read, inputs=pushed))
    there = Likelihood(replace(short, runs=tuple(runs), noise=noise), Variant()).evidence(runs, {})
    for c in ("x", "y", "yaw"):
        assert np.sqrt(np.mean([e.rms[c] ** 2 for e in there.runs])) == pytest.approx(1, abs=0.02)
    one = there.runs[0]
    i = one.channels.index("x")
    far = [np.sqrt(np.mean((e.measured[:, i] - e.predicted[:, i]) ** 2)) / noise["x"] for e in there.runs]
    assert max(far) > 2  # so it would be many, by the tracker's noise alone
    np.testing.assert_allclose(one.errors(one.predicted.copy()), one.e, rtol=1e-12)
    np.testing.assert_allclose(pickle.loads(pickle.dumps(one)).errors(one.predicted + 0.001), one.errors(one.predicted + 0.001))


def test_where_a_chair_comes_to_rest_slopes_foretell_nothing(short):
    """By slopes, a speed that is off by a little there makes a deceleration of many m/s²; friction does a tenth of one."""
    time = np.arange(0, 9, 0.01)
    run = replace(
        short.fit[0],
        time=time,
        inputs={n: 0 * time for n in short.fit[0].inputs},
        set={"start.u": 0.6},
        channels={c: 0 * time for c in ("wheel_speed_l", "wheel_speed_r", "a_x", "a_y")},
    )
    likelihood = Likelihood(replace(short, runs=(run,)), Variant())
    true = likelihood.evidence([run], {}).runs[0].predicted
    moving = true[:, 0] > 0.001
    assert moving[0] and not moving[-100:].any()  # it does come to rest
    run = replace(run, channels={c: true[:, i] for i, c in enumerate(run.channels)})
    likelihood = Likelihood(replace(short, runs=(run,)), Variant())
    (e,) = likelihood.evidence([run], {}).runs
    silent = np.argwhere(e.whitener.kinks)
    assert set(silent[:, 1]) == {2, 3} and np.isfinite(e.r).all() and not e.r[e.whitener.kinks].any()
    assert np.abs(time[silent[:, 0]] - time[moving][-1]).max() < 0.08
    earlier = likelihood.known(run)["resistance.f_r"] * np.linspace(1.1, 1.11, 200)  # so that it stops half a second early
    foretold = [likelihood.evidence([run], {"resistance.f_r": f}).runs[0].r[:, 2:] for f in earlier]
    assert np.abs(foretold).max() * short.noise["a_x"] < 0.4  # m/s²


def test_a_start_that_a_run_sets_stands(short):
    """Whatever its first samples say, and however the readings pull."""
    said = {"start.x": 3.0, "start.y": -1.0, "start.psi": 0.7, "start.u": 0.4, "start.v": 0.02, "start.psi_dot": 0.1}
    run = replace(short.fit[1], set=said, channels={**short.fit[1].channels, "yaw": 0 * short.fit[1].time})
    likelihood = Likelihood(replace(short, runs=(run,), noise={**short.noise, "yaw": 0.01}), Variant())
    (e,) = likelihood.evidence([run], {}, tune_start=2).runs
    assert e.start == said
    assert dict(zip(("x", "y", "psi", "u", "v", "psi_dot"), e.results[0], strict=False)) == pytest.approx(
        {name.partition(".")[2]: value for name, value in said.items()}
    )
    assert not e.start_S.any() and not e.offset.any()


def test_errors_of_pushes_act_as_pushes_do_and_are_no_part_of_what_is_foretold(short):
    """Where casters may swing round, a run is linearised about them. Whether they do in this one, nobody can tell."""
    run, chair = short.fit[0], Variant(Choice(caster="slipping"))
    run = replace(run, channels={name: read for name, read in run.channels.items() if not name.startswith("wheel_speed")})
    names = pushes_of(run)
    pushed = 0.5 * np.sin(np.outer(run.time, 1 + np.arange(len(names))))
    likelihood = Likelihood(replace(short, runs=(run,)), chair, columns=())
    (recorded,) = likelihood.evidence([run], {}).runs
    (e,) = likelihood.begun({run.name: Begin(path=pushed)}).evidence([run], {}).runs
    true = replace(run, inputs={**run.inputs, **{n: run.inputs[n] + pushed[:, i] for i, n in enumerate(names)}})
    (felt,) = Likelihood(replace(short, runs=(true,)), chair, columns=()).evidence([true], {}).runs
    assert np.abs(felt.predicted - recorded.predicted).max() > 0.01
    np.testing.assert_allclose(e.driven, felt.predicted, atol=1e-12)
    np.testing.assert_allclose(e.predicted, recorded.predicted, atol=1e-4)  # two simulations, of one tolerance
    np.testing.assert_allclose(e.foretold, felt.predicted - felt.filter.whitener.response(pushed), atol=1e-12)


def test_an_effect_that_a_run_sets_is_on_in_that_run(short):
    """Also one that brings states, which a likelihood has only where somebody asks for it."""
    sigma = "effect.relaxation_length.sigma"
    first, second, *_ = short.runs
    likelihood = Likelihood(replace(short, runs=(replace(first, set={sigma: 0.5}), second)), Variant())
    found = likelihood.evidence(likelihood.campaign.runs, {}).table()
    other = Likelihood(short, Variant().with_effects(["relaxation_length"]))
    assert found[first.name] == pytest.approx(other.evidence([first], {sigma: 0.5}).table()[first.name])
    assert found[second.name] == pytest.approx(other.evidence([second], {}).table()[second.name])
    assert found[first.name]["a_y"] != pytest.approx(other.evidence([first], {}).table()[first.name]["a_y"], rel=1e-3)


def test_again_follows_the_slopes_for_a_small_step(short):
    likelihood = Likelihood(short, Variant())
    here = likelihood.evidence(short.fit, {"resistance.f_r": 0.012}, NAMES)
    step = 1e-5
    moved = likelihood.resimulated(here, {"resistance.f_r": 0.012 + step}).r - here.r
    expected = -here.S[:, 1] * step
    assert np.linalg.norm(moved - expected) < 0.02 * np.linalg.norm(expected)


def test_a_fit_ends_where_the_slopes_see_nothing_more_to_gain(short):
    names = (*NAMES, DRAG)  # which was hidden, so that no bound is met
    likelihood = Likelihood(short, Variant().with_effects(["rolling_resistance_asymmetry"]))
    found = fit(likelihood, names, {"tyre.C_lambda": 4500.0, "resistance.f_r": 0.012})
    anew = likelihood.evidence(short.fit, found.values, names)
    prior = prior_of(likelihood, names)
    g = anew.S.T @ anew.r + prior.slopes @ prior.rows(np.array([found.values[n] for n in names]))
    assert g @ np.linalg.solve(anew.S.T @ anew.S + prior.slopes**2, g) < 1.0  # −2 log likelihood


def test_an_offset_that_the_campaign_names_is_estimated(biased):
    likelihood = Likelihood(biased, CHAIR)
    assert likelihood.offsets == {"offset.yaw_rate": "yaw_rate"}
    found = fit(likelihood, (*NAMES, "offset.yaw_rate"), {})
    assert found.values["offset.yaw_rate"] == pytest.approx(BIAS, abs=0.004)


def test_an_effect_is_never_tested_beside_the_offset_that_it_is(biased):
    models, base, *_ = Models.of(ModelFactory(biased, CHAIR, fixed=[DRAG])).calibrated()
    models = models.with_doubles(base.fit)
    assert models.doubles == {"gyro_bias": {"offset.yaw_rate"}} and "offset.yaw_rate" in base.fit.names
    screened = screen(models, base, ["gyro_bias", "gyro_scale"])
    by = {s.score.effect: s for s in screened}
    assert by["gyro_bias"].score.likelihood_ratio > 100 > by["gyro_scale"].score.likelihood_ratio
    found = candidate(models, base, by["gyro_bias"], 2)
    assert found is not None and "offset.yaw_rate" not in found.fit.names
    assert found.estimate[0] == pytest.approx(BIAS, abs=0.004)


def _bartlett(q, lags):
    total = q.T @ q
    for lag in range(1, lags + 1):
        c = q[lag:].T @ q[:-lag]
        total = total + (1 - lag / (lags + 1)) * (c + c.T)
    return total


def test_long_run_variance_is_bartletts_sum_where_nothing_lasts():
    """Each sample comes with its opposite next to it, so that no column has an AR(1) law that lasts."""
    q = np.random.default_rng(3).normal(size=(200, 2))
    q[1::2] = -q[::2]
    np.testing.assert_allclose(_long_run_variance(q, 7), _bartlett(q, 7), rtol=1e-10)


def test_long_run_variance_is_recoloured_by_the_law_that_was_taken_out():
    q = np.random.default_rng(3).normal(size=(200, 1)).cumsum(axis=0)
    about = q - q.mean()
    rho = min(0.97, float(np.sum(about[1:] * about[:-1]) / np.sum(about**2)))
    left = np.concatenate([q[:1], q[1:] - rho * q[:-1]])
    assert rho > 0.8
    np.testing.assert_allclose(_long_run_variance(q, 7), _bartlett(left, 7) / (1 - rho) ** 2, rtol=1e-10)


def test_a_recorded_brake_brakes(short):
    """The first run was coasted without: a brake in the record of one wheel is an error, with derivatives and without."""
    first = short.fit[0]
    pulled = replace(first, inputs={**first.inputs, "brake.rl": np.full(len(first.time), 0.02)})
    likelihood = Likelihood(replace(short, runs=(pulled, *short.runs[1:])), Variant())
    before = Likelihood(short, Variant()).evidence([first], {}, NAMES)
    braked = likelihood.evidence([pulled], {}, NAMES)
    assert braked.rms > 1.5 * before.rms
    assert likelihood.resimulated(braked, {}).rms == pytest.approx(braked.rms, rel=1e-6)


def test_a_floor_that_a_run_is_on_is_that_of_the_chair_s_own_parameters(short):
    """Twice the rolling resistance by the floor's factor or by both coefficients; a slope as an input or as the effect."""
    first = short.fit[0]
    ones = np.ones(len(first.time))
    carpet = replace(first, inputs={**first.inputs, "floor.rolling_factor": 2 * ones})
    rough = replace(first, set={**first.set, "resistance.f_r": 0.024, "resistance.f_f": 0.04})
    ramp = replace(first, inputs={**first.inputs, "floor.slope_x": 0.01 * ones})
    sloped = replace(first, set={**first.set, "effect.floor_slope.x": 0.01})
    runs = (first, carpet, rough, ramp, sloped)
    likelihood = Likelihood(replace(short, runs=runs), Variant().with_effects(["floor_slope"]))
    hard, *others = (likelihood.evidence([run], {}, ("tyre.C_lambda",)).rms for run in runs)
    assert np.abs(np.array(others) - hard).min() > 0.1 * hard
    assert others[0] == pytest.approx(others[1], rel=1e-6)
    assert others[2] == pytest.approx(others[3], rel=1e-6)
