"""Follow a curve of solutions of F(z) = 0, one equation short of its unknowns, by pseudo-arclength.

Steps go along the curve's own tangent, so that it may turn back (a fold, beyond which one of the unknowns
has no solution) without stopping the walk. Keller 1977.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from ..errors import Failure

Equations = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]  # z (n,) → values (m,), Jacobian (m, n)
FIRST, LONGEST, SHORTEST = 0.02, 0.2, 1e-7  # steps along the curve, in scaled unknowns
ITERATIONS = 12
PRECISION = 1e-12  # last change of a scaled unknown, relative to 1 + its size


class NoSolutionError(Failure):
    """Newton's method does not arrive."""


def newton(equations: Equations, start: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """z (n,) with F(z) = 0 near `start`, for as many equations as unknowns; `scale` (n,) are the unknowns' sizes.

    Raises NoSolutionError where twelve steps do not arrive.
    """
    z, before = start.copy(), np.inf
    for _ in range(ITERATIONS):
        values, jacobian = equations(z)
        change = _solved(jacobian * scale, -values)
        z = z + scale * change
        size = float(np.abs(change / (1 + np.abs(z / scale))).max())
        if size < PRECISION or (size < 1e4 * PRECISION and size >= before):  # as good as rounding allows
            return z
        before = size
    raise NoSolutionError("Newton's method does not arrive; start nearer to a solution")


def follow(equations: Equations, start: np.ndarray, scale: np.ndarray, direction: np.ndarray) -> Iterator[np.ndarray]:
    """Points z (n,) along the curve through the solution `start`, which comes first; ends where no step is short enough.

    It sets out so that direction · dz > 0.
    """
    z, step = start, FIRST
    tangent = _tangent(equations(z)[1] * scale, direction * scale)
    while True:
        yield z
        while True:
            try:
                reached = _corrected(equations, z + step * scale * tangent, scale, tangent)
                turned = _tangent(equations(reached)[1] * scale, tangent)
                if turned @ tangent > 0.9:
                    break
            except NoSolutionError:
                pass
            step /= 2
            if step < SHORTEST:
                return
        step = min(LONGEST, 1.5 * step) if turned @ tangent > 0.99 else step
        z, tangent = reached, turned


def _corrected(equations: Equations, guess: np.ndarray, scale: np.ndarray, tangent: np.ndarray) -> np.ndarray:
    """The curve's point in the plane through `guess` across the tangent."""

    def with_plane(z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        values, jacobian = equations(z)
        return np.append(values, tangent @ ((z - guess) / scale)), np.vstack([jacobian, tangent / scale])

    return newton(with_plane, guess, scale)


def _tangent(jacobian: np.ndarray, towards: np.ndarray) -> np.ndarray:
    """The unit vector that the Jacobian (n − 1, n) takes to zero, on the side of `towards`."""
    tangent = np.linalg.svd(jacobian)[2][-1]
    return tangent if tangent @ towards >= 0 else -tangent


def _solved(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    try:
        change = np.linalg.solve(matrix, right)
    except np.linalg.LinAlgError:
        raise NoSolutionError("the equations are singular here; start elsewhere") from None
    if not np.isfinite(change).all():
        raise NoSolutionError("the equations are not finite here; start elsewhere")
    return change
