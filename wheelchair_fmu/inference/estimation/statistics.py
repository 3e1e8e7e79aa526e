"""What the evidence is worth: robust variances, independent samples, bootstraps of what was held out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import takewhile

import numpy as np
from scipy.optimize import lsq_linear

from ..chance import student
from ..evidence.evidence import Evidence, RunEvidence, blocks_of
from ..policy import DEFAULT, SearchPolicy
from .inverse import inverse
from .problem import Fit
from .score import SEEN, Score, robust_variance

RESAMPLES = 400
CLOSE = 1e-9  # standard errors: as good as at a bound
TINY = 1e-300
SINGULAR = 1e-12  # of the widest direction's variance: what is so narrow beside it was not seen at all
ALONE = 1e-6  # of what a run decides, left to the others: it decides alone


def finite(value: float) -> float | None:
    """A number as JSON has it: None where there is none."""
    return float(value) if np.isfinite(value) else None


def cosines(ones: Sequence[Score], others: Sequence[Score]) -> np.ndarray:
    """Cosines (m, n) between the signatures of effects, of one model on the same runs; 0 where an effect has none."""
    length = max((len(s.signature) for s in (*ones, *others)), default=0)

    def signatures(scores: Sequence[Score]) -> np.ndarray:
        found = np.zeros((len(scores), length))
        for row, s in zip(found, scores, strict=True):
            row[: len(s.signature)] = s.signature
        return found

    return abs(signatures(ones) @ signatures(others).T)


def sandwich(found: Fit) -> np.ndarray:
    """Covariance (k, k) of the estimates that allows for correlated residuals."""
    S, r = found.evidence.S, found.evidence.r
    known = _inverse(found)
    return known @ (robust_variance(found.evidence, S, r) + found.prior_slopes**2) @ known


def _inverse(found: Fit) -> np.ndarray:
    """Of Sᵀ S (k, k), and the prior's."""
    S = found.evidence.S
    return inverse(S.T @ S + found.prior_slopes**2)


def standard_errors(found: Fit) -> dict[str, float]:
    """Of all that a fit estimated, by name, as `sandwich` has them."""
    return dict(zip(found.names, map(float, np.sqrt(np.diag(sandwich(found)))), strict=True))


def between_runs(found: Fit) -> np.ndarray:
    """Covariance (k, k) of the estimates by how far runs would have them apart, which shows where a model is not exact: all
    residuals of a run may err together (Bell and McCaffrey 2002, so that few runs are no reason to be sure)."""
    known = _inverse(found)
    total = np.zeros_like(known)
    for e, (_, Q, R, root) in zip(found.evidence.runs, _decided(found, known), strict=True):
        told = Q.T @ e.r[e.finite] + (0.0 if e.beyond is None else np.linalg.pinv(R.T) @ e.beyond)
        pull = R.T @ root @ told
        total += np.outer(pull, pull)
    return known @ total @ known


def degrees_between_runs(found: Fit, at: int) -> float:
    """Degrees of freedom of one of these variances, by Satterthwaite: one less than there are runs where all decide alike, and
    fewer where a few of them decide most (Bell and McCaffrey 2002). One of what no run tells anything of."""
    known, squares, pulls = _inverse(found), [], []
    for _, _, R, root in _decided(found, known):
        weight = root @ (R @ known[:, at])  # of the run's residuals in the estimate
        squares.append(float(weight @ weight))
        pulls.append(R.T @ weight)
    G = np.diag(squares) - np.array(pulls) @ known @ np.array(pulls).T
    return max(1.0, float(np.trace(G) ** 2 / np.sum(G * G))) if G.any() else 1.0


def _decided(found: Fit, known: np.ndarray) -> Iterator[tuple[slice, np.ndarray, np.ndarray, np.ndarray]]:
    """Of each run its place, the factors Q R of its sensitivities, and what makes up, in Q's directions, for what the run
    itself decides of the estimates and so takes off its residuals."""
    for _, _, part in found.evidence.parts():
        Q, R = np.linalg.qr(found.evidence.S[part])
        size, axes = np.linalg.eigh(np.eye(len(R)) - R @ known @ R.T)  # what the other runs leave it to decide
        yield part, Q, R, (axes / np.sqrt(np.maximum(size, ALONE))) @ axes.T


