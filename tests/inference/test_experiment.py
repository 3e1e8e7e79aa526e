"""Runs that were not made yet: as the model that imagines them expects them, and no clearer than the floor leaves them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from wheelchair_fmu.handling.experiments import experiments
from wheelchair_fmu.inference.decision.experiment import _imagined
from wheelchair_fmu.inference.estimation.problem import Fit
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.noise_model import NoiseModel
from wheelchair_fmu.model.variant import Variant

OFFSET, BIAS = "offset.yaw_rate", 0.02  # rad/s
HIDDEN = "rolling_resistance_asymmetry"
DRAG = f"effect.{HIDDEN}.D"
COASTING = [one for one in experiments() if "coast-down" in one.words][:2]
NEAR = 0.2  # of noise: a gyroscope tells where a run starts, too, and is off by so much of what that is known to


def imagined(campaign, leads: bool, experiment):
    """The likelihood there, and the runs, of a chair whose gyroscope is off."""
    campaign = replace(campaign, nuisance=("yaw_rate",))
    noise_model = NoiseModel(campaign.noise, force=2.0, moment=0.3) if leads else None
    likelihood = Likelihood(campaign, Variant().with_effects([HIDDEN]), noise_model, leads=leads)
    here = likelihood.evidence(campaign.fit[:1], {})
    return _imagined(likelihood, experiment, Fit((OFFSET,), {OFFSET: BIAS}, np.eye(1), here, 0.0, np.eye(1)))


@pytest.mark.parametrize("leads", [False, True])
@pytest.mark.parametrize("experiment", COASTING, ids=lambda one: one.words)
def test_a_run_is_what_the_model_expects_that_imagines_it(sample, leads, experiment):
    """With the offsets of its sensors. Without these a gyroscope's offset told models apart that differ in nothing."""
    there, runs = imagined(sample, leads, experiment)
    assert runs and np.abs(there.evidence(runs, {OFFSET: BIAS}).r).max() < NEAR
    assert np.abs(there.evidence(runs, {}).r).max() > 3 * NEAR, "or the test would see no offset"


def test_forces_that_nobody_recorded_would_act_in_it_too(sample):
    """What a drag of 1 N shows in a coast-down is hundreds of times noise, and a few times what a floor does."""
    said = []
    for leads in (False, True):
        there, runs = imagined(sample, leads, COASTING[0])
        r = there.evidence(runs, {OFFSET: BIAS, DRAG: 1.0}).r
        said.append(float(r @ r))
    assert said[1] < said[0] / 10
