"""Linear models with any noise, as evidence made of arrays: what a method says of them has a closed form or can be counted."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from scipy.signal import lfilter

from wheelchair_fmu.campaign import Run
from wheelchair_fmu.inference.estimation.problem import Fit
from wheelchair_fmu.inference.evidence.evidence import Evidence, FilterSummary, RunEvidence

STEP = 0.01  # s
CHANNELS = ("yaw_rate", "a_y", "a_x")


def noise(rng: np.random.Generator, shape: tuple[int, ...], rho: float = 0.0) -> np.ndarray:
    """AR(1) noise of unit variance, stationary from its first sample, along the first axis."""
    drive = rng.normal(size=shape) * np.sqrt(1 - rho**2)
    drive[0] /= np.sqrt(1 - rho**2)
    return lfilter([1.0], [1.0, -rho], drive, axis=0)


def signals(rng: np.random.Generator, runs: int, n: int, k: int, channels: int = 1) -> list[np.ndarray]:
    """Sensitivities (n, channels, k) of each run: waves of 0.5 to 4 s and a constant, each of its own size."""
    t = STEP * np.arange(n)[:, None, None, None]
    waves, found = 4, []
    for _ in range(runs):
        period, phase = rng.uniform(0.5, 4, (channels, k, waves)), rng.uniform(0, 2 * np.pi, (channels, k, waves))
        found.append(0.05 * (np.sin(2 * np.pi * t / period + phase).sum(axis=-1) + rng.normal(size=(channels, k))))
    return found


def evidence(residuals: Sequence[np.ndarray], slopes: Sequence[np.ndarray], by: Sequence[str], step: float = STEP) -> Evidence:
    """Runs with these innovations (n, nz), which are their errors as well, and these sensitivities (n, nz, k)."""
    runs = []
    for i, (r, S) in enumerate(zip(residuals, slopes, strict=True)):
        channels = CHANNELS[: r.shape[1]]
        run = Run(
            f"run {i}",
            Path(f"{i}.csv"),
            "drawn",
            "fit",
            None,
            {},
            step * np.arange(len(r)),
            {},
            dict(zip(channels, r.T, strict=True)),
        )
        none = np.zeros((*r.shape, 0))
        whitener = FilterSummary(0.0, np.ones(r.shape))
        runs.append(RunEvidence(run, channels, r, S, none, {}, np.zeros((len(r), 0)), 0 * r, r, whitener, np.zeros(0)))
    return Evidence(tuple(runs), tuple(by))


def least_squares(
    measured: Sequence[np.ndarray],
    slopes: Sequence[np.ndarray],
    by: Sequence[str],
    *,
    prior_sd: np.ndarray | None = None,
    keep: Sequence[int] | None = None,
    step: float = STEP,
) -> Fit:
    """The best parameters of  measured = slopes · θ + noise, and the evidence at them; `prior_sd` is that of θ about zero, and
    `keep` those that are free, the others being zero."""
    k = len(by)
    free = list(range(k)) if keep is None else list(keep)
    S = np.concatenate([s.reshape(-1, k) for s in slopes])[:, free]
    y = np.concatenate([m.ravel() for m in measured])
    prior = np.zeros((k, k)) if prior_sd is None else np.diag(1 / prior_sd)
    A = S.T @ S + prior[np.ix_(free, free)] ** 2
    theta = np.zeros(k)
    theta[free] = np.linalg.solve(A, S.T @ y)
    left = [m - s @ theta for m, s in zip(measured, slopes, strict=True)]
    found = evidence(left, slopes, by, step)
    whole = np.concatenate([s.reshape(-1, k) for s in slopes])
    covariance = np.linalg.pinv(whole.T @ whole + prior**2, hermitian=True)
    deviance = found.deviance + float(np.sum((prior @ theta) ** 2))
    return Fit(tuple(by), dict(zip(by, map(float, theta), strict=True)), covariance, found, deviance, prior)


def values(found: Fit) -> np.ndarray:
    return np.array([found.values[n] for n in found.names])
