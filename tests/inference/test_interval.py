"""Intervals by profile likelihood, of likelihoods as they might be."""

from __future__ import annotations

from types import SimpleNamespace as Some

import numpy as np
import pytest

from wheelchair_fmu.inference.estimation import interval
from wheelchair_fmu.inference.estimation.interval import profile_interval

SE = 0.1


@pytest.fixture
def interval_of(monkeypatch):
    """The interval of a parameter, 1.0 by a fit with standard error SE, where the deviance is so much higher at a distance."""
    monkeypatch.setattr(interval, "half_width", lambda found, at: interval.NORMAL * SE)

    def call(higher, lower=-10.0, upper=10.0):
        monkeypatch.setattr(interval, "_profile", lambda likelihood, found, at: lambda value: higher(value - 1.0))
        found = Some(names=("k",), values={"k": 1.0}, covariance=np.array([[SE**2]]), deviance=0.0)
        return profile_interval(Some(records={"k": Some(lower=lower, upper=upper)}), found, "k")

    return call


def parabola(d):
    return (d / SE) ** 2


def test_of_a_parabola_it_is_what_standard_errors_say(interval_of):
    assert interval_of(parabola) == pytest.approx((1 - 1.96 * SE, 1 + 1.96 * SE), abs=0.05 * SE)


def test_it_follows_a_valley_that_bends_and_ends_at_a_bound(interval_of):
    low, high = interval_of(lambda d: parabola(d) if d > 0 else parabola(d) / 100, lower=0.9)
    assert low == 0.9 and high == pytest.approx(1 + 1.96 * SE, abs=0.05 * SE)


def test_a_jump_close_by_does_not_make_an_estimate_sure(interval_of):
    low, high = interval_of(lambda d: parabola(d) + 1000 * (d > 0.01 * SE))
    assert (low, high) == pytest.approx((1 - 1.96 * SE, 1 + 1.96 * SE), abs=0.05 * SE)


def of_runs(slopes, offs, noise=0.1, n=200):
    """A fit of one parameter to runs that would have it so far off each, read with noise: its evidence at the best value."""
    rng = np.random.default_rng(3)
    r = np.array([noise * rng.normal(size=n) + k * off for k, off in zip(slopes, offs, strict=True)])
    S = np.repeat(np.array(slopes)[:, None], n, axis=1)
    r -= S * np.sum(r * S) / np.sum(S**2)
    whole = np.ones((n, 1), bool)
    runs = [Some(r=one[:, None], finite=whole, beyond=None, run=Some(time=np.arange(n) / 100)) for one in r]
    parts = [(run, whole, slice(i * n, (i + 1) * n)) for i, run in enumerate(runs)]
    evidence = Some(runs=runs, r=r.ravel(), S=S.reshape(-1, 1), parts=lambda: parts)
    return Some(evidence=evidence, prior_slopes=np.zeros((1, 1)))


def test_runs_that_disagree_make_an_interval_wide():
    offs = 0.3 * np.array([1.0, -1.0, 0.5, -0.5, 1.0, -1.0])
    scatter = np.std(offs, ddof=1) / np.sqrt(len(offs))
    assert interval.half_width(of_runs(np.ones(6), offs), 0) == pytest.approx(2.571 * scatter, rel=0.15)  # t, 5 degrees


def test_runs_that_agree_leave_it_as_residuals_have_it():
    assert interval.half_width(of_runs(np.ones(6), np.zeros(6)), 0) < 4 * 0.1 / np.sqrt(1200)


def test_what_one_run_decides_alone_is_no_surer_for_the_others():
    decided = of_runs([1.0, 0.01, 0.01, 0.01, 0.01], [0.2, 0.0, 0.0, 0.0, 0.0])
    assert 1.5 * 0.1 / np.sqrt(200) < interval.half_width(decided, 0) < 0.2


def test_few_runs_say_nothing_of_how_they_differ():
    assert interval.half_width(of_runs(np.ones(3), [0.3, -0.3, 0.0]), 0) < 4 * 0.1
