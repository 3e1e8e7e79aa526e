"""The half-difference correction: what the curved track adds is the same on both sides, and cancels.

A disc distorts the contact patch to one side, whatever the angle: the curvature force (Doria, section 2). With y(±λ) measured,

    (y(+λ) − y(−λ)) / 2   is the tyre's own force or torque,
    (y(+λ) + y(−λ)) / 2   is the curvature force and noise.

Both have the same noise, so the scatter of the half sums tells how good the half differences are, whatever law they follow.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

PAIRED = 0.02 * np.pi / 180  # rad; angles that differ by less than this are one setting of the rig
ROUNDING = 1e-4  # of the largest value: no rig is better, and noise-free data must not divide by zero
ENOUGH = 4  # pairs, from which on the half sums tell the noise


@dataclass(frozen=True, eq=False)
class Curve:
    """One corrected curve: `value` (n,) at `angle` (n,) rad, positive and rising; an odd function takes it to both sides.

    `sigma` is one standard deviation of a value and `freedom` how many degrees of freedom tell it; None and 0 where the
    pairs are too few. `offset` is the mean of the half sums, ± `offset_se`: the curvature force, or its torque.
    """

    angle: np.ndarray
    value: np.ndarray
    sigma: float | None
    freedom: int
    offset: float
    offset_se: float | None

    @property
    def largest(self) -> float:
        return float(np.abs(self.value).max())


@dataclass(frozen=True, eq=False)
class Pairs:
    """Settings of the rig that were measured with both signs, and those (rad) that were not."""

    angle: np.ndarray
    plus: tuple[np.ndarray, ...]
    minus: tuple[np.ndarray, ...]
    alone: tuple[float, ...]


def pairs(angle: np.ndarray) -> Pairs:
    """Which samples (n,) of an angle belong together: same size, other sign; zero belongs to neither."""
    settings: list[float] = []
    for size in np.sort(np.abs(angle)):
        if size > PAIRED and (not settings or size - settings[-1] > PAIRED):
            settings.append(float(size))
    sides = [tuple(np.flatnonzero(np.abs(sign * angle - s) <= PAIRED) for s in settings) for sign in (1, -1)]
    both = [i for i in range(len(settings)) if len(sides[0][i]) and len(sides[1][i])]
    mean = [np.abs(angle[np.r_[sides[0][i], sides[1][i]]]).mean() for i in both]
    alone = tuple(settings[i] for i in range(len(settings)) if i not in both)
    return Pairs(np.array(mean), tuple(sides[0][i] for i in both), tuple(sides[1][i] for i in both), alone)


def corrected(paired: Pairs, measured: np.ndarray) -> Curve:
    """The tyre's own curve from what was `measured` (n,) on both sides; repeats of a setting are averaged first."""
    plus, minus = (_means(measured, side) for side in (paired.plus, paired.minus))
    difference, half_sum = (plus - minus) / 2, (plus + minus) / 2
    n = len(difference)
    offset = float(half_sum.mean()) if n else 0.0
    if n < ENOUGH:
        return Curve(paired.angle, difference, None, 0, offset, None)
    # The contact point moves a little over the disc as the angle grows: a straight drift is no noise.
    drift = np.polynomial.Polynomial.fit(paired.angle, half_sum, 1)
    scatter = float(np.sqrt(np.sum((half_sum - drift(paired.angle)) ** 2) / (n - 2)))
    sigma = max(scatter, ROUNDING * float(np.abs(difference).max()))
    return Curve(paired.angle, difference, sigma, n - 2, offset, sigma / np.sqrt(n))


def _means(measured: np.ndarray, groups: Sequence[np.ndarray]) -> np.ndarray:
    return np.array([measured[group].mean() for group in groups])


def pooled(curves: Sequence[Curve]) -> tuple[Curve, ...]:
    """The same curves with the noise of all: one load cell measured them."""
    known = [(c.sigma, c.freedom) for c in curves if c.sigma is not None]
    freedom = sum(f for _, f in known)
    if not freedom:
        return tuple(curves)
    common = float(np.sqrt(sum(f * s * s for s, f in known) / freedom))
    noise = [max(common, ROUNDING * c.largest) for c in curves]
    return tuple(
        replace(c, sigma=s, freedom=freedom, offset_se=s / np.sqrt(len(c.angle))) for c, s in zip(curves, noise, strict=True)
    )
