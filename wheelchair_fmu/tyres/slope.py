"""The slope of a curve at the origin, and whether the curve bends at all.

Where noise hides every bend, K is that of the straight line through all of it. Else, near the origin, an odd curve is
K x + k x³, and the widest range that this describes within the noise gives K the smallest error without letting the bend pull
at it; beyond where the paper sees straight curves it is not looked for.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import stats

from .fitting import Estimate, Fit, estimate, straight
from .half_difference import Curve
from .records import CAMBER, SLIP

NEAR = {SLIP: np.radians(3.0), CAMBER: np.radians(6.0)}  # Doria, section 4: straight for smaller angles than these
FEWEST = 4  # settings for a slope and a bend, with something left to judge them by
DOUBT = 0.01  # a range whose misfit is less probable is too wide
SURE = 0.01  # a bend that noise alone would show less often is one


@dataclass(frozen=True)
class Slope:
    """K, the largest angle (rad) it was taken from, and whether the curve bends over its whole length."""

    K: Estimate
    within: float
    bends: bool


def slope_of(curve: Curve, kind: str) -> Slope:
    """The slope of a curve with one pair of settings or more."""
    line = straight(curve, curve.angle[:, None])
    bends = _bends(curve, line)
    if len(curve.angle) < FEWEST or (not bends and (line.misfit is None or line.misfit >= DOUBT)):
        return _slope(line, curve, bends)
    widest = max(int(np.sum(curve.angle <= NEAR[kind] + 1e-6)), FEWEST)
    for m in range(widest, FEWEST - 1, -1):
        near = _nearest(curve, m)
        fit = straight(near, _odd(near.angle))
        if fit.misfit is None or fit.misfit >= DOUBT:
            break
    return _slope(fit, near, bends)


def _slope(fit: Fit, near: Curve, bends: bool) -> Slope:
    variance = None if fit.covariance is None else float(fit.covariance[0, 0])
    return Slope(estimate(float(fit.numbers[0]), variance, fit.freedom), float(near.angle[-1]), bends)


def _bends(curve: Curve, line: Fit) -> bool:
    """Whether a straight line leaves more than the noise does, in all or as a cubic term."""
    if len(curve.angle) < FEWEST:
        return False
    if line.misfit is not None and line.misfit < SURE:
        return True
    fit = straight(curve, _odd(curve.angle))
    if fit.covariance is None:
        return False
    ratio = abs(fit.numbers[1]) / np.sqrt(fit.covariance[1, 1])
    return bool(2 * stats.t.sf(ratio, fit.freedom) < SURE)


def _nearest(curve: Curve, m: int) -> Curve:
    return replace(curve, angle=curve.angle[:m], value=curve.value[:m])


def _odd(x: np.ndarray) -> np.ndarray:
    """Columns x and x³, the second scaled to the size of the first."""
    return np.column_stack([x, x**3 / x[-1] ** 2])
