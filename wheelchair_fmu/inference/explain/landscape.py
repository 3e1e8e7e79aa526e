"""The likelihood about the estimates, for drawing: by each size alone, and by the sizes of two rivals together.

Everything else is where these sizes let it be. Heights are −2 log likelihood above the lowest, shrunk as intervals are widened
for residuals that last, runs that disagree and effects that nobody named, so that 95 % of one size lie below 3.84; of two,
where the last of these does not count, below 5.99. Rivals that are tied are drawn to where they would be told apart.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from ...errors import SimulationError
from ...model.variant import effects_in
from ..chance import chance_beyond, value_beyond
from ..estimation.interval import LEVEL, NORMAL, half_width, profile
from ..estimation.problem import Fit
from ..estimation.statistics import finite
from ..evidence.likelihood import Likelihood
from ..models.factory import ModelFactory
from ..models.models import Models
from ..parallel import parallel_map

ALONG = np.linspace(-1.6, 1.6, 13)  # half widths of the interval, about an estimate
ROUNDS = 3  # linearisations that lead to two sizes together
ABOUT = np.linspace(-3.6, 3.6, 9)  # standard deviations along either axis of two sizes


@threadpool_limits.wrap(limits=1)  # as in diagnose: BLAS threads would only wait for one another
def landscape(models: Models, told: Mapping[str, Any]) -> dict[str, Any]:
    """`profiles` of the effects that a diagnosis found, and the `pair` of the first that has a rival, None without one.

    A profile has `parameter`, `estimate`, `values` (SI) and their `heights`, and `level`, below which 95 % lie. A pair has
    `effects` and `parameters` of two rivals, `best` (2,), `axes` (2, 2), whose columns are the two directions of the grid in
    SI units, the grid's steps `about` (n,) along both, `heights` (n, n) by rows of the second, `level`, below which the
    `share` lies, `middle`, below which 50 % lie, and `alone_heights` (2,), where one is in and not the other. There are neither
    where the last model cannot be simulated; a height is None where no model can be.
    """
    factory = models.factory
    effects, values = [e for e in told["effects"] if e in factory.catalogue], told["models"][-1]["values"]
    names = [n for n in factory.calibrated if n in values] + [n for n in values if n.startswith("effect.")]
    likelihood = models.likelihood(effects_in(names))
    names = [n for n in names if n in likelihood.records]
    own = [n for e in effects for n in factory.parameters(e) if n in names]
    if not own:
        return {"profiles": [], "pair": None}
    try:
        found = models.restarted(likelihood, names, values)
        return {
            "profiles": [_profile(likelihood, found, n, _interval(told, n)) for n in own],
            "pair": _pair(models, told, effects, found),
        }
    except SimulationError:
        return {"profiles": [], "pair": None}


def _interval(told: Mapping[str, Any], name: str) -> Sequence[float] | None:
    """That which the diagnosis has of an effect's parameter."""
    _, effect, short = name.split(".")
    return next((r["parameters"].get(short, {}).get("interval") for r in told["ranking"] if r["effect"] == effect), None)


def _profile(likelihood: Likelihood, found: Fit, name: str, interval: Sequence[float] | None) -> dict[str, Any]:
    at, record = found.names.index(name), likelihood.records[name]
    half, deviance = (interval[1] - interval[0]) / 2 if interval else half_width(found, at), profile(likelihood, found, (at,))
    values = np.unique(np.clip(found.values[name] + half * ALONG, record.lower, record.upper))
    heights = np.array(parallel_map(lambda v: deviance((v,)), values)) - found.deviance
    ends = [v for v in interval or () if record.lower < v < record.upper]
    shrunk = _above(heights * (_to_level([deviance((v,)) - found.deviance for v in ends]) or _robust(found, at)))
    return {
        "parameter": name,
        "estimate": found.values[name],
        "values": values.tolist(),
        "heights": [finite(float(h)) for h in shrunk],
        "level": value_beyond(1 - LEVEL, 1),
    }


