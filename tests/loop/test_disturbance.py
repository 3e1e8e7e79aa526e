"""The strength of forces that nobody recorded: what was put in comes out, and nothing where nothing was."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.loop.disturbance import acting, strength
from wheelchair_fmu.loop.likelihood import Likelihood
from wheelchair_fmu.model.variant import Variant

from .forces import T_R, ridden, wandering


@pytest.mark.parametrize(("force", "moment"), [(3.0, 0.5), (0.0, 0.4), (0.0, 0.0)])
def test_the_force_that_was_put_in_comes_out(sample, force, moment):
    rng = np.random.default_rng(5)
    campaign = ridden(sample, rng, lambda run, without: (wandering(rng, run.time, force), wandering(rng, run.time, moment)))
    found = strength(Likelihood(campaign, Variant()).evidence(campaign.runs, {}, ()), T_R)
    assert found.force == pytest.approx(force, rel=0.15, abs=0.15)
    assert found.moment == pytest.approx(moment, rel=0.15, abs=0.03)
    noise = found.put_into(Likelihood(campaign, Variant()).noise_model)
    whole = Likelihood(campaign, Variant(), noise).evidence(campaign.runs, {}, ())
    assert float(np.mean(whole.r**2)) == pytest.approx(1, abs=0.03)


@pytest.mark.parametrize("f_r", [0.03, 0.05])
def test_a_model_that_stands_where_the_chair_rolls_needs_the_force_that_it_lacks_and_no_more(sample, f_r):
    """Its drag is some newtons too large. About where it stands no slope leads anywhere, and any force would do."""
    rng = np.random.default_rng(6)
    campaign = ridden(sample, rng, lambda run, without: (wandering(rng, run.time, 3.0), wandering(rng, run.time, 0.5)))
    likelihood, wrong = Likelihood(campaign, Variant()), {"resistance.f_r": f_r}
    found, evidence = acting(likelihood, wrong, T_R)
    assert 3.0 < found.force < 7.0 and found.moment == pytest.approx(0.5, rel=0.1)
    assert float(np.sqrt(np.mean(evidence.r**2))) == pytest.approx(1, abs=0.03)
    assert strength(likelihood.evidence(campaign.fit, wrong, ()), T_R).force > 100, "or nobody would need the way it went"
