"""What a tyre law, a caster law or a wheel law has to keep, bundled or a user's own."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import wraps
from itertools import product
from typing import Any

import numpy as np

from ..errors import WheelchairError
from ..faults import raised
from ..model.choice import Choice, law
from ..model.dimensions import named
from ..model.stage import Alternative, Law
from ..model.wheelchair import assemble
from ..quantities import Quantity
from .energy import Energy
from .laws import Line, line_of, shared_records, shared_values
from .motion import mirror
from .places import anywhere
from .smooth import finite, moving
from .subject import NOT_OF_NUMBERS, Breach, Subject
from .units import PLACES, fault_of

SLIPPING = np.array([0.02, -0.03])  # rad, at which no tyre slides: where it does, its trail may be zero in any unit
SLIPS = np.linspace(-1.2, 1.2, 49)  # rad
LOADS = (1.0, 60.0, 220.0, 900.0)  # N
NOTHING = 1e-12  # of a force, beside what a tyre bears
MOMENTS = 60  # in which the energy of a chair with a caster law is asked for


def law_breaches(kind: str, choice: Choice) -> list[Breach]:
    """Every contract that the chosen law of this kind ("tyre", "caster" or "wheel") breaks."""
    chosen = law(kind, choice)
    try:
        with np.errstate(all="ignore"):  # what is not finite is a breach, and no warning beside
            model = assemble(choice)
            subject = Subject((), model, model)
            found = [
                *_units(chosen, subject),
                *finite(subject),
                *moving(subject),
                *mirror(subject),
                *OF_KIND[kind](chosen, subject),
            ]
    except WheelchairError as error:
        fact, _, cure = str(error).partition("; ")
        found = [Breach(chosen.name, "equations", fact, cure or "change the law")]
    except Exception as error:  # what somebody else's law may raise
        _, _, said = raised("", error)
        found = [Breach(chosen.name, "equations", f"it fails: {said}", NOT_OF_NUMBERS)]
    return [replace(breach, effect=chosen.name, kind=f"{kind} law") for breach in found]


def _units(chosen: Alternative, subject: Subject) -> Iterator[Breach]:
    """Each quantity that a stage gives has its unit, and so has each rate of a state."""
    seeds = map(np.random.default_rng, range(PLACES))
    places = [shared_values(subject, anywhere(subject.model, subject.values(1.0), rng)) for rng in seeds]
    places = [{**place, "lam_F": SLIPPING} for place in places]
    for line in _lines(chosen, subject):
        if not all(np.isfinite(line.at(values)).all() for values in places):
            continue  # a rate without mass: an equation for its state, of which nothing but zero is asked
        if fault := fault_of(line, chosen.parameters, places):
            yield Breach(chosen.name, "units", *fault)


def _lines(chosen: Alternative, subject: Subject) -> Iterator[Line]:
    known = shared_records(subject)
    yield from (line for _, line in _given(chosen, subject))
    for row in chosen.rows:
        name, unit = row.state.name, row.state.unit
        yield line_of(f"rate / mass of {name}", [row.rate, row.mass], known, named(unit.kg, unit.m, unit.s - 1))


def _component(law: Law, i: int) -> Law:
    """The i-th of what a law gives."""

    @wraps(law)
    def one(*values: Any) -> Any:
        given = law(*values)
        return given[i] if isinstance(given, tuple) else given

    return one


def _of_tyres(chosen: Alternative, subject: Subject) -> list[Breach]:
    """Without slip no force and no torque, and with slip a force that opposes it: whatever the load."""
    usual = shared_values(subject, anywhere(subject.model, subject.values(1.0), np.random.default_rng(7), spread=0))
    lines = {q.symbol: line for q, line in _given(chosen, subject)}
    for load, slip in product(LOADS, SLIPS):
        values = {**usual, "lam_F": np.full(2, slip), "N_r": np.full(2, load)}
        for symbol, line in lines.items():
            values[symbol] = line.at(values)
        force, torque = values["F_lam"], values["M_lam"]
        told = f"at a slip angle of {slip:.3g} rad and a load of {load:g} N it gives {force[0]:.3g} N and {torque[0]:.3g} N.m"
        if abs(slip) < NOTHING and max(abs(force).max(), abs(torque).max()) > NOTHING:
            cure = "let both be zero there; what pulls without slip is an effect, such as camber_misalignment"
            return [Breach(chosen.name, "neutral without slip", told, cure)]
        if np.min(force * np.sign(slip)) < -NOTHING * load:
            return [Breach(chosen.name, "passive", told, "let the force have the sign of the slip angle, which it opposes")]
    return []


def _given(chosen: Alternative, subject: Subject) -> Iterator[tuple[Quantity, Line]]:
    """What the law's stages give, in their order."""
    known = shared_records(subject)
    for stage in chosen.stages:
        for i, quantity in enumerate(stage.defines):
            yield quantity, line_of(f"its {quantity.symbol}", [_component(stage.law, i)], known, quantity.unit)


def _of_casters(_: Alternative, subject: Subject) -> list[Breach]:
    """Without a push the chair only loses energy, and its casters alone never drive it."""
    energy = Energy(subject)
    return energy.of_casters(np.random.default_rng(21), MOMENTS) or energy.breaches((), np.random.default_rng(20), MOMENTS)


def _of_wheels(_: Alternative, subject: Subject) -> list[Breach]:
    """Without a push the chair and what spins of it only lose energy."""
    return Energy(subject).breaches((), np.random.default_rng(20), MOMENTS)


OF_KIND: dict[str, Callable[[Alternative, Subject], list[Breach]]] = {
    "tyre": _of_tyres,
    "caster": _of_casters,
    "wheel": _of_wheels,
}
