"""Right and left by what the equations see of them: their sum, or their mean, and their difference, right less left."""

from __future__ import annotations

from typing import Any

import casadi as cs

RIGHT_LESS_LEFT = cs.DM([-1.0, 1.0])  # for rl, rr

Former = tuple[tuple[str, float], ...]  # names that a parameter had, and what each of them counts in it


def of_sum(total: Any, difference: Any) -> Any:
    """The values of the left and of the right wheel."""
    return (total + RIGHT_LESS_LEFT * difference) / 2


def of_mean(mean: Any, difference: Any) -> Any:
    """The same by their mean."""
    return of_sum(2 * mean, difference)


def sum_of(right: str, left: str) -> Former:
    """For a sum in place of two parameters that were called so."""
    return (right, 1.0), (left, 1.0)


def mean_of(right: str, left: str) -> Former:
    return (right, 0.5), (left, 0.5)


def difference_of(right: str, left: str) -> Former:
    return (right, 1.0), (left, -1.0)
