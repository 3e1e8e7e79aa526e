"""The motion of the rider's body as a noisy record: how much of it was seen is calibrated, and its noise is allowed for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from wheelchair_fmu.campaign import moving
from wheelchair_fmu.campaign.body import of_position
from wheelchair_fmu.campaign.draft import _straight
from wheelchair_fmu.inference.estimation.fit import fit
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.noise_model import NoiseModel
from wheelchair_fmu.inference.models.factory import SCALE, ModelFactory
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies.measured import PREDICTS

from .forces import swinging

TRUE, SWING = 1.25, 4.0  # of the body's motion beside what was recorded, and N s that it swings
FILMED, CAMERA = 50.0, 2e-3  # kg of the body, and m of noise in where it was seen


def filmed(campaign, seed):
    """Two runs of a campaign as the model itself would have them with a rider who swings, whom a camera saw."""
    rng, runs, noises = np.random.default_rng(seed), [], []
    for run in (campaign.fit[0], campaign.fit[5]):
        momentum = swinging(rng, run.time, SWING)
        moved = {"rider.momentum": momentum, "rider.force": np.gradient(momentum, run.time)}
        ridden = replace(run, inputs={**run.inputs, **moved})
        likelihood = Likelihood(replace(campaign, runs=(ridden,)), Variant(), columns=(SCALE,))
        results = likelihood.evidence([ridden], {SCALE: TRUE}).runs[0].results
        names = [o.name for o in likelihood.sensitivities.model.outputs]
        channels = {
            c: results[:, names.index(PREDICTS[c])] + rng.normal(0, campaign.noise[c], len(run.time)) for c in run.channels
        }
        way = cumulative_trapezoid(momentum, run.time, initial=0.0) / FILMED
        body = of_position(run.time, way + rng.normal(0, CAMERA, len(way)), FILMED)
        seen = {name: _straight(run.time, body.series[name]) for name in moved}
        runs.append(replace(run, channels=channels, inputs={**run.inputs, **seen}))
        noises.append(body.noise)
    return replace(campaign, runs=tuple(runs), noise={**campaign.noise, "rider.momentum": float(np.median(noises))})


@pytest.fixture(scope="module")
def swung(sample):
    return filmed(sample, 7)


def test_how_much_of_the_body_was_seen_is_found_and_its_noise_is_allowed_for(sample):
    """By a camera's noise, and by what smoothing takes with it; taken for exact, the record would leave half as much again."""
    found, left, exact = [], [], []
    for seed in range(4):
        campaign = filmed(sample, seed)
        likelihood = Likelihood(campaign, Variant(), columns=(SCALE,))
        fitted = fit(likelihood, (SCALE,), {SCALE: 1.0})
        found.append(fitted.values[SCALE])
        assert float(np.sqrt(fitted.covariance[0, 0])) < 0.02
        left.append(np.nanmean(fitted.evidence.r**2))
        certain = replace(likelihood.noise_model, sd={**likelihood.noise_model.sd, "rider.momentum": 0.0})
        exact.append(np.nanmean(likelihood.with_noise_model(certain).evidence(campaign.fit, fitted.values).r ** 2))
    assert found == pytest.approx([TRUE] * 4, rel=0.06) and np.mean(found) == pytest.approx(TRUE, rel=0.03)
    assert np.mean(left) == pytest.approx(1.0, abs=0.08) and np.mean(exact) > 1.5


def test_what_the_record_has_wrong_makes_no_chair_lighter(sample):
    """Led by forces, a run has that in its path, which is made of the very innovations that slopes are held against: with it in
    the slope by its mass a chair came out lighter by one and a half standard errors."""
    masses = []
    for seed in range(3):
        campaign = filmed(sample, seed)
        noise = NoiseModel(campaign.noise, force=1.0, mass=80.0)
        likelihood = Likelihood(campaign, Variant(), noise).led(moving(campaign))
        masses.append(fit(likelihood, (SCALE, "chair.m"), {SCALE: 1.0, "chair.m": 84.0}).values["chair.m"])
    assert np.mean(masses) == pytest.approx(80.0, abs=0.09)


def test_the_scale_is_calibrated_only_where_the_body_was_recorded(sample, swung):
    assert SCALE in ModelFactory(swung, Variant()).calibrated and SCALE not in ModelFactory(sample, Variant()).calibrated
    assert SCALE not in ModelFactory(swung, Variant(), fixed=(SCALE,)).calibrated


def test_pushes_that_are_late_take_no_body_along(swung):
    """Hands are recorded by wheels and bodies by cameras: a shift of the pushes is none of the body."""
    likelihood, run = Likelihood(swung, Variant().with_effects(["push_force_delay"]), columns=(SCALE,)), swung.runs[1]
    later = likelihood.on_time(run, {"effect.push_force_delay.tau": 0.1}, {})
    np.testing.assert_array_equal(later.inputs["rider.momentum"], run.inputs["rider.momentum"])
    assert np.ptp(later.inputs["push.F_rl"] - run.inputs["push.F_rl"]) > 0.5
