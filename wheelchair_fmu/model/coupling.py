"""Inertia that effects share with the chair: M x' = f with entries beside the diagonal, as equations that each have one rate.

Elimination by rows, in the order in which the unknowns are given, makes M triangular, and what is then known of later rates
goes to the right side. That multiplies M x' = f by a matrix of parameters from the left, which no Rosenbrock method notices:
(M/(hγ) − J) U = r is multiplied by it on both sides. So the engine goes on as if M were diagonal.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import casadi as cs

SPEEDS = ("psi_dot", "v", "u")  # of the chair; u comes last, because it may be held


def uncoupled(matrix: cs.SX, right: Sequence[cs.SX], free: Any) -> tuple[list[cs.SX], list[cs.SX], cs.SX]:
    """The masses and right sides of equations with one rate each, from a symmetric M (n, n) and f, and the right side of the
    last one as if it were free; it is held where `free` is 0, and 1 where it is not.

    A row without any mass is an equation for its unknown, as in a diagonal M, and has none with others.
    """
    n = len(right)
    M = {(i, j): matrix[i, j] for i in range(n) for j in range(n) if not matrix[i, j].is_zero()}
    f = list(right)
    pivots = []
    for k in range(n):
        pivots.append(_divisor(M[k, k]))
        for i in (i for i in range(k + 1, n) if (i, k) in M):
            share = M[i, k] / pivots[k]
            f[i] = f[i] - share * f[k]
            for j in (j for j in range(k + 1, n) if (k, j) in M):
                M[i, j] = M.get((i, j), cs.SX(0)) - share * M[k, j]
    driving = f[-1]
    f[-1] = free * driving
    rates: dict[int, cs.SX] = {}
    for k in reversed(range(n)):
        f[k] = f[k] - sum(M[k, j] * rates[j] for j in range(k + 1, n) if (k, j) in M)
        rates[k] = f[k] / pivots[k]
    return [M[k, k] for k in range(n)], f, driving


def _divisor(mass: cs.SX) -> cs.SX:
    """A mass to divide by: 1 in the place of 0, where nothing is shared."""
    return mass if mass.is_constant() else mass + (mass == 0)
