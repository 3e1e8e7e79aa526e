"""Inverses of information must not depend on the units of parameters."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.inference.estimation.inverse import inverse


def test_what_is_hardly_known_in_large_units_is_not_taken_for_certain():
    """A stiffness known to 1500 N/rad beside an angle known to 3e-5 rad: their informations differ by a factor of 2e15."""
    sd, correlation = np.array([1500.0, 3e-5]), np.array([[1.0, 0.4], [0.4, 1.0]])
    covariance = correlation * np.outer(sd, sd)
    information = np.linalg.inv(correlation) / np.outer(sd, sd)
    np.testing.assert_allclose(inverse(information), covariance, rtol=1e-9)


def test_what_is_not_seen_at_all_stays_out():
    """Of a parameter without information, and of the difference of two that act alike."""
    found = inverse(np.array([[4.0, 4e3, 0.0], [4e3, 4e6, 0.0], [0.0, 0.0, 0.0]]))
    assert not found[2].any() and np.isfinite(found).all()
    assert found[0, 0] == pytest.approx(1 / 16) and found[1, 1] == pytest.approx(1 / 16e6)