def estimates(found: Fit, names: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
    """Values (k,) of some of a fit's parameters, and their `sandwich` (k, k)."""
    at = [found.names.index(n) for n in names]
    return np.array([found.values[n] for n in names]), sandwich(found)[np.ix_(at, at)]


def bounded(found: Fit, own: Sequence[int], size: np.ndarray, covariance: np.ndarray) -> float:
    """By how much −2 log likelihood rises, as slopes and the `covariance` (n, n) of a fit's values have it, where its `own`
    ones, which are off by `size` (k,), are as in a model without them, all others being as likely as they may within the fit's
    bounds. Without bounds that is the size in standard errors, squared; a bound that is in the way makes it more. 0 of a fit
    without bounds."""
    others = [i for i in range(len(found.names)) if i not in own]
    if found.lower is None or found.upper is None or not others:
        return 0.0
    theta = np.array([found.values[n] for n in found.names])
    sd = np.sqrt(np.maximum(np.diag(covariance), TINY))
    width, axes = np.linalg.eigh(covariance / np.outer(sd, sd))
    seen = width > SINGULAR * width[-1]
    root = axes[:, seen].T / np.sqrt(width[seen])[:, None]
    moved = root[:, own] @ (size / sd[own])
    ends = [((end - theta) / sd)[others] for end in (found.lower, found.upper)]
    best = lsq_linear(root[:, others], moved, bounds=(np.minimum(ends[0], -CLOSE), np.maximum(ends[1], CLOSE)))
    return 2 * float(best.cost)


def seen_directions(size: np.ndarray, covariance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Sizes and variances, in units of δ, along the directions that the data can see at all (one at least)."""
    axes, spread = seen_axes(covariance)
    return axes.T @ size, spread


def seen_axes(covariance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The directions (k, m) that the data can see at all, one at least, and the variances along them, in units of δ."""
    spread, axes = np.linalg.eigh(covariance)
    spread = np.maximum(spread, 1e-12)
    seen = (spread < 1 / SEEN) | (spread == spread.min())
    return axes[:, seen], spread[seen]


def correlation_time(evidence: Evidence) -> float:
    """Samples per independent one: 1 + 2 Σ ρ_k of the innovations until ρ falls below noise, at least 1."""
    time, weight = 0.0, 0
    for e in evidence.runs:
        for i in range(e.r.shape[1]):
            r = e.r[np.isfinite(e.r[:, i]), i]  # from reading to reading: rows of other loggers are no residuals of zero
            if r.any():
                time, weight = time + len(r) * (1 + 2 * _lasting(r)), weight + len(r)
    return max(1.0, time / max(weight, 1))


def _lasting(r: np.ndarray) -> float:
    """Σ ρ_k of a series (n,) until ρ falls below noise, which it soon does."""
    n, power = len(r), float(r @ r)
    rho = (float(r[k:] @ r[:-k]) / power for k in range(1, min(n // 4, 100)))
    return sum(takewhile(lambda value: value >= 2 / np.sqrt(n), rho))


def decisive(evidence: Evidence, policy: SearchPolicy = DEFAULT) -> float:
    """By how much −2 log likelihood has to differ, with residuals as correlated as these, for decisive odds."""
    return policy.tied * correlation_time(evidence)


def margin(evidence: Evidence, policy: SearchPolicy = DEFAULT) -> float:
    """The same where residuals are not as large as the noise has it: `decisive`, times their mean square."""
    return decisive(evidence, policy) * float(np.mean(evidence.r**2))


def held_out_gain(before: Evidence, after: Evidence) -> tuple[float, float, float]:
    """Fall of −2 log likelihood on held-out runs, with a 95 % interval by how far blocks of time differ."""
    blocks = difference_blocks(before, after)
    n, fall = len(blocks), float(blocks.sum())
    if not n:
        return 0.0, 0.0, 0.0
    half = student(0.95, n - 1) * float(blocks.std(ddof=1)) * n**0.5 if n > 1 else np.inf
    return fall, fall - half, fall + half


def resampled_totals(blocks: np.ndarray) -> np.ndarray:
    """Bootstrap totals (RESAMPLES,) of blocks drawn with replacement, the same draws each time."""
    draws = np.random.default_rng(0).integers(0, len(blocks), (RESAMPLES, len(blocks)))
    return blocks[draws].sum(axis=1)


def difference_blocks(one: Evidence, other: Evidence) -> np.ndarray:
    """How much less likely one model makes runs than the other, in −2 log likelihood, by blocks of time: summed squared
    innovations of fitted runs; of those that were held out see `foretelling`."""
    pairs = zip(one.runs, other.runs, strict=True)
    return np.concatenate([_of_blocks(a) - _of_blocks(b) for a, b in pairs] or [np.empty(0)])


def _of_blocks(e: RunEvidence) -> np.ndarray:
    """−2 log likelihood (m,) of each block of a run."""
    if e.foretelling is not None:
        return e.foretelling
    return np.array([np.nansum(e.r[rows] ** 2) for rows in blocks_of(e.run)])
