"""Where refits start: a linear step says where it leads, and a glance at few runs picks what all runs would."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from wheelchair_fmu.inference.estimation import starts
from wheelchair_fmu.inference.estimation.fit import fit
from wheelchair_fmu.inference.estimation.problem import Problem
from wheelchair_fmu.inference.estimation.starts import most_promising, outlook
from wheelchair_fmu.inference.estimation.statistics import standard_errors
from wheelchair_fmu.inference.models.factory import CALIBRATED, ModelFactory
from wheelchair_fmu.model.variant import Variant

DRAG = "effect.rolling_resistance_asymmetry.D"
TOE = ("effect.toe_misalignment.sum", "effect.toe_misalignment.difference")


@pytest.fixture(scope="module")
def shop(sample):
    return ModelFactory(sample, Variant())


@pytest.fixture(scope="module")
def calibrated(shop):
    return fit(
        shop.likelihood(), CALIBRATED, {n: shop.campaign.known.get(n, shop.likelihood().records[n].default) for n in CALIBRATED}
    )


def linearised(shop, calibrated, names):
    return shop.likelihood().evidence(shop.campaign.fit, calibrated.values, names)


def test_a_step_leads_where_a_fit_of_a_linear_effect_ends(shop, calibrated):
    """From where another fit of it left the rest, as at the end of a search: there one step is all that is left to go."""
    likelihood, names = shop.likelihood(), (*CALIBRATED, DRAG)
    likelihood.evidence(
        shop.campaign.fit, fit(likelihood, names, calibrated.values).values, tune_start=2
    )  # every run where it starts
    whole = fit(likelihood, names, calibrated.values)
    nearly = {**whole.values, DRAG: 0.9 * whole.values[DRAG]}
    known = likelihood.evidence(shop.campaign.fit, nearly, names)
    to = outlook(likelihood, known, names, [nearly[n] for n in names])

    assert to.reached[-1] == pytest.approx(whole.values[DRAG], abs=0.2 * standard_errors(whole)[DRAG])
    assert to.deviance == pytest.approx(Problem(likelihood, names).squares(whole.evidence, np.array(to.reached)), rel=1e-3)


def test_a_glance_at_few_runs_picks_what_all_runs_would(shop, calibrated, monkeypatch):
    likelihood, names = shop.likelihood(), (*CALIBRATED, *TOE)
    known = linearised(shop, calibrated, CALIBRATED)
    sizes = (-0.02, -0.01, 0.0, 0.01, 0.02)
    tries = [[*(calibrated.values[n] for n in CALIBRATED), r, left] for r, left in product(sizes, sizes)]
    calls = []
    again = likelihood.resimulated
    monkeypatch.setattr(
        likelihood, "resimulated", lambda e, *of, whole: calls.append(len(e.runs)) or again(e, *of, whole=whole)
    )
    quick = most_promising(likelihood, known, names, tries, 2, known.r)
    glances, calls[:] = sum(calls), []
    monkeypatch.setattr(starts, "GLANCED", len(known.runs))
    thorough = most_promising(likelihood, known, names, tries, 2, known.r)

    assert [o.theta for o in quick] == [o.theta for o in thorough]
    assert quick[0].deviance <= quick[1].deviance < outlook(likelihood, known, names, [*tries[0][:-2], 0.0, 0.0]).deviance
    assert glances < 0.7 * sum(calls)


def test_where_the_model_cannot_run_nothing_is_promised(shop, calibrated):
    likelihood, sigma = shop.likelihood(["relaxation_length"]), "effect.relaxation_length.sigma"
    known = linearised(shop, calibrated, CALIBRATED)
    to = outlook(likelihood, known, (*CALIBRATED, sigma), [*(calibrated.values[n] for n in CALIBRATED), -0.05])
    assert to.deviance == float("inf")


def test_a_step_ends_where_a_fit_may(shop, calibrated):
    """Slopes at twice the mass ask for values that no chair has."""
    likelihood = shop.likelihood()
    known = linearised(shop, calibrated, CALIBRATED)
    far = [*({**calibrated.values, "chair.m": 2 * calibrated.values["chair.m"]}[n] for n in CALIBRATED)]
    to, problem = outlook(likelihood, known, CALIBRATED, far), Problem(likelihood, CALIBRATED)
    assert (problem.lower <= to.reached).all() and (to.reached <= problem.upper).all()
    assert np.isin(to.reached, [problem.lower, problem.upper]).any()  # where slopes alone would not stop
