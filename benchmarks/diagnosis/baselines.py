"""What people do without the loop, on the same data and the same linearisation.

Each names one effect, or None where it would say that nothing is missing.
"""

from __future__ import annotations

import numpy as np

from wheelchair_fmu.errors import SimulationError
from wheelchair_fmu.inference.estimation.fit import fit
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.search.beginning import begin

BIC_MARGIN = 10.0  # "very strong" evidence, Kass and Raftery
CORRELATION = 0.1  # below which nobody would point at anything
THRESHOLD = 0.3  # of δ, of the sparse regression
ROUNDS = 10


def baselines(models: Models) -> dict[str, str | None]:
    """The effect that each method names, by the method's name."""
    begun = begin(models)
    w, base = begun.models.factory, begun.calibrated.fit
    names = [n for e in w.light for n in w.parameters(e)]
    evidence = begun.models.wide().evidence(w.campaign.fit, base.values, names)
    delta = np.array([w.records[n].smallest_interesting for n in names])
    owner = [n.split(".")[1] for n in names]
    return {
        "refit everything, BIC": _refit(begun.models, base),
        "residual correlation": _correlation(evidence.r, evidence.S, owner),
        "sparse regression": _sparse(evidence.r, evidence.S * delta, owner),
    }


def _refit(models: Models, base) -> str | None:
    """Fit every effect beside the calibrated values, and take the lowest BIC, as if residuals were independent."""
    w, best, lowest = models.factory, None, -BIC_MARGIN
    for effect in w.catalogue:
        own = w.parameters(effect)
        records = [w.records[n] for n in own]
        start = {**base.values, **{r.name: r.smallest_interesting for r in records}}
        try:
            found = fit(models.likelihood([effect]), models.names([effect]), start)
        except SimulationError:
            continue
        change = found.deviance - base.deviance + len(own) * np.log(len(found.evidence.r))
        if change < lowest:
            best, lowest = effect, change
    return best


def _correlation(r: np.ndarray, S: np.ndarray, owner: list[str]) -> str | None:
    """The effect whose own signature, calibration or not, correlates best with what is left."""
    length = np.linalg.norm(S, axis=0) * np.linalg.norm(r)
    c = np.abs(S.T @ r) / np.where(length > 0, length, np.inf)
    return owner[int(c.argmax())] if c.max() > CORRELATION else None


def _sparse(r: np.ndarray, S: np.ndarray, owner: list[str]) -> str | None:
    """Sequentially thresholded least squares on all signatures at once (Brunton, Proctor and Kutz 2016), largest first."""
    on = np.ones(S.shape[1], bool)
    q = np.zeros(S.shape[1])
    for _ in range(ROUNDS):
        if not on.any():
            return None
        q[:] = 0
        q[on] = np.linalg.lstsq(S[:, on], r, rcond=1e-8)[0]
        small = np.abs(q) < THRESHOLD
        if not (small & on).any():
            break
        on &= ~small
    return owner[int(np.argmax(np.abs(q)))] if on.any() else None
