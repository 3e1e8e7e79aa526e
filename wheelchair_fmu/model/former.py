"""Names that parameters had before: still read, with a note that says the name and the value of today.

What two of them did is done by combinations now (see `sides`). A value for one of them alone leaves the other as it was.
"""

from __future__ import annotations

import warnings
from collections.abc import Container, Iterable, Iterator, Mapping
from functools import cache
from typing import Any

import numpy as np

from ..errors import FormerName, UsageError
from ..quantities import Parameter
from .effects import bundled


@cache
def replaced() -> dict[str, tuple[Parameter, ...]]:
    """The parameters, under full names, that stand in place of each former name."""
    found: dict[str, tuple[Parameter, ...]] = {}
    for id, effect in bundled().items():
        for p in effect.owned:
            for name, _ in p.formerly:
                found[f"effect.{id}.{name}"] = (*found.get(f"effect.{id}.{name}", ()), p)
    return found


def former(names: Iterable[str], known: Container[str] = ()) -> Iterator[tuple[str, tuple[Parameter, ...]]]:
    """Those of the names that are former ones, and not `known` besides, each with what stands in its place."""
    return ((n, replaced()[n]) for n in names if n in replaced() and n not in known)


def clash(names: Iterable[str]) -> str:
    """The fact and the cure where a former name is given beside what has replaced it; "" where none is."""
    names = list(names)
    for name, instead in former(names):
        if beside := [p.name for p in instead if p.name in names]:
            both = " and ".join(p.name for p in instead)
            return f"{name} is the former name of a part of {beside[0]}, and both are given; give {both} only"
    return ""


def renamed(
    values: Mapping[str, Any], now: Mapping[str, float], known: Container[str] = ()
) -> tuple[dict[str, Any], list[str]]:
    """The values by today's names, and a note on each former one; `now` are the values without these. Names that are `known`
    stay as they are.

    Raises UsageError for a former name beside what has replaced it, and for a value of one that is no number.
    """
    found, notes = {n: v for n, v in values.items() if n in known or n not in replaced()}, []
    old = dict(former(values, known))
    if fact := clash([*found, *old]):
        raise UsageError(fact)
    for instead in dict.fromkeys(old.values()):
        names = [f"{instead[0].name.rpartition('.')[0]}.{name}" for name, _ in instead[0].formerly]
        weights = np.array([[weight for _, weight in p.formerly] for p in instead])
        before = np.linalg.solve(weights, [now.get(p.name, p.default) for p in instead])
        given = [_number(n, values[n]) if n in values else float(b) for n, b in zip(names, before, strict=True)]
        new = {p.name: float(v) for p, v in zip(instead, weights @ given, strict=True)}
        found |= new
        told = " and ".join(f"{p.name} = {new[p.name]:.6g}{p.unit.behind}" for p in instead)
        by = [n for n in names if n in values]
        notes.append(f"{' and '.join(by)}: former name{'s' if len(by) > 1 else ''}, read as {told}")
    return found, notes


def current(values: Mapping[str, Any], now: Mapping[str, float], known: Container[str] = ()) -> dict[str, Any]:
    """As `renamed`; the notes are warnings."""
    found, notes = renamed(values, now, known)
    for note in notes:
        warnings.warn(note, FormerName, stacklevel=3)
    return found


def _number(name: str, value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        raise UsageError(f"{name} = {value!r} is not a number; give a number") from None
