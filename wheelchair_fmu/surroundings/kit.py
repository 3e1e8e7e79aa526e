"""A model from records and expressions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import casadi as cs

from ..model.wheelchair import Choice, Model
from ..quantities import Input, Output, Parameter, State

Symbols = Mapping[str, cs.SX]


def symbols(records: Iterable[Parameter | Input | State]) -> dict[str, cs.SX]:
    """A CasADi symbol for each record, by full name."""
    return {r.name: cs.SX.sym(r.name) for r in records}


def model(
    parameters: tuple[Parameter, ...],
    inputs: tuple[Input, ...],
    outputs: tuple[Output, ...],
    known: Symbols,
    results: Symbols,
    states: tuple[State, ...] = (),
    rates: Symbols | None = None,
    starts: Symbols | None = None,
) -> Model:
    """The model x' = rates, y = results, where `known` are the symbols of everything that these read."""

    def column(records: Iterable[Parameter | Input | State | Output], values: Symbols) -> cs.SX:
        return cs.vertcat(cs.SX(0, 1), *(values[r.name] for r in records))

    return Model(
        Choice(),
        (),
        parameters,
        inputs,
        states,
        outputs,
        column(states, known),
        column(inputs, known),
        column(parameters, known),
        cs.SX.ones(len(states), 1),
        column(states, rates or {}),
        column(outputs, results),
        column(states, starts or {}),
        {},
        {},
    )


def clip(value: cs.SX, lower: cs.SX | float, upper: cs.SX | float) -> cs.SX:
    """The value, or the bound that it is beyond."""
    return cs.fmin(cs.fmax(value, lower), upper)
