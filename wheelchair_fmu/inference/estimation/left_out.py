"""How far a fit rests on single runs: what it would be without each of them (Belsley, Kuh and Welsch 1980)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .fit import Fit
from .inverse import inverse

TOLD = 1e-6  # of what all runs tell along a direction: others that tell less tell nothing


@dataclass(frozen=True)
class LeftOut:
    """A fit without one run, by one step along the others' slopes: by how much each of its values (n,) would be `moved`, how
    many times its standard error would be `wider` (n,), and the `deviance` of what is left. What the others tell nothing of
    stays where it is."""

    moved: np.ndarray
    wider: np.ndarray
    deviance: float


def left_out(found: Fit) -> dict[str, LeftOut]:
    """By name of each fitted run; none of a fit that has no slopes."""
    if found.evidence.by != found.names:
        return {}
    runs = [(e, e.S[e.finite]) for e in found.evidence.runs]
    whole = sum((S.T @ S for _, S in runs), found.prior_slopes**2)
    scale = np.sqrt(np.maximum(np.diag(whole), np.finfo(float).tiny))
    known = np.sqrt(np.maximum(np.diag(inverse(whole)), np.finfo(float).tiny))
    without = {}
    for e, S in runs:
        size, axes = np.linalg.eigh((whole - S.T @ S) / np.outer(scale, scale))
        told = np.maximum(size, TOLD)
        pull = np.where(size > TOLD, axes.T @ (S.T @ e.r[e.finite] / scale), 0.0)
        without[e.run.name] = LeftOut(
            moved=-(axes @ (pull / told)) / scale,
            wider=np.maximum(1.0, np.sqrt(axes**2 @ (1 / told)) / scale / known),
            deviance=found.deviance - e.deviance - float(pull @ (pull / told)),
        )
    return without
