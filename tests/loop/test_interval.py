"""Intervals by profile likelihood, of likelihoods as they might be."""

from __future__ import annotations

from types import SimpleNamespace as Some

import numpy as np
import pytest

from wheelchair_fmu.loop import interval
from wheelchair_fmu.loop.interval import profile_interval

SE = 0.1


@pytest.fixture
def interval_of(monkeypatch):
    """The interval of a parameter, 1.0 by a fit with standard error SE, where the misfit is so much higher at a distance."""
    monkeypatch.setattr(interval, "sandwich", lambda found: np.array([[SE**2]]))

    def call(higher, lower=-10.0, upper=10.0):
        monkeypatch.setattr(interval, "_profile", lambda bench, found, at: lambda value: higher(value - 1.0))
        found = Some(names=("k",), values={"k": 1.0}, covariance=np.array([[SE**2]]), misfit=0.0)
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
