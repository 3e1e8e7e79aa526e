"""Chairs against a campaign: the whitened RMS error, with starts and uncertainties found once beforehand."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import nan

import numpy as np

from ...campaign import Run
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


def whitened(
    engine: Engine, variant: Variant, runs: Sequence[Yardstick], chairs: Sequence[Mapping[str, float]]
) -> tuple[dict[str, np.ndarray], list[str | None]]:
    """`rms`, `rms_fit` and `rms_holdout` (chairs,) of the chairs with these values, NaN where there are no such runs; and why
    one has none, naming the first run that cannot be simulated."""
    channels = list(dict.fromkeys(channel for y in runs for channel in y.channels))  # of all runs: one library for all
    errors: list[dict[str, list[np.ndarray]]] = [{"fit": [], "holdout": []} for _ in chairs]
    why: list[str | None] = [None] * len(chairs)
    for y in runs:
        given = [encoded(variant, {**y.known, **variant.values, **values, **y.fixed}) for values in chairs]
        found = engine.run(y.run.time, y.run.inputs, given, [PREDICTS[c] for c in channels])
        own = [channels.index(c) for c in y.channels]
        for i, error in enumerate(found.errors):
            if error:
                why[i] = why[i] or f"run {y.run.name}: {error}"
            else:
                e = y.errors(found.results[i, own].T)
                errors[i][y.run.role].append(e[np.isfinite(e)])
    roles = {"rms": ("fit", "holdout"), "rms_fit": ("fit",), "rms_holdout": ("holdout",)}
    return {
        name: np.array(
            [nan if bad else _rms([e for role in of for e in some[role]]) for some, bad in zip(errors, why, strict=True)]
        )
        for name, of in roles.items()
    }, why


def _rms(errors: list[np.ndarray]) -> float:
    e = np.concatenate(errors) if errors else np.empty(0)
    return float(np.sqrt(e @ e / len(e))) if len(e) else nan
