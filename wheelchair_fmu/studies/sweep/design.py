"""Which chairs: axes over parameters, and the points on them.

Morris' trajectories (Morris1991) and Saltelli's points (Saltelli2010) are SALib's, Sobol' points SciPy's. Every design
gives any of its chairs from their numbers alone, so chunks of a sweep may be done in any order, by any worker.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import prod
from typing import Any

import numpy as np

METHODS = ("grid", "random", "sobol", "morris", "saltelli")
INDICES = ("morris", "saltelli")  # those that sensitivity indices are computed from
LEVELS = 4  # of Morris' grid


@dataclass(frozen=True)
class Axis:
    """One parameter: listed `values`, or the range `lower` to `upper` with `steps` on a grid; SI units.

    A named choice is kept by its number; `choices` has the names.
    """

    name: str
    values: tuple[float, ...] = ()
    lower: float = 0.0
    upper: float = 1.0
    steps: int = 0
    log: bool = False
    choices: tuple[str, ...] = ()

    @property
    def levels(self) -> np.ndarray:
        """The values on a grid, (k,)."""
        return np.array(self.values) if self.values else self.at(np.linspace(0.0, 1.0, self.steps))

    def at(self, u: np.ndarray) -> np.ndarray:
        """Values at u in [0, 1]: a uniform u spreads evenly over the list, the range, or its logarithm."""
        if self.values:
            return np.array(self.values)[np.minimum((u * len(self.values)).astype(int), len(self.values) - 1)]
        if self.log:
            return self.lower * (self.upper / self.lower) ** u
        return self.lower + u * (self.upper - self.lower)

    def shown(self, values: np.ndarray) -> list[float] | list[str]:
        """Values as they stand in a table: choices by name."""
        return [self.choices[int(v) - 1] for v in values] if self.choices else values.tolist()


@dataclass(frozen=True)
class Design:
    """`method` over `axes`; `samples` are points, trajectories (morris) or base points (saltelli)."""

    method: str
    axes: tuple[Axis, ...]
    samples: int = 1
    seed: int = 0

    @property
    def group(self) -> int:
        """Chairs that an index needs together: a trajectory, a base point and its neighbours; otherwise 1."""
        return {"morris": len(self.axes) + 1, "saltelli": len(self.axes) + 2}.get(self.method, 1)

    @property
    def chairs(self) -> int:
        if self.method == "grid":
            return prod(len(axis.levels) for axis in self.axes)
        return self.samples * self.group

    def unit(self, start: int, stop: int) -> np.ndarray:
        """Places of chairs `start` to `stop` in the unit cube, (stop − start, k); not for a grid."""
        k, n = len(self.axes), stop - start
        if self.method == "random":
            return np.random.Generator(np.random.PCG64(self.seed).advance(start * k)).random((n, k))
        if self.method == "sobol":
            from scipy.stats import qmc  # as long to import as a thousand chairs take

            sequence = qmc.Sobol(k, seed=self.seed)
            return (sequence.fast_forward(start) if start else sequence).random(n)
        return _salib(self.method, k, self.samples, self.seed)[start:stop]

    def points(self, start: int, stop: int) -> np.ndarray:
        """Values of chairs `start` to `stop`, (stop − start, k), SI units."""
        if not self.axes:
            return np.empty((stop - start, 0))
        if self.method == "grid":
            levels = [axis.levels for axis in self.axes]
            places = np.unravel_index(np.arange(start, stop), [len(values) for values in levels])
            return np.stack([values[i] for values, i in zip(levels, places, strict=True)], axis=1)
        u = self.unit(start, stop)
        return np.stack([axis.at(u[:, i]) for i, axis in enumerate(self.axes)], axis=1)


def problem(names: tuple[str, ...]) -> dict[str, Any]:
    """SALib's description of a unit cube."""
    return {"num_vars": len(names), "names": list(names), "bounds": [[0.0, 1.0]] * len(names)}


@cache
def _salib(method: str, k: int, samples: int, seed: int) -> np.ndarray:
    from SALib.sample import morris, sobol  # an extra

    cube = problem(tuple(f"x{i}" for i in range(k)))
    if method == "morris":
        return morris.sample(cube, samples, num_levels=LEVELS, seed=seed)
    return sobol.sample(cube, samples, calc_second_order=False, seed=seed)
