"""How likely a fitted model made the runs that were held out, before they were seen.

A fit leaves some of its values uncertain: of a chair that only went straight, nobody knows how it turns. What such a value
changes in a held-out run is no error of the model. With the slopes S of its innovations r by the values, and the covariance C
that the fitted runs and priors leave these, innovations are normal about zero with the covariance I + S C Sᵀ. Block after block
is judged by what is known of the values once the blocks before it have been seen, so that all of them add up to the whole
(predictive likelihood of a linear model; Gelman et al. 2013, chapter 14).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..evidence.evidence import Evidence, RunEvidence, blocks_of
from .inverse import inverse
from .problem import Fit


def foretold_by(found: Fit, held: Evidence, prior: np.ndarray) -> Evidence:
    """Held-out runs, whose evidence has slopes by what a fit estimated, in its order, with how likely each block of them was;
    without these slopes, which are most of its memory. `prior` (k,) are inverse variances of what the fit took for unknown
    beforehand."""
    root, moved, runs = _root(found, prior), np.zeros(len(found.names)), list[RunEvidence]()
    for e in held.runs:
        places, told = blocks_of(e.run), list[float]()
        for rows in places:
            good = np.isfinite(e.r[rows])
            S = e.S[rows][good]
            r = e.r[rows][good] - S @ moved
            factor = np.linalg.cholesky(np.eye(len(root)) + root.T @ (S.T @ S) @ root)
            root = np.linalg.solve(factor, root.T).T
            step = root.T @ (S.T @ r)
            moved = moved + root @ step
            told.append(float(r @ r - step @ step) + 2 * float(np.log(np.diag(factor)).sum()))
        foretelling = np.array(told) + e.whitener.logdet / len(places)  # what filters differ in is spread over a run
        runs.append(replace(e, S=np.empty((*e.r.shape, 0)), foretelling=foretelling))
    return Evidence(tuple(runs), ())


def unforetold(found: Fit, held: Evidence, prior: np.ndarray) -> tuple[Evidence, dict[str, float]]:
    """Held-out runs, whose evidence has slopes by what a fit estimated, in its order, with the innovations that they leave once
    all values are as these runs want them, within what the fit leaves open; and by how much (RMS) each value moves them for
    that. `prior` is as in `foretold_by`."""
    root, S = _root(found, prior), held.S
    scaled = S @ root
    step = root @ np.linalg.solve(np.eye(len(root)) + scaled.T @ scaled, scaled.T @ held.r)
    left, runs = held.r - S @ step, list[RunEvidence]()
    for e, good, part in held.parts():
        r = np.full(e.r.shape, np.nan)
        r[good] = left[part]
        runs.append(replace(e, r=r, S=np.empty((*e.r.shape, 0))))
    moved = np.abs(step) * np.sqrt(np.mean(S**2, axis=0))
    return Evidence(tuple(runs), ()), dict(zip(found.names, moved.tolist(), strict=True))


def _root(found: Fit, prior: np.ndarray) -> np.ndarray:
    """A square root (k, k) of the values' covariance."""
    covariance = inverse(inverse(found.covariance) + np.diag(prior))
    sd = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    scale = np.divide(1.0, sd, out=np.zeros_like(sd), where=sd > 0)
    size, axes = np.linalg.eigh(covariance * np.outer(scale, scale))
    return sd[:, None] * axes * np.sqrt(np.maximum(size, 0.0))
