"""Fits where filters change with the parameters as much as residuals do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.independent.campaigns import AR1, make
from benchmarks.independent.hidden import usual
from wheelchair_fmu.campaign import read
from wheelchair_fmu.inference.estimation import fit as fitting
from wheelchair_fmu.inference.estimation.fit import fit
from wheelchair_fmu.inference.estimation.problem import Problem
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.noise import NoiseModel
from wheelchair_fmu.model.variant import Variant

TOE = ("effect.toe_misalignment.sum", "effect.toe_misalignment.difference")
NAMES = ("tyre.C_lambda", "resistance.f_r", "resistance.f_f", "chair.I_z", *TOE)
FAR = dict(zip(TOE, (0.02, 0.02), strict=True))  # as far as a search looks


@pytest.fixture(scope="module")
def likelihood(tmp_path_factory):
    """Toe hidden in coloured noise of sensors and pushes, which is known."""
    folder = tmp_path_factory.mktemp("toe") / "toe"
    hidden = {"toe_misalignment": usual("toe_misalignment", 3.0)}
    campaign = read(make(folder, hidden, noise="ar1", manoeuvres=("coast-down", "steady-right", "slalom-slow"), seed=1))
    campaign = replace(campaign, runs=tuple(replace(r, role="fit") for r in campaign.runs))
    noise_model = NoiseModel(campaign.noise, dict.fromkeys(campaign.noise, AR1))
    return Likelihood(campaign, Variant().with_effects(["toe_misalignment"]), noise_model)


def test_the_whole_gradient_is_the_slope_of_the_misfit(likelihood):
    problem = Problem(likelihood, NAMES)
    theta = problem.inside(FAR)
    here = problem.linearised(theta)
    errors = np.diag(problem.information(here)) ** -0.5
    slopes = []
    for step in np.diag(0.1 * errors):
        there = [
            problem.deviance(likelihood.evidence(likelihood.campaign.fit, problem.values(t)), t)
            for t in (theta + step, theta - step)
        ]
        slopes.append((there[0] - there[1]) / (2 * step.sum()))

    whole, partial = problem.whole_gradient(here, theta), problem.gradient(here.S, here.r, theta)

    size = np.abs(slopes) @ errors
    assert np.abs((-2 * whole - slopes) * errors).max() < 0.05 * size
    assert np.abs((-2 * partial - slopes) * errors).max() > 0.5 * size  # what is left out without


def test_a_fit_goes_on_where_slopes_of_the_residuals_lead_nowhere(likelihood, monkeypatch):
    whole = fit(likelihood, NAMES, FAR)
    monkeypatch.setattr(fitting, "_by_likelihood", lambda problem, theta, here: None)
    partial = fit(likelihood, NAMES, FAR)

    assert whole.deviance < partial.deviance - 20