def _to_level(at_ends: Sequence[float]) -> float | None:
    """What brings heights to the level where the diagnosis' interval ends: by how much runs differ is found from few of them,
    and comes out another time a little otherwise. None where they have no height there to go by."""
    seen = [h for h in at_ends if np.isfinite(h) and h > 0]
    return value_beyond(1 - LEVEL, 1) / float(np.mean(seen)) if seen else None


def _above(heights: np.ndarray) -> np.ndarray:
    """Heights from the lowest: a fit ends where slopes promise little more, which may be a little above it."""
    return heights - min(0.0, float(heights.min()))


def _robust(found: Fit, at: int) -> float:
    """Variance as slopes have it, beside that which intervals are made of."""
    return float(found.covariance[at, at] / (half_width(found, at) / NORMAL) ** 2)


def _pair(models: Models, told: Mapping[str, Any], effects: Sequence[str], base: Fit) -> dict[str, Any] | None:
    """The sizes of an effect and of its rival, fitted together: in a tie the other one of it, else what looks most alike."""
    factory = models.factory
    one, other = _rivals(factory, told, effects)
    if other is None:
        return None
    likelihood = models.likelihood((*effects_in(base.names), other))
    pair = (factory.parameters(one)[0], factory.parameters(other)[0])
    found = models.restarted(likelihood, list(dict.fromkeys((*base.names, *pair))), base.values, most=ROUNDS)
    at = [found.names.index(n) for n in pair]
    records = [likelihood.records[n] for n in pair]
    best, scale = np.array([found.values[n] for n in pair]), np.array([r.smallest_interesting for r in records])
    shrunk = min(_robust(found, i) for i in at)
    size, axes = np.linalg.eigh(found.covariance[np.ix_(at, at)] / np.outer(scale, scale) / shrunk)
    axes = scale[:, None] * axes * np.sqrt(size)
    deviance = profile(likelihood, found, at, corrections=1)
    grid = [best + axes @ (u, v) for v in ABOUT for u in ABOUT]

    def height(point: np.ndarray) -> float:
        inside = all(r.lower <= v <= r.upper for r, v in zip(records, point, strict=True))
        return (deviance(point) - found.deviance) * shrunk if inside else np.inf

    alone, heights = np.split(_above(np.array(parallel_map(height, [*_alone(told, pair), *grid]))), [len(pair)])
    level = models.policy.tied if any({one, other} <= set(group) for group in told["ties"]) else value_beyond(1 - LEVEL, 2)
    return {
        "effects": [one, other],
        "parameters": list(pair),
        "best": best.tolist(),
        "axes": axes.tolist(),
        "about": ABOUT.tolist(),
        "heights": [[finite(float(h)) for h in row] for row in heights.reshape(len(ABOUT), -1)],
        "level": level,
        "share": 1 - chance_beyond(level, 2),
        "middle": value_beyond(0.5, 2),
        "alone_heights": [finite(float(h)) for h in alone],
    }


def _alone(told: Mapping[str, Any], pair: Sequence[str]) -> list[np.ndarray]:
    """The sizes (2,) of a pair where one of it is in, as it was fitted, and the other is not; for each of the two."""
    rows = {r["effect"]: r["parameters"] for r in told["ranking"]}
    sizes = [rows[effect][short]["estimate"] for _, effect, short in (name.split(".") for name in pair)]
    return list(np.diag(sizes))


def _rivals(factory: ModelFactory, told: Mapping[str, Any], effects: Sequence[str]) -> tuple[str, str | None]:
    """An effect of the model, and the one that it is told from least well."""
    model = set(effects_in(told["models"][-1]["values"]))
    for group in told["ties"]:
        if len(group) > 1 and set(group) & model and set(group) <= factory.catalogue.keys():
            one = next(e for e in group if e in model)
            return one, next((e for e in group if e not in model), next(e for e in group if e != one))
    for row in told["ranking"]:
        if row["effect"] in effects and row["effect"] in model and factory.parameters(row["effect"]):
            alike = (r["effect"] for r in row["rivals"] if r["effect"] in factory.catalogue and factory.parameters(r["effect"]))
            return row["effect"], next(alike, None)
    return "", None
