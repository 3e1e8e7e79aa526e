"""What acted on a run, given all of its readings: the smoothed states of a `Whitener`, by Bryson and Frazier's recursion.

The filter goes forward, and what later readings say of each moment comes back as one vector λ and one matrix Λ, so that no
covariance has to be inverted: x = x⁻ − P⁻ λ, P = P⁻ − P⁻ Λ P⁻ (Bierman 1973, "Fixed interval smoothing with discrete
measurements").
"""

from __future__ import annotations

import numpy as np

from .innovations import Whitener


def smoothed(
    filter_: Whitener, residual: np.ndarray, start_mean: np.ndarray, sums: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Posterior mean and standard deviation (n, d) of a filter's disturbances, in their units, or of `sums` (k, d) of them.

    `residual` (n, nz) is measured less simulated, `start_mean` (nx,) where the true start is expected, less the simulated one.
    """
    a = filter_.arrays
    (nx, nq, nz), n = filter_.size, len(residual)
    whole = nx + nq + nz
    first = np.zeros((whole, whole))
    first[:nx, :nx] = a["start_cov"]
    first[nx : nx + nq, nx : nx + nq] = a["common"] * np.outer(a["input_sd"][0], a["input_sd"][0])
    first[range(nx + nq, whole), range(nx + nq, whole)] = a["sd"] ** 2
    x, P = np.concatenate((start_mean, np.zeros(nq + nz))), first
    before: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []  # x and P that were expected, and the transition F to there
    seen: list[tuple[np.ndarray, ...]] = []  # of m readings H (m, size), Hᵀ S⁻¹, what is new, and what they leave of an error
    own, one, F = np.eye(nz), np.eye(whole), np.eye(whole)
    for i in range(n):
        if i:
            F, Q = _step(a, i - 1, nx, nq, nz)
            x, P = F @ x, F @ P @ F.T + Q
        before.append((x, P, F))
        z = np.nonzero(a["present"][i])[0]
        H = np.concatenate((a["H"][i, z], a["D"][i, z], own[z]), axis=1)
        back_H = np.linalg.solve(H @ P @ H.T, H).T if len(z) else H.T
        new = residual[i, z] - H @ x
        gain = P @ back_H
        kept = one - gain @ H
        seen.append((H, back_H, new, kept))
        x, P = x + gain @ new, kept @ P @ kept.T  # which stays positive where readings are all but exact (Bucy and Joseph 1968)
    there = slice(nx + filter_.recorded, nx + nq)
    sums = np.eye(nq - filter_.recorded) if sums is None else sums
    mean, sd = np.empty((n, len(sums))), np.empty((n, len(sums)))
    back, Back = np.zeros(whole), np.zeros((whole, whole))
    for i in range(n - 1, -1, -1):
        (x, P, F), (H, back_H, new, kept) = before[i], seen[i]
        back, Back = kept.T @ back - back_H @ new, kept.T @ Back @ kept + back_H @ H
        mean[i] = sums @ (x - P @ back)[there]
        left = P[there, there] - P[there] @ Back @ P[:, there]
        sd[i] = np.sqrt(np.maximum(np.einsum("ki,ij,kj->k", sums, left, sums), 0.0))
        back, Back = F.T @ back, F.T @ Back @ F
    return mean, sd


def _step(a: dict[str, np.ndarray], i: int, nx: int, nq: int, nz: int) -> tuple[np.ndarray, np.ndarray]:
    """The transition (size, size) from sample i to the next, and the covariance of what is new there."""
    whole, phi = nx + nq + nz, a["input_phi"][i]
    F = np.zeros((whole, whole))
    F[:nx, :nx] = a["A"][i]
    F[:nx, nx : nx + nq] = a["B"][i] + a["C"][i] * phi
    F[range(nx, whole), range(nx, whole)] = np.concatenate((phi, a["phi"][i]))
    G = np.concatenate((a["C"][i], np.eye(nq), np.zeros((nz, nq))))
    sd = a["input_sd"][i + 1]
    Q = G @ (a["common"] * (1 - np.outer(phi, phi)) * np.outer(sd, sd)) @ G.T
    Q[range(nx + nq, whole), range(nx + nq, whole)] += (1 - a["phi"][i] ** 2) * a["sd"] ** 2
    return F, Q
