"""How far a fit rests on single runs: what it would be without each of them (Belsley, Kuh and Welsch 1980)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .problem import Fit

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
    scale = np.sqrt(np.where(np.diag(whole) > 0, np.diag(whole), 1.0))  # of what no run tells, any will do
    *_, known = _told(whole, scale)
    without = {}
    for e, S in runs:
        size, axes, sure = _told(whole - S.T @ S, scale)
        told = np.maximum(size, TOLD)
        pull = np.where(size > TOLD, axes.T @ (e.pull / scale), 0.0)
        without[e.run.name] = LeftOut(
            moved=-(axes @ (pull / told)) / scale,
            wider=np.maximum(1.0, sure / known),
            deviance=found.deviance - e.deviance - float(pull @ (pull / told)),
        )
    return without


def _told(information: np.ndarray, scale: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What is told along each axis (n,), the axes (n, n), and standard errors (n,), of values measured on such a scale (n,)."""
    size, axes = np.linalg.eigh(information / np.outer(scale, scale))
    return size, axes, np.sqrt(axes**2 @ (1 / np.maximum(size, TOLD)))
