"""No mass that an effect changes or shares with the chair falls below zero, or forces would drive what they hold back."""

from __future__ import annotations

import numpy as np

from .places import Place, anywhere, evaluate
from .subject import Breach, Subject

NAME = "inertia"


def inertia(subject: Subject) -> list[Breach]:
    """At their sizes of interest and at their bounds the effects leave M positive: its pivots are, by elimination."""
    model = subject.model
    place = anywhere(model, subject.values(1.0), np.random.default_rng(14), spread=0)
    known = {p.name: i for i, p in enumerate(model.parameters)}
    for ends in ("smallest_interesting", "upper", "lower"):
        p = place.p.copy()
        for effect in subject.effects:
            for q in effect.parameters:
                p[known[f"effect.{effect.id}.{q.name}"]] = getattr(q, ends)
        (masses,) = evaluate(model, Place(place.x, place.w, p), model.mass)
        names = [name for state in model.states for name in state.names]
        least = int(np.argmin(masses))
        if masses[least] < 0:
            sizes = ", ".join(f"{q.name} = {getattr(q, ends):g}" for effect in subject.effects for q in effect.parameters)
            fact = f"with {sizes} what resists a change of {names[least]} is {masses[least]:.3g}, below zero"
            return [subject.breach(NAME, fact, "narrow the bounds, or share less inertia with the chair than each has alone")]
    return []
