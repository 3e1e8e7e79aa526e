"""The unrolled LU against numpy, on the matrices that models have."""

from __future__ import annotations

import casadi as cs
import numpy as np
import pytest

from tests.kit import anywhere, variant_with
from wheelchair_fmu.engine.lu import factorise
from wheelchair_fmu.model.effects import bundled


@pytest.mark.parametrize("h", [1e-6, 1e-3, 0.1])
def test_it_solves_what_numpy_solves(h):
    variant = variant_with(*bundled())
    model, rng = variant.model(), np.random.default_rng(0)
    right = cs.SX.sym("right", model.x.numel())
    W = cs.diag(model.mass) / h - cs.jacobian(model.f, model.x)
    solve = cs.Function("solve", [model.x, model.w, model.p, right], [W, factorise(W).solve(right)])
    place = anywhere(variant, rng)
    b = rng.normal(size=model.x.numel())
    matrix, k = (m.full() for m in solve.call([place.x, place.w, place.p, b]))
    np.testing.assert_allclose(k.ravel(), np.linalg.solve(matrix, b), rtol=1e-8, atol=1e-12)


def test_zeros_cost_nothing():
    n = 8
    W = cs.diag(cs.SX.sym("d", n))
    W[0, :] = cs.SX.sym("row", n).T
    W[:, 0] = cs.SX.sym("column", n)
    factors = factorise(W)  # an arrow: in the right order it fills in nothing
    assert len(factors.lower) == n - 1 and set(factors.order[-2:]) >= {0}
