"""An effect's laws keep units: in other units of mass, length and time every term changes as the unit of what it acts on says.

Each law is evaluated where a chair may be, once in SI and again with every number that it reads in other units.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import log

import numpy as np

from ..model.dimensions import named
from ..quantities import Parameter
from .laws import Line, Values, lines, values_at
from .places import anywhere
from .subject import Breach, Subject

SCALES = ((1.7, 0.6, 2.3), (0.4, 1.9, 1.3), (2.1, 1.4, 0.7))  # how much smaller the units of kg, m, s are
SINGLE = 1.7  # the same, of one unit alone
PLACES = 3
NEAR = 1e-9
MIXED = "it adds unlike quantities, or a plain number stands where a quantity with a unit belongs"
NAME_IT = (
    "make such a number one of the effect's constants=(Parameter(name, unit, meaning, default=...),), or in an "
    "expression write its unit behind it, as in 0.1 [m/s]"
)


def units(subject: Subject) -> list[Breach]:
    """Every line of every effect whose unit is not what its place needs."""
    seeds = map(np.random.default_rng, range(PLACES))
    places = [values_at(subject, anywhere(subject.model, subject.values(1.0), rng)) for rng in seeds]
    found = []
    for effect in subject.effects:
        for line in lines(subject, effect):
            fault = fault_of(
                line, (*effect.parameters, *effect.constants), [{**place[effect.id], **line.fixed} for place in places]
            )
            found += [Breach(effect.id, "units", *fault)] if fault else []
    return found


def fault_of(line: Line, own: Sequence[Parameter], places: Sequence[Values]) -> tuple[str, str] | None:
    """What is wrong with a line's unit and how to mend it, perhaps by the units of `own` parameters; None if all is well."""
    if all(_agrees(_scaled(line, at, kms), line.at(at) * line.unit.scale(*kms)) for at in places for kms in SCALES):
        return None
    exponents = _exponents(line, places)
    if exponents is None:
        return f"{line.words} has no unit, but {line.unit.name} belongs there: {MIXED}", NAME_IT
    return (
        f"{line.words} comes out in {named(*exponents).name} where {line.unit.name} belongs",
        _cure(line, own, places[0], exponents),
    )


def _cure(line: Line, own: Sequence[Parameter], at: Values, exponents: Sequence[int]) -> str:
    own = [p for p in own if p.symbol in line.symbols]
    if len(own) == 1 and _agrees(line.at({**at, own[0].symbol: 2 * at[own[0].symbol]}), 2 * line.at(at)):
        has, needs = own[0].unit, line.unit
        wanted = needs.kg + has.kg - exponents[0], needs.m + has.m - exponents[1], needs.s + has.s - exponents[2]
        return f"give {own[0].name} the unit {named(*wanted).name} instead of {has.name}, or change the law"
    listed = ", ".join(f"{p.name} in {p.unit.name}" for p in own)
    return f"change the law, or the units of {listed}" if own else "change the law"


def _exponents(line: Line, places: Sequence[Values]) -> tuple[int, int, int] | None:
    """Of kg, m and s that the line's value has; None where it is no product of powers of them."""
    found = np.array([[_power(line, at, i) for i in range(3)] for at in places])
    if not (np.isfinite(found).all() and (found == found[0]).all()):
        return None
    kg, m, s = map(int, found[0])
    return kg, m, s


def _power(line: Line, at: Values, which: int) -> float:
    """By which whole power of a single unit the value grows; NaN where by none."""
    whole, scaled = line.at(at), _scaled(line, at, [SINGLE if i == which else 1.0 for i in range(3)])
    i = int(np.argmax(abs(whole)))
    ratio = scaled[i] / whole[i] if whole[i] else np.nan
    power = float(np.round(log(ratio) / log(SINGLE))) if ratio > 0 else np.nan
    return power if _agrees(scaled, whole * SINGLE**power) else np.nan


def _scaled(line: Line, at: Values, kms: Sequence[float]) -> np.ndarray:
    """The value with all that it reads in units of mass, length and time that are smaller by `kms`."""
    return line.at({n: at[n] * line.units[n].scale(*kms) for n in line.symbols})


def _agrees(one: np.ndarray, other: np.ndarray) -> bool:
    return bool(np.all(abs(one - other) <= NEAR * np.max(abs(other), initial=0.0)))
