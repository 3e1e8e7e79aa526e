"""How much of a diagnosis would another day's measurements change: blocks of the runs drawn again, with replacement.

Estimates move by one step of the fit's own equations with the drawn blocks' weights; refitted models keep their values and
are weighed anew. So a thousand resamples cost no simulation. Blocks are as long as `evidence.BLOCK` (Künsch 1989).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..estimation.problem import Fit
from ..estimation.statistics import decisive, difference_blocks
from ..evidence.evidence import Evidence, blocks_of
from ..search.rounds import Round
from .diagnosis import Diagnosis

INTERVAL = (0.025, 0.975)


@dataclass(frozen=True)
class Stability:
    """What a round of the search would say on resampled measurements, in shares of the resamples."""

    effect: str  # that it found
    first: Mapping[str, float]  # by effect: explains most
    tied: Mapping[str, float]  # by effect: within the margin of the effect found, or better
    predicts: float | None  # held-out gain above zero; None without held-out runs


@dataclass(frozen=True)
class Bootstrap:
    """Resampled diagnosis: its rounds, and (standard error, lower, upper) of each estimate of the final model (SI)."""

    resamples: int
    rounds: tuple[Stability, ...]
    estimates: Mapping[str, tuple[float, float, float]]

    def as_json(self) -> dict[str, object]:
        rounds = [
            {"effect": s.effect, "first": dict(s.first), "tied": dict(s.tied), "heldout_gain_positive": s.predicts}
            for s in self.rounds
        ]
        estimates = {n: {"se": se, "low": low, "high": high} for n, (se, low, high) in self.estimates.items()}
        return {"resamples": self.resamples, "rounds": rounds, "estimates": estimates}


def bootstrap(d: Diagnosis, resamples: int = 1000, seed: int = 0) -> Bootstrap:
    """Resample a diagnosis; the same `seed` draws the same blocks."""
    rng = np.random.default_rng(seed)
    final = d.top
    rounds = {r.winner.effect: r for r in (*d.rounds, *d.beside) if r.winner and r.winner.effect in d.included}
    stable = tuple(_stability(r, rng, resamples) for r in rounds.values())
    return Bootstrap(resamples, stable, _estimates(final, rng, resamples))


def _weights(blocks: int, rng: np.random.Generator, resamples: int) -> np.ndarray:
    """How often each block is drawn (resamples, blocks)."""
    return rng.multinomial(blocks, np.full(blocks, 1 / blocks), resamples).astype(float)


def _stability(r: Round, rng: np.random.Generator, resamples: int) -> Stability:
    leader = r.winner
    assert leader is not None
    candidates = [c for c in r.candidates if c.lawful]
    drops = np.stack([_likelihood_blocks(r.fit.evidence, c.fit.evidence) for c in candidates], axis=1)
    drawn = _weights(len(drops), rng, resamples) @ drops  # (resamples, candidates)
    best, own = drawn.argmax(axis=1), drawn[:, [c.effect for c in candidates].index(leader.effect)]
    near = drawn >= own[:, None] - decisive(leader.fit.evidence)
    predicts = None
    if leader.heldout is not None and leader.heldout.runs:
        gains = difference_blocks(r.heldout, leader.heldout)
        predicts = float(np.mean(_weights(len(gains), rng, resamples) @ gains > 0))
    first = {c.effect: float(np.mean(best == i)) for i, c in enumerate(candidates)}
    tied = {c.effect: float(near[:, i].mean()) for i, c in enumerate(candidates) if c is not leader}
    return Stability(leader.effect, first, tied, predicts)


def _likelihood_blocks(one: Evidence, other: Evidence) -> np.ndarray:
    """Falls of −2 log likelihood from one model to another, by blocks; what filters differ in is spread over a run's."""
    out, at = difference_blocks(one, other), 0
    for a, b in zip(one.runs, other.runs, strict=True):
        count = len(blocks_of(a.run))
        out[at : at + count] += (a.whitener.logdet - b.whitener.logdet) / count
        at += count
    return out


def _estimates(found: Fit, rng: np.random.Generator, resamples: int) -> dict[str, tuple[float, float, float]]:
    if not found.names:
        return {}
    G, g = _normal_equations(found.evidence)
    weights = _weights(len(G), rng, resamples)
    A = np.tensordot(weights, G, axes=1) + found.prior_slopes**2
    surplus = (weights - 1) @ g  # at the fit, all blocks once balance the prior, which is one more measurement
    surplus += rng.standard_normal(surplus.shape) @ found.prior_slopes
    steps = np.linalg.solve(A, surplus[:, :, None])[:, :, 0]
    low, high = np.quantile(steps, INTERVAL, axis=0)
    return {
        n: (float(se), found.values[n] + float(a), found.values[n] + float(b))
        for n, se, a, b in zip(found.names, steps.std(axis=0), low, high, strict=True)
    }


def _normal_equations(evidence: Evidence) -> tuple[np.ndarray, np.ndarray]:
    """Sᵀ S (blocks, k, k) and Sᵀ r (blocks, k)."""
    G, g = [], []
    for e in evidence.runs:
        S, r = np.where(np.isfinite(e.r)[:, :, None], e.S, 0), np.nan_to_num(e.r)
        for rows in blocks_of(e.run):
            part = S[rows].reshape(-1, S.shape[2])
            G.append(part.T @ part)
            g.append(part.T @ r[rows].ravel())
    return np.array(G), np.array(g)
