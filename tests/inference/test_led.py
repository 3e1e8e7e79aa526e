"""Runs that are led along forces that nobody recorded: where these are likeliest, and asked by the same readings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.flips import flipping
from wheelchair_fmu.inference.evidence.evidence import RunEvidence
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.noise_model import NoiseModel
from wheelchair_fmu.model.variant import Variant

INERTIA = {"effect.caster_inertia.I": 0.01}
WRONG = {**INERTIA, "resistance.f_f": 0.026}  # of 0.02, so that forces have much to make up for


@pytest.fixture(scope="module")
def led(tmp_path_factory):
    """Spins with casters that swing round, which no push leads where the chair went, and the noise of forces among the rest."""
    chair = Variant().with_effects(["caster_inertia"])
    campaign = flipping(tmp_path_factory.mktemp("led") / "campaign", chair, INERTIA)
    noise = replace(NoiseModel(campaign.noise), force=3.0, moment=1.0, tremor=0.5, body=1.0, floor=1.0)
    return campaign, Likelihood(campaign, chair, noise, columns=tuple(WRONG)).led(campaign)


def unlikely(likelihood: Likelihood, e: RunEvidence, path: np.ndarray) -> float:
    """−2 log probability of readings and of forces of a path (n, d) together, but for a constant."""
    _, driven = likelihood._simulated(e.run, WRONG, e.start, path)
    sd = np.array([likelihood.noise_model.sd[c] for c in e.channels])
    sum_ = float(np.nansum((((e.measured - driven) / sd) ** 2)[~e.whitener.kinks]))
    arrays, first = e.whitener.whitener.arrays, e.whitener.whitener.recorded
    common = arrays["common"][first:, first:]
    for i, sds in enumerate(arrays["input_sd"][:, first:]):
        phi = arrays["input_phi"][i - 1, first:] if i else np.zeros(len(sds))
        new = path[i] - (phi * path[i - 1] if i else 0.0)
        there = sds > 0
        Q = (common * (1 - np.outer(phi, phi)) * np.outer(sds, sds))[np.ix_(there, there)]
        sum_ += float(new[there] @ np.linalg.solve(Q + 1e-9 * np.diag(np.diag(Q)), new[there]))
    return sum_


def test_the_forces_that_lead_a_run_are_the_likeliest(led):
    """Where casters swing round, slopes hold for much less than a whole step: one that is taken all the same leads anywhere,
    and to no end. At the likeliest forces readings and forces are as likely as innovations have them."""
    campaign, likelihood = led
    (e,) = likelihood.evidence(campaign.fit, WRONG).runs
    least = unlikely(likelihood, e, e.path)
    assert least == pytest.approx(float(np.nansum(e.r**2)), rel=0.02)
    assert least < 0.01 * unlikely(likelihood, e, 0 * e.path)
    assert min(unlikely(likelihood, e, share * e.path) for share in (0.98, 1.02)) > least


def test_models_that_are_compared_are_asked_by_the_same_readings(led):
    """What tells one model nothing, as the chair comes to rest, tells the next one nothing either."""
    campaign, likelihood = led
    first = likelihood.evidence(campaign.runs, WRONG)
    assert any(e.whitener.kinks.any() for e in first.runs), "somewhere the chair turns round"
    other = {**WRONG, "resistance.f_f": 0.015}
    alone, after = (some.evidence(campaign.runs, other) for some in (likelihood, likelihood.continued(first)))
    assert any((e.whitener.kinks != f.whitener.kinks).any() for e, f in zip(alone.runs, first.runs, strict=True))
    for e, f in zip(after.runs, first.runs, strict=True):
        assert e.whitener.kinks[f.whitener.kinks].all()
