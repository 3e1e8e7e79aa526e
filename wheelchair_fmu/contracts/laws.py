"""Each equation of an effect alone, as a function of what it reads, and the values of that wherever a chair may be."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from inspect import signature

import casadi as cs
import numpy as np

from ..model.dimensions import named
from ..model.expression import ExpressionLaw, law_of_constants
from ..model.stage import Effect, Law, Row
from ..quantities import ONE, Quantity, Unit
from .places import Place, evaluate
from .subject import Subject

Values = Mapping[str, np.ndarray]


@dataclass(frozen=True)
class Line:
    """One equation: its `value`, the symbols of what it reads with their units, and the unit that its value must have.

    `fixed` are the values of numbers that stand in it with a unit, which it reads as well.
    """

    words: str
    value: cs.SX
    symbols: Mapping[str, cs.SX]
    units: Mapping[str, Unit]
    fixed: Values
    unit: Unit

    def at(self, values: Values) -> np.ndarray:
        return self._value.call([values[n] for n in self.symbols])[0].full().ravel()

    @cached_property
    def _value(self) -> cs.Function:
        return cs.Function("line", list(self.symbols.values()), [self.value])

    def slopes(self, values: Values) -> np.ndarray:
        """Of each component by each component of what it reads, (m, n)."""
        symbols = list(self.symbols.values())
        slopes = cs.Function("slopes", symbols, [cs.jacobian(self.value, cs.vertcat(*symbols))])
        return np.array(slopes.call([values[n] for n in self.symbols])[0].full())


def lines(subject: Subject, effect: Effect) -> Iterator[Line]:
    """Every equation of an effect; of a state's row, its rate of change."""
    known = _records(subject, effect)
    for c in effect.contributions:
        unit = ONE if c.factor else subject.model.records[c.to].unit
        yield line_of(f"its {'factor of' if c.factor else 'term in'} {c.to}", [c.law], known, unit)
    for row in effect.rows:
        name, unit = row.state.name, row.state.unit
        yield line_of(f"rate / mass of {name}", [row.rate, row.mass], known, named(unit.kg, unit.m, unit.s - 1))
        yield from _shared_inertia(row, known)
        if row.start:
            yield line_of(f"the start of {name}", [row.start], known, unit)


def _shared_inertia(row: Row, known: Mapping[str, Quantity]) -> Iterator[Line]:
    """A row that shares inertia with the chair is a balance of forces: its rate times its state is a power."""
    name, unit = row.state.name, row.state.unit
    if row.coupled:
        yield line_of(f"the rate of {name}, coupled as it is,", [row.rate], known, named(1 - unit.kg, 2 - unit.m, -3 - unit.s))
    for speed, law in row.coupled.items():
        entry = named(1 - unit.kg, (2 if speed == "psi_dot" else 1) - unit.m, -1 - unit.s)
        yield line_of(f"what couples {name} with {speed}", [law], known, entry)


def line_of(words: str, laws: Sequence[Law], known: Mapping[str, Quantity], unit: Unit) -> Line:
    """The first law, divided by the second if there is one, of what these records say that it may read."""
    symbols: dict[str, cs.SX] = {}
    units: dict[str, Unit] = {}
    fixed: dict[str, np.ndarray] = {}
    terms = []
    for i, law in enumerate(laws):
        inner, constants = law_of_constants(law.given) if isinstance(law, ExpressionLaw) else (law, {})
        arguments = []
        for n in signature(inner).parameters:
            name = f"{n} of {i}" if n in constants else n
            if n in constants:
                fixed[name], units[name] = np.array([constants[n][0]]), constants[n][1]
            else:
                units[name] = known[n].unit
            arguments.append(symbols.setdefault(name, cs.SX.sym("s", known[n].size if n in known else 1)))
        terms.append(cs.SX(inner(*arguments)))
    return Line(words, cs.densify(terms[0] if len(terms) == 1 else terms[0] / terms[1]), symbols, units, fixed, unit)


def values_at(subject: Subject, place: Place) -> dict[str, dict[str, np.ndarray]]:
    """The value of every symbol at a place, by effect: what is its own goes before what all share."""
    model, shared = subject.model, shared_values(subject, place)
    by_name = _by_name(model.states, place.x) | _by_name(model.parameters, place.p)
    return {e.id: shared | {q.symbol: by_name[f"effect.{e.id}.{q.name}"] for q in own(e)} for e in subject.effects}


def shared_values(subject: Subject, place: Place) -> dict[str, np.ndarray]:
    """The value of every symbol that all share."""
    known = subject.model.quantities
    return dict(zip(known, evaluate(subject.model, place, *known.values()), strict=True))


def own(effect: Effect) -> tuple[Quantity, ...]:
    """What an effect brings along: its parameters, constants and states."""
    return (*effect.parameters, *effect.constants, *(row.state for row in effect.rows))


def _records(subject: Subject, effect: Effect) -> dict[str, Quantity]:
    """Everything that a law of this effect may read, by its symbol."""
    return shared_records(subject) | {q.symbol: q for q in own(effect)}


def shared_records(subject: Subject) -> dict[str, Quantity]:
    """What any law may read, by its symbol."""
    model = subject.model
    return {q.symbol: q for q in (*model.parameters, *model.inputs, *model.states, *model.records.values())}


def _by_name(records: Sequence[Quantity], values: np.ndarray) -> dict[str, np.ndarray]:
    ends = np.cumsum([r.size for r in records])
    return dict(zip((r.name for r in records), np.split(values, ends[:-1]), strict=True))
