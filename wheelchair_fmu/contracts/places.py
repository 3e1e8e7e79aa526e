"""Somewhere to evaluate a model: at random or at rest, in a mirror, with algebraic states where they belong."""

from __future__ import annotations

from dataclasses import dataclass

import casadi as cs
import numpy as np

from ..model.wheelchair import Model
from ..quantities import Quantity

NEWTON_STEPS = 10  # at most, that bring algebraic states to where their rows are zero
SOLVED = 1e-12  # N or m/s²: what may be left of an algebraic row


@dataclass(frozen=True)
class Place:
    """States (nx,), inputs (nw,), parameters (np,)."""

    x: np.ndarray
    w: np.ndarray
    p: np.ndarray


def evaluate(model: Model, place: Place, *what: cs.SX) -> list[np.ndarray]:
    function = cs.Function("evaluate", [model.x, model.w, model.p], list(what))
    values = function.call([place.x, place.w, place.p])
    return [np.array(v.full()).squeeze(-1) if v.shape[1] == 1 else v.full() for v in values]


def anywhere(model: Model, p: np.ndarray, rng: np.random.Generator, speed: float = 1.0, spread: float = 0.1) -> Place:
    """A random motion about `speed`, random pushes, and parameters off `p` by up to `spread`."""
    x = rng.normal(0, 0.3, model.x.numel())
    x[3] += speed
    w = np.array([i.start for i in model.inputs]) + rng.uniform(0, 0.5, len(model.inputs)) * np.array(
        [min(i.nominal, i.upper) for i in model.inputs]
    )
    loose = np.array([not q.choices for q in model.parameters])
    p = np.where(loose, p * (1 + spread * rng.uniform(-1, 1, len(p))), p)
    return Place(x, w, np.clip(p, [q.lower for q in model.parameters], [q.upper for q in model.parameters]))


def at_rest(model: Model, p: np.ndarray) -> Place:
    """All states zero, and inputs as they start."""
    return Place(np.zeros(model.x.numel()), np.array([i.start for i in model.inputs]), p)


class Settler:
    """Brings the algebraic states of a model, whose mass is zero, to where their rows are zero, by Newton's steps."""

    def __init__(self, model: Model):
        self._model = model
        self._mass = cs.Function("mass", [model.p], [cs.densify(model.mass)])
        self._steps: dict[tuple[int, ...], cs.Function] = {}

    def __call__(self, place: Place) -> tuple[Place, float]:
        """The place with these states, and how far their rows are from zero there (N or m/s²)."""
        places = np.flatnonzero(self._mass(place.p).full().ravel() == 0)
        if not len(places):
            return place, 0.0
        step, x = self._step(tuple(places.tolist())), place.x.copy()
        for _ in range(NEWTON_STEPS):
            change, rows = (v.full().ravel() for v in step.call([x, place.w, place.p]))
            if (left := float(abs(rows).max())) < SOLVED:
                break
            x[places] -= change
        return Place(x, place.w, place.p), left

    def _step(self, places: tuple[int, ...]) -> cs.Function:
        """Newton's change of these states, and what is left of their rows."""
        if places not in self._steps:
            m, rows = self._model, self._model.f[list(places)]
            change = cs.solve(cs.jacobian(rows, m.x[list(places)]), rows)
            self._steps[places] = cs.Function("step", [m.x, m.w, m.p], [change, rows])
        return self._steps[places]


def mirrored(records: tuple[Quantity, ...], values: np.ndarray) -> np.ndarray:
    """The values as a mirror along the chair shows them. Raises ValueError for a partner that is not there."""
    names = [n for r in records for n in r.names]
    out = np.empty_like(values)
    for record in records:
        sign, partner = (-1 if record.mirror[0] == "-" else 1), record.mirror[1:]
        places = [names.index(n) for n in record.names]
        if partner == "swap":
            others = places[::-1]
        elif partner:
            others = [names.index(n) for n in _partner(records, record, partner).names]
        else:
            others = places
        out[others] = sign * values[places]
    return out


def _partner(records: tuple[Quantity, ...], record: Quantity, partner: str) -> Quantity:
    """By full name, or by symbol within the same effect or group."""
    group = record.name.rpartition(".")[0]
    same = [r for r in records if r.name == partner or (r.symbol == partner and r.name.startswith(group))]
    if len(same) != 1:
        raise ValueError(f"{record.name} has no partner {partner}")
    return same[0]


def mirrored_place(model: Model, place: Place) -> Place:
    return Place(mirrored(model.states, place.x), mirrored(model.inputs, place.w), mirrored(model.parameters, place.p))
