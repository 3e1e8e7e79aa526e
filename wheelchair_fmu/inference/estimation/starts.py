"""Which of many values to start a refit from: those from which one linear step would fall furthest."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ...errors import SimulationError
from ..evidence.evidence import Evidence
from ..evidence.likelihood import Likelihood
from ..parallel import parallel_map
from .inverse import inverse
from .problem import Problem

GLANCED = 2  # runs on which all are tried, and of them
LOOKED_AT = 2  # times as many as are wanted on every run


@dataclass(frozen=True)
class Outlook:
    """Where one linear step from `theta` leads, within bounds, and the squares that slopes promise, with the prior's."""

    deviance: float
    theta: tuple[float, ...]
    reached: tuple[float, ...]


def outlook(likelihood: Likelihood, known: Evidence, names: Sequence[str], theta: Iterable[float]) -> Outlook:
    """The step goes by those of `names`, the first, that `known` has slopes by; the deviance is infinite where the model cannot
    run."""
    at = tuple(map(float, theta))
    try:
        r = likelihood.resimulated(known, dict(zip(names, at, strict=True)), whole=False).r
    except SimulationError:
        return Outlook(float("inf"), at, at)
    problem = Problem(likelihood, names)
    rows, slopes = problem.prior.rows(np.array(at)), problem.prior.slopes
    Z, k = known.S, len(known.by)  # without the effect's own slope, which is not what it is at zero
    g = Z.T @ r + (slopes @ rows)[:k]
    step = inverse(Z.T @ Z + slopes[:k, :k] ** 2) @ g
    reached = np.clip(np.array(at[:k]) + step, problem.lower[:k], problem.upper[:k])
    return Outlook(float(r @ r + rows @ rows - g @ step), at, (*map(float, reached), *at[k:]))


def most_promising(
    likelihood: Likelihood,
    known: Evidence,
    names: Sequence[str],
    tries: Iterable[Sequence[float]],
    wanted: int,
    weight: np.ndarray,
    kind: Callable[[tuple[float, ...]], object] | None = None,
) -> list[Outlook]:
    """The best of `tries`, best first; with a `kind`, or of where a step from them leads, but no two that have values of one
    kind beyond those that slopes are known by. Where there are many, all are tried on the few runs only in which `weight`
    (N,), which says where to look, has most of its length."""
    thetas = sorted({tuple(map(float, theta)) for theta in tries})
    shares = [float(weight[part] @ weight[part]) for _, _, part in known.parts()]
    if len(thetas) > LOOKED_AT * wanted and len(shares) > GLANCED:
        telling = sorted(np.argsort(shares, kind="stable")[-GLANCED:])
        few = Evidence(tuple(known.runs[i] for i in telling), known.by)
        glanced = _ranked(likelihood, few, names, thetas)
        of_each = _of_each(glanced, lambda o: kind(o.theta[len(known.by) :]), LOOKED_AT) if kind else glanced
        thetas = [o.theta for o in of_each[: LOOKED_AT * wanted]]
    near = _ranked(likelihood, known, names, thetas)[: LOOKED_AT * wanted]
    if kind is None:
        return near[:wanted]
    further = _ranked(likelihood, known, names, (o.reached for o in near if np.isfinite(o.deviance)))
    return _of_each(sorted([*near, *further], key=_deviance), lambda o: kind(o.theta[len(known.by) :]), 1)[:wanted]


def _of_each(ranked: Iterable[Outlook], kind: Callable[[Outlook], object], most: int) -> list[Outlook]:
    """The first so many of each kind."""
    seen: Counter[object] = Counter()
    found = []
    for o in ranked:
        seen[kind(o)] += 1
        if seen[kind(o)] <= most:
            found.append(o)
    return found


def _ranked(likelihood: Likelihood, known: Evidence, names: Sequence[str], thetas: Iterable[Sequence[float]]) -> list[Outlook]:
    return sorted(parallel_map(lambda theta: outlook(likelihood, known, names, theta), thetas), key=_deviance)


def _deviance(o: Outlook) -> tuple[float, tuple[float, ...]]:
    return o.deviance, o.theta
