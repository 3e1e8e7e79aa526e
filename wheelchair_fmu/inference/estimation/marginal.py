"""Marginal likelihoods of effects: how well a model with one more is borne out, however many parameters that one has.

An effect that is there has a size about as large as δ or a few times that: each parameter is normal about zero with a standard
deviation of `LARGE` δ, and one-sided where only that is lawful. One that is not there has the small size that every chair has
of everything, `SLIGHT` δ, as no model is exact. The marginal likelihood of each is that of a normal with the estimate's mean
and robust covariance, in the directions that the data see (Laplace's approximation; Kass and Raftery 1995), with what each
predicts of the runs held out. Each direction in which the data chose a size costs as much as they narrowed it down, so that
effects of one parameter and of several compare.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import log

import numpy as np
from scipy import special

from ..policy import DEFAULT, SearchPolicy
from .score import Score
from .statistics import seen_axes

DRAWS = 4000  # of a size, from its posterior
LEAST = 0.1  # fall of −2 log likelihood that tells of an estimate as much as none


@dataclass(frozen=True)
class Support:
    """What a round says of one effect: log marginal likelihoods, beside the model without it, where it is as large as what
    matters, by `fitted` runs alone and with those held out, and where it is slight; and the probability that it is larger than
    δ in the former case."""

    effect: str
    fitted: float
    large: float
    slight: float
    left: float  # share of the fall that a slight one leaves
    beyond: float


def support(
    effect: str,
    size: np.ndarray,
    covariance: np.ndarray,
    lawful: np.ndarray,
    fall: float,
    ahead: float = 0.0,
    policy: SearchPolicy = DEFAULT,
) -> Support:
    """Of an estimate (k,) with its covariance (k, k), in units of δ; `lawful` (k,) says which may only be positive. `fall` is
    by how much −2 log likelihood falls up to the estimate, `ahead` by how much it does so on runs held out."""
    axes, spread = seen_axes(covariance)
    along = axes.T @ size
    # How much of a fall belongs to the size: where more falls than standard errors say, most of it is not for them to tell.
    away = float(np.sum(along**2 / spread))
    own = min(1.0, away / max(fall, LEAST))
    one = float(np.linalg.norm(axes, axis=1).max())  # what δ of the parameter that shows most does along the seen directions

    def posterior(sd: float) -> tuple[np.ndarray, np.ndarray]:
        """Means and variances of the size along the seen directions, where it has this standard deviation beforehand."""
        width = spread + sd**2
        return along * sd**2 / width, spread * sd**2 / width

    def marginal(sd: float, ahead: float) -> tuple[float, float]:
        """The log marginal likelihood for sizes with this standard deviation, and the share of the fall that these leave."""
        mean, variance = posterior(sd)
        at, scatter = (axes @ mean)[lawful], np.sqrt((axes**2 @ variance)[lawful])
        sides = np.divide(at, scatter, out=np.zeros(len(at)), where=scatter > 0)  # of what nobody sees, either is as likely
        allowed = float(np.sum(special.log_ndtr(sides) + log(2)))
        left = own * float(np.sum((along - mean) ** 2 / spread)) / max(away, LEAST)
        width = spread + sd**2
        paid = float(np.sum(np.log(width / spread) + along**2 / width))
        value = 0.5 * (fall + (1 - left) * ahead) - 0.5 * paid + allowed
        return value, left

    mean, variance = posterior(policy.large)
    draws = mean + np.sqrt(variance) * np.random.default_rng(0).standard_normal((DRAWS, len(along)))
    free = draws[np.all((draws @ axes.T)[:, lawful] >= 0, axis=1)]
    beyond = float(np.mean(np.linalg.norm(free, axis=1) > one)) if len(free) else 0.0
    (fitted, _), (large, _) = marginal(policy.large, 0.0), marginal(policy.large, ahead)
    slight, left = marginal(policy.slight, ahead)
    return Support(effect, fitted, large, slight, left, beyond)


def support_of(
    effect: str,
    estimate: np.ndarray,
    covariances: Sequence[np.ndarray],
    delta: np.ndarray,
    lawful: np.ndarray,
    fall: float,
    ahead: float,
    policy: SearchPolicy = DEFAULT,
    bounded: float = 0.0,
) -> Support:
    """Support of a refitted effect, in its own units, by the widest of its covariances (k, k).

    Where zero is likelier than its standard errors have it, they are widened to say so. Where it is less likely, as other
    values would have to leave their bounds for it, they are narrowed to say that, as far as what that costs, `bounded`,
    explains the fall."""
    size, covariance = estimate / delta, widest(covariances, delta)
    away = squared(size, covariance)
    factor = away / float(np.clip(fall, LEAST, max(away, bounded, LEAST))) if away > 0 else 1.0
    return support(effect, size, covariance * factor, lawful, fall, ahead, policy)


def widest(covariances: Sequence[np.ndarray], delta: np.ndarray) -> np.ndarray:
    """Of several covariances (k, k), that with the largest trace, in units of δ."""
    return max((c / np.outer(delta, delta) for c in covariances), key=np.trace)


def squared(estimate: np.ndarray, covariance: np.ndarray) -> float:
    """Of an estimate, in standard errors, along the directions that the data see."""
    axes, spread = seen_axes(covariance)
    return float(np.sum((axes.T @ estimate) ** 2 / spread))


def of_score(s: Score, lawful: np.ndarray, policy: SearchPolicy) -> Support:
    """Support of an effect that was not refitted, by its slope."""
    estimate = s.estimate / s.delta
    return support(s.effect, estimate, s.covariance, lawful, squared(estimate, s.covariance), policy=policy)
