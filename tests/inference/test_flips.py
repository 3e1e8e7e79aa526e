"""Where casters swing round, a run goes the way to which errors of its recorded pushes lead."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.flips import flipping
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.noise_model import pushes_of
from wheelchair_fmu.model.variant import Variant

INERTIA = {"effect.caster_inertia.I": 0.01}
TUNED = 2


@pytest.fixture(scope="module")
def swinging(tmp_path_factory):
    """A campaign as this very chair goes, and its likelihood."""
    chair = Variant().with_effects(["caster_inertia"])
    campaign = flipping(tmp_path_factory.mktemp("flips") / "campaign", chair, INERTIA)
    return campaign, Likelihood(campaign, chair, columns=tuple(INERTIA))


def test_errors_of_pushes_that_are_found_are_the_likeliest(swinging):
    """Readings, pushes and start together are less likely with a tenth less of them, and with a tenth more. Noise is white
    here, so that each counts by its square."""
    campaign, likelihood = swinging
    felt = likelihood.evidence(campaign.runs, INERTIA, tune_start=TUNED)
    for e in felt.runs:
        assert e.pushed is not None and e.summary().rms == pytest.approx(e.rms, rel=1e-6)
        assert np.sqrt(np.nanmean(e.r**2)) == pytest.approx(1, abs=0.05)

        def unlikely(share, e=e):
            names, pushed = pushes_of(e.run), share * e.pushed
            true = replace(e.run, inputs={**e.run.inputs, **{n: e.run.inputs[n] + pushed[:, i] for i, n in enumerate(names)}})
            _, measured, simulated = likelihood.readings(true, INERTIA, e.start)
            sd = np.array([campaign.noise[c] for c in e.channels])
            return np.nansum(((measured - simulated) / sd) ** 2) + np.sum((pushed / campaign.noise["F_rl"]) ** 2)

        least = unlikely(1.0)
        assert unlikely(0.9) > least and unlikely(1.1) > least
        assert unlikely(0.0) > least + 10


def test_innovations_elsewhere_do_not_need_the_run_without_errors_of_its_pushes(swinging):
    """Which is simulated only where somebody keeps what comes out."""
    campaign, likelihood = swinging
    felt, there = likelihood.evidence(campaign.runs, INERTIA, tune_start=TUNED), {**INERTIA, "resistance.f_r": 0.013}
    entire, part = likelihood.resimulated(felt, there), likelihood.resimulated(felt, there, whole=False)
    np.testing.assert_array_equal(part.r, entire.r)
    for one, other, whole in zip(part.runs, entire.runs, likelihood.whole(part, there).runs, strict=True):
        assert np.abs(one.predicted - other.predicted).max() > 1e-6, "not simulated"
        np.testing.assert_array_equal(whole.predicted, other.predicted)
        np.testing.assert_array_equal(whole.results, other.results)
