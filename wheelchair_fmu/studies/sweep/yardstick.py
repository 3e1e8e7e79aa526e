"""Chairs against a campaign: the whitened RMS error, with starts and uncertainties found once beforehand."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import nan

import numpy as np

from ...campaign import Run
from ...errors import SimulationError
from ...model.variant import Variant
from ..measured import PREDICTS
from .engines import Engine, encoded


@dataclass(frozen=True, eq=False)
class Yardstick:
    """One recorded run, its pushes when the chair felt them: `errors` makes whitened errors (n, nz), NaN in gaps, of what
    was predicted (n, nz) for its `channels`. `known` is what the campaign says of the chair, over which a variant's values
    and the plan's go; `fixed`, what the run itself sets and where it starts, goes over everything."""

    run: Run
    channels: tuple[str, ...]
    errors: Callable[[np.ndarray], np.ndarray]
    known: Mapping[str, float]
    fixed: Mapping[str, float]


def whitened(engine: Engine, variant: Variant, runs: Sequence[Yardstick], values: Mapping[str, float]) -> dict[str, float]:
    """`rms`, `rms_fit` and `rms_holdout` of the chair with these values; NaN where there are no such runs.

    Raises SimulationError, naming the run, where it cannot be simulated.
    """
    errors: dict[str, list[np.ndarray]] = {"fit": [], "holdout": []}
    for y in runs:
        given = encoded(variant, {**y.known, **variant.values, **values, **y.fixed})
        try:
            results = engine.run(y.run.time, y.run.inputs, given)
        except SimulationError as error:
            raise SimulationError(f"run {y.run.name}: {error}") from error
        e = y.errors(np.stack([results[PREDICTS[c]] for c in y.channels], axis=1))
        errors[y.run.role].append(e[np.isfinite(e)])
    fit, holdout = errors["fit"], errors["holdout"]
    return {"rms": _rms([*fit, *holdout]), "rms_fit": _rms(fit), "rms_holdout": _rms(holdout)}


def _rms(errors: list[np.ndarray]) -> float:
    e = np.concatenate(errors) if errors else np.empty(0)
    return float(np.sqrt(e @ e / len(e))) if len(e) else nan
