"""Chances of χ² against `scipy.stats`."""

from __future__ import annotations

import pytest
from scipy import stats

from wheelchair_fmu.inference.chance import chance_beyond, power, value_beyond


@pytest.mark.parametrize("degrees", [1, 2, 5])
def test_chances_are_those_of_scipy_stats(degrees):
    for x in (-3.0, 0.0, 0.5, 4.0, 40.0, 600.0, 1e5):
        assert chance_beyond(x, degrees) == pytest.approx(stats.chi2.sf(x, degrees), rel=1e-10, abs=1e-300)
    for chance in (0.5, 0.05, 1e-6):
        assert value_beyond(chance, degrees) == pytest.approx(stats.chi2.isf(chance, degrees), rel=1e-10)
    for noncentrality in (1e-9, 0.1, 5.0, 80.0, 1e6):
        expected = stats.ncx2.sf(stats.chi2.isf(0.05, degrees), degrees, noncentrality)
        assert power(noncentrality, degrees, 0.05) == pytest.approx(expected, rel=1e-9)
