"""Designs: even, the same in any pieces, and with the indices that closed forms give."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import qmc

from wheelchair_fmu.studies.sweep.design import METHODS, Axis, Design
from wheelchair_fmu.studies.sweep.indices import indices_of

AXES = (Axis("a", lower=1.0, upper=100.0, steps=3, log=True), Axis("b", lower=-1.0, upper=1.0, steps=4))


@pytest.mark.parametrize("method", METHODS)
def test_pieces_are_the_whole(method):
    design = Design(method, AXES, 16, seed=3)
    whole = design.points(0, design.chairs)
    assert whole.shape == (design.chairs, 2) and np.all(whole[:, 0] >= 1) and np.all(np.abs(whole[:, 1]) <= 1)
    pieces = [design.points(i, min(i + 4, design.chairs)) for i in range(0, design.chairs, 4)]
    np.testing.assert_array_equal(np.concatenate(pieces), whole)
    np.testing.assert_array_equal(Design(method, AXES, 16, seed=3).points(0, design.chairs), whole)


@pytest.mark.parametrize("method", ["random", "sobol", "morris", "saltelli"])
def test_another_seed_gives_other_chairs(method):
    assert not np.array_equal(Design(method, AXES, 16, 1).points(0, 16), Design(method, AXES, 16, 2).points(0, 16))


def test_a_grid_has_every_combination_once():
    points = Design("grid", AXES).points(0, 12)
    assert len(np.unique(points, axis=0)) == 12
    assert sorted(set(points[:, 0])) == pytest.approx([1, 10, 100])


def test_sobol_points_are_more_even_than_random_ones():
    spread = {m: qmc.discrepancy(Design(m, AXES, 256, 1).unit(0, 256)) for m in ("sobol", "random")}
    assert spread["sobol"] < spread["random"] / 5


def test_a_list_is_sampled_evenly():
    axis = Axis("tyre.law", (3.0, 1.0), choices=("linear", "dugoff", "magic_formula"))
    values = axis.at(np.array([0.0, 0.49, 0.5, 1.0]))
    assert axis.shown(values) == ["magic_formula", "magic_formula", "linear", "linear"]


def test_saltellis_indices_of_ishigamis_function():
    """Ishigami1990: closed forms for sin x₁ + 7 sin² x₂ + 0.1 x₃⁴ sin x₁ on ±π."""
    axes = tuple(Axis(f"x{i}", lower=-np.pi, upper=np.pi) for i in range(3))
    design = Design("saltelli", axes, 4096, seed=1)
    x = design.points(0, design.chairs)
    found = list(indices_of(design, np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])))
    assert [row["S1"] for row in found] == pytest.approx([0.3139, 0.4424, 0.0], abs=0.02)
    assert [row["ST"] for row in found] == pytest.approx([0.5576, 0.4424, 0.2437], abs=0.02)


def test_morris_of_a_line_is_its_slope_over_the_range():
    axes = (Axis("a", lower=0.0, upper=2.0), Axis("b", lower=0.0, upper=5.0))
    design = Design("morris", axes, 8, seed=1)
    x = design.points(0, design.chairs)
    y = 3 * x[:, 0] - x[:, 1]
    y[design.group] = np.nan  # one bad chair: its trajectory is left out
    found = list(indices_of(design, y))
    assert [row["mu"] for row in found] == pytest.approx([6, -5])
    assert [row["mu_star"] for row in found] == pytest.approx([6, 5])
    assert [row["sigma"] for row in found] == pytest.approx([0, 0], abs=1e-9)
    assert [row["left_out"] for row in found] == [1, 1]


def test_what_does_not_vary_has_no_indices():
    design = Design("morris", AXES, 4)
    assert all(np.isnan(row["mu_star"]) for row in indices_of(design, np.ones(design.chairs)))
