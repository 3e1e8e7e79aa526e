"""The tyre laws of the model, as functions of numpy arrays with exact derivatives.

They are the very expressions that the FMU is made of, so a fitted curve and the FMU's cannot differ.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import casadi as cs
import numpy as np

from ..model.smooth import sine_over
from ..model.tyre.dugoff import dugoff_force


def linear(x: Any, K: Any) -> Any:
    return K * x


def magic(x: Any, K: Any, C: Any, D: Any, E: Any) -> Any:
    """(1) by its slope K = BCD, with the shape C, the peak D and the curvature E."""
    return K * x * sine_over(K * x / (C * D), C, E)


def dugoff(x: Any, K: Any, D: Any) -> Any:
    """(2), (4), (5) by the cornering stiffness K and the friction limit D = μN."""
    return dugoff_force.law(K, x, 1.0, D)


LAWS = {law.__name__: law for law in (linear, magic, dugoff)}


@dataclass(frozen=True)
class Compiled:
    """A law over n angles: values (n,), and their derivatives by the parameters (n, k)."""

    function: cs.Function
    derivative: cs.Function

    def __call__(self, parameters: np.ndarray) -> np.ndarray:
        return np.asarray(self.function(parameters)).ravel()

    def jacobian(self, parameters: np.ndarray) -> np.ndarray:
        return np.asarray(self.derivative(parameters))


def at(name: str, angle: np.ndarray) -> Compiled:
    """The law of this name over the angles (n,) rad."""
    return _compiled(name, tuple(float(a) for a in angle))


@cache
def _compiled(name: str, angle: tuple[float, ...]) -> Compiled:
    law = LAWS[name]
    p = cs.SX.sym("p", law.__code__.co_argcount - 1)
    y = law(cs.DM(angle), *cs.vertsplit(p))
    return Compiled(cs.Function(name, [p], [y]), cs.Function(name, [p], [cs.jacobian(y, p)]))


def evaluate(name: str, angle: np.ndarray, parameters: np.ndarray) -> np.ndarray:
    """Values (n,) of a law at angles (n,) rad."""
    return at(name, angle)(parameters)
