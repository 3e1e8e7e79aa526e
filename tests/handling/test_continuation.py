"""The walk along a curve of solutions: round a circle, and past a fold."""

from __future__ import annotations

from itertools import islice

import numpy as np
import pytest

from wheelchair_fmu.handling.continuation import NoSolutionError, follow, newton


def circle(z):
    return np.array([z @ z - 4.0]), 2 * z[None, :]


def test_it_goes_round_a_circle_of_radius_2_and_past_its_folds():
    points = np.array(list(islice(follow(circle, np.array([2.0, 0.0]), np.ones(2), np.array([0.0, 1.0])), 120)))
    assert np.hypot(*points.T) == pytest.approx(2.0, abs=1e-12)
    angle = np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    assert np.all(np.diff(angle) > 0) and angle[-1] > 2 * np.pi


def test_it_sets_out_the_other_way_when_told():
    first, second = islice(follow(circle, np.array([2.0, 0.0]), np.ones(2), np.array([0.0, -1.0])), 2)
    assert first[1] == 0 and second[1] < 0


def test_it_stops_where_the_curve_ends():
    def root(z):  # y = √(1 − x), no further than x = 1
        with np.errstate(invalid="ignore", divide="ignore"):
            y = np.sqrt(1 - z[0])
            return np.array([z[1] - y]), np.array([[0.5 / y, 1.0]])

    points = list(follow(root, np.array([0.0, 1.0]), np.ones(2), np.array([1.0, 0.0])))
    assert points[-1][0] == pytest.approx(1.0, abs=1e-4) and points[-1][0] <= 1.0


def test_newton_says_where_it_does_not_arrive():
    assert newton(lambda z: (z**2 - 2, np.diag(2 * z)), np.array([1.0]), np.ones(1)) == pytest.approx(np.sqrt(2), abs=1e-15)
    for equations in (lambda z: (z**2 + 1, np.diag(2 * z)), lambda z: (np.ones(1), np.zeros((1, 1)))):
        with pytest.raises(NoSolutionError):
            newton(equations, np.array([1.0]), np.ones(1))
