"""Runs that are led along forces that nobody recorded: where these are likeliest, and asked by the same readings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.flips import flipping
from wheelchair_fmu.campaign import Campaign
from wheelchair_fmu.inference.evidence.evidence import RunEvidence
from wheelchair_fmu.inference.evidence.likelihood import HELD, Likelihood
from wheelchair_fmu.inference.evidence.noise_model import NoiseModel
from wheelchair_fmu.model.variant import Variant

INERTIA = {"effect.caster_inertia.I": 0.01}
CHAIR = Variant().with_effects(["caster_inertia"])


def wrong(f_f: float) -> dict[str, float]:
    """The chair with rolling resistance other than 0.02, for which forces have to make up."""
    return {**INERTIA, "resistance.f_f": f_f}


@pytest.fixture(scope="module")
def campaign(tmp_path_factory):
    """Spins with casters that swing round, which no push leads where the chair went."""
    return flipping(tmp_path_factory.mktemp("led") / "campaign", CHAIR, INERTIA)


def led(campaign: Campaign, strong: float) -> Likelihood:
    """Forces that are so many times as strong as usual are among the noise."""
    noise = replace(NoiseModel(campaign.noise), force=3.0 * strong, moment=strong, tremor=0.5, body=1.0, floor=1.0)
    return Likelihood(campaign, CHAIR, noise, columns=tuple(wrong(0.02))).led(campaign)


def unlikely(likelihood: Likelihood, e: RunEvidence, values: dict[str, float], path: np.ndarray) -> float:
    """−2 log probability of readings and of forces of a path (n, d) together, but for a constant."""
    _, driven = likelihood._simulated(e.run, values, e.start, path)
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


@pytest.mark.parametrize(("strong", "f_f", "share"), [(1.0, 0.026, 0.01), (1.0, 0.028, 0.01), (3.0, 0.023, 0.03)])
def test_the_forces_that_lead_a_run_are_the_likeliest(campaign, strong, f_f, share):
    """Where casters swing round, slopes hold for much less than a whole step: one that is taken all the same leads anywhere,
    and to no end. At the likeliest forces readings and forces are as likely as innovations have them."""
    likelihood, values = led(campaign, strong), wrong(f_f)
    (e,) = likelihood.evidence(campaign.fit, values).runs
    least = unlikely(likelihood, e, values, e.path)
    assert least == pytest.approx(float(np.nansum(e.r**2)), rel=0.02)
    assert least < share * unlikely(likelihood, e, values, 0 * e.path)
    assert min(unlikely(likelihood, e, values, times * e.path) for times in (0.98, 1.02)) > least


def test_a_run_stays_on_its_path_where_no_more_is_asked(campaign):
    likelihood, values = led(campaign, 1.0), wrong(0.026)
    end = likelihood.evidence(campaign.fit, values)
    (there,), (stays,) = end.runs, likelihood.beside(end, HELD).evidence(campaign.fit, values).runs
    np.testing.assert_array_equal(stays.path, there.path)


def test_models_that_are_compared_are_asked_by_the_same_readings(campaign):
    """What tells one model nothing, as the chair comes to rest, tells the next one nothing either."""
    likelihood = led(campaign, 1.0)
    first = likelihood.evidence(campaign.runs, wrong(0.026))
    assert any(e.whitener.kinks.any() for e in first.runs), "somewhere the chair turns round"
    alone, after = (some.evidence(campaign.runs, wrong(0.015)) for some in (likelihood, likelihood.continued(first)))
    assert any((e.whitener.kinks != f.whitener.kinks).any() for e, f in zip(alone.runs, first.runs, strict=True))
    for e, f in zip(after.runs, first.runs, strict=True):
        assert e.whitener.kinks[f.whitener.kinks].all()
