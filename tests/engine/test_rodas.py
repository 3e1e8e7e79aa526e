"""The method has the order it claims, on a stiff problem with an algebraic row and a moving input."""

from __future__ import annotations

import ctypes

import casadi as cs
import numpy as np
import pytest

from wheelchair_fmu.engine.rodas import step


class Problem:
    """x' = −x z + w, 0 = x² + w − z: enough of a model for `step`."""

    def __init__(self):
        self.x, self.w, self.p = cs.SX.sym("x", 2), cs.SX.sym("w", 1), cs.SX.sym("p", 1)
        self.f = cs.vertcat(-self.x[0] * self.x[1] + self.w, self.x[0] ** 2 + self.w - self.x[1])
        self.mass = cs.vertcat(1, 0)


def solved(steps: int) -> tuple[np.ndarray, np.ndarray]:
    """End values, and the largest error of the dense output in the middle of steps, for w = t on [0, 1]."""
    problem = Problem()
    s = step(problem)
    one = cs.Function("one", [problem.x, problem.w, s.w1, s.h, problem.p], [s.x1, s.d2, s.d3])
    x, h, middle = np.array([1.0, 1.0]), 1 / steps, []
    for i in range(steps):
        x1, d2, d3 = (v.full().ravel() for v in one(x, i * h, (i + 1) * h, h, 0))
        middle.append(0.5 * x + 0.5 * (x1 + 0.5 * (d2 + 0.5 * d3)))
        x = x1
    return x, np.array(middle)


def exact(at: np.ndarray) -> np.ndarray:
    from scipy.integrate import solve_ivp

    run = solve_ivp(lambda t, x: -x * (x * x + t) + t, (0, 1), [1.0], t_eval=at, method="DOP853", rtol=1e-13, atol=1e-14)
    return np.array([run.y[0], run.y[0] ** 2 + at]).T


def test_order_four_at_the_end_and_three_between():
    errors = [np.abs(solved(n)[0] - exact(np.array([0.0, 1.0]))[-1]).max() for n in (10, 20, 40)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > 3.7), orders
    between = [np.abs(solved(n)[1][:, 0] - exact((np.arange(n) + 0.5) / n)[:, 0]).max() for n in (10, 20, 40)]
    orders = np.log2(np.array(between[:-1]) / between[1:])
    assert np.all(orders > 2.7), orders


def test_it_is_l_stable():
    """A mode of −1e8 per second is gone after one step of a second."""
    x, w, p = (cs.SX.sym(n) for n in "xwp")
    problem = type("Stiff", (), {"x": x, "w": w, "p": p, "f": -1e8 * x, "mass": cs.SX(1)})
    s = step(problem)
    assert abs(float(cs.Function("one", [x, w, s.w1, s.h, p], [s.x1])(1.0, 0, 0, 1.0, 0))) < 1e-6


def test_ctypes_sizes_match_the_header():
    from wheelchair_fmu.engine.simulate import Accuracy

    assert ctypes.sizeof(Accuracy) == 16


if __name__ == "__main__":
    pytest.main([__file__])
