"""The motion of the rider's body as a noisy record: how much of it was seen is calibrated, and its noise is allowed for."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from wheelchair_fmu.inference.estimation.fit import fit
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.noise_model import SWING
from wheelchair_fmu.inference.models.factory import SCALE, ModelFactory
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies.measured import PREDICTS

TRUE, NOISE = 1.5, 0.8  # of the body's motion beside what was recorded, and N s


@pytest.fixture(scope="module")
def swinging(sample):
    """Two runs of the sample campaign as the model itself would have them with a rider who swings, of whom the record
    misses a third, and something that comes and goes as fast as the filter takes it to."""
    rng = np.random.default_rng(7)
    runs = []
    for run in (sample.fit[0], sample.fit[5]):
        swing = 12 * np.sin(2 * np.pi * 1.2 * (run.time - run.time[0]))
        phi = np.exp(-float(np.median(np.diff(run.time))) / SWING)
        missed = np.zeros(len(run.time))
        for i in range(len(missed)):
            missed[i] = (phi * missed[i - 1] if i else 0.0) + rng.normal(0, NOISE * (np.sqrt(1 - phi**2) if i else 1.0))
        ridden = replace(run, inputs={**run.inputs, "rider.momentum": swing + missed})
        likelihood = Likelihood(replace(sample, runs=(ridden,)), Variant(), columns=(SCALE,))
        results = likelihood.evidence([ridden], {SCALE: TRUE}).runs[0].results
        names = [o.name for o in likelihood.sensitivities.model.outputs]
        channels = {
            c: results[:, names.index(PREDICTS[c])] + rng.normal(0, sample.noise[c], len(run.time)) for c in run.channels
        }
        runs.append(replace(run, channels=channels, inputs={**run.inputs, "rider.momentum": swing}))
    return replace(sample, runs=tuple(runs), noise={**sample.noise, "rider.momentum": NOISE})


def test_how_much_of_the_body_was_seen_is_found_and_its_noise_is_allowed_for(swinging):
    likelihood = Likelihood(swinging, Variant(), columns=(SCALE,))
    found = fit(likelihood, (SCALE,), {SCALE: 1.0})
    se = float(np.sqrt(found.covariance[0, 0]))
    assert found.values[SCALE] == pytest.approx(TRUE, abs=3 * se) and se < 0.05
    assert np.mean(found.evidence.r**2) == pytest.approx(1.0, abs=0.08)
    exact = likelihood.with_noise_model(
        replace(likelihood.noise_model, sd={**likelihood.noise_model.sd, "rider.momentum": 0.0})
    )
    assert np.mean(exact.evidence(swinging.fit, found.values).r ** 2) > 1.5


def test_the_scale_is_calibrated_only_where_the_body_was_recorded(sample, swinging):
    assert SCALE in ModelFactory(swinging, Variant()).calibrated and SCALE not in ModelFactory(sample, Variant()).calibrated
    assert SCALE not in ModelFactory(swinging, Variant(), fixed=(SCALE,)).calibrated


def test_pushes_that_are_late_take_no_body_along(swinging):
    """Hands are recorded by wheels and bodies by cameras: a shift of the pushes is none of the body."""
    likelihood, run = Likelihood(swinging, Variant().with_effects(["push_force_delay"]), columns=(SCALE,)), swinging.runs[1]
    later = likelihood.on_time(run, {"effect.push_force_delay.tau": 0.1}, {})
    np.testing.assert_array_equal(later.inputs["rider.momentum"], run.inputs["rider.momentum"])
    assert np.ptp(later.inputs["push.F_rl"] - run.inputs["push.F_rl"]) > 0.5
