"""How equations and effects are written down, and how they meet.

The model is a line of stages. A stage is a plain function: its argument names are the quantities it
reads, its decorator names the quantities it defines, with unit and meaning. Effects sign up at any
quantity, and one rule holds for all of them:

    quantity = (base + Σ additions) · Π factors

so the order of effects cannot matter, and a model without effects is the paper's. A contribution
reads what its law's arguments name, and only what earlier stages have defined.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from hashlib import sha256
from inspect import signature
from typing import Any

from ..quantities import Parameter, Quantity, State, Unit
from .signs import Shows
from .sketch import Sketch

Law = Callable[..., Any]


def reads(law: Law) -> tuple[str, ...]:
    """The symbols a law reads: its argument names."""
    return tuple(signature(law).parameters)


@dataclass(frozen=True)
class Stage:
    """One line of equations: `law(*reads)` gives the quantities `defines`, in order."""

    law: Law
    defines: tuple[Quantity, ...]

    @property
    def name(self) -> str:
        return self.law.__name__


def stage(*defines: Quantity) -> Callable[[Law], Stage]:
    """Make a stage of a function that returns the quantities listed here, in this order."""
    return lambda law: Stage(law, defines)


def define(symbol: str, unit: Unit, meaning: str, mirror: str = "+", components: tuple[str, ...] = ()) -> Quantity:
    """A quantity that a stage defines."""
    return Quantity(symbol, unit, meaning, mirror=mirror, components=components)


@dataclass(frozen=True)
class Contribution:
    """What an effect does to one quantity: adds a term or multiplies by a factor.

    `opposes` names a velocity: the law promises force · velocity ≤ 0, and the tests hold it to that.
    """

    to: str
    law: Law
    factor: bool = False
    opposes: str = ""


def adds(to: str, law: Law, *, opposes: str = "") -> Contribution:
    """Add a term to the quantity `to`."""
    return Contribution(to, law, opposes=opposes)


def scales(to: str, law: Law) -> Contribution:
    """Multiply the quantity `to` by a positive factor."""
    return Contribution(to, law, factor=True)


@dataclass(frozen=True)
class Row:
    """A state of an effect or law, with its own line of M x' = f: `mass(...) · x' = rate(...)`.

    Where the mass is zero the line is an algebraic equation for x; nothing else changes. `coupled` are the entries of M
    beside the diagonal, of parameters alone, by the symbol of the speed that x' goes with: "u", "v" or "psi_dot". M is
    symmetric, so that each stands in that speed's own line as well, and `rate` times x is a power.
    """

    state: State
    mass: Law
    rate: Law
    start: Law | None = None  # the value at the start, from any quantity as it is at the start; 0 unless given
    coupled: Mapping[str, Law] = field(default_factory=dict)

    @property
    def laws(self) -> tuple[Law, ...]:
        """All of them."""
        return tuple(law for law in (self.mass, self.rate, self.start, *self.coupled.values()) if law is not None)


@dataclass(frozen=True)
class Alternative:
    """One of several laws that exclude each other: its stages, its parameters, its states."""

    name: str
    stages: tuple[Stage, ...]
    parameters: tuple[Parameter, ...] = ()
    rows: tuple[Row, ...] = ()
    loads: tuple[Stage, ...] = ()  # in place of the chair's, where wheels do not touch the floor where that takes them to
    serves: tuple[str, ...] = ()  # laws that effects may ask for and have this one instead
    absorbs: Law | None = None  # the power [W] that goes into its states, as an effect's


@dataclass(frozen=True)
class Alike:
    """What several effects do alike: those whose records hold this, and `with_parameters` of the chair. `told_by` is what tells
    them apart; `one_cause`: they are forms of one."""

    what: str
    told_by: str
    with_parameters: tuple[str, ...] = ()
    one_cause: bool = False


@dataclass(frozen=True)
class Program:
    """The file of an effect of a user's own: where it was read, and its text."""

    file: str
    text: str

    @property
    def sha256(self) -> str:
        """Of the text in UTF-8, in hexadecimal digits."""
        return sha256(self.text.encode()).hexdigest()


@dataclass(frozen=True)
class Effect:
    """One physical effect the paper leaves out: a few contributions and the parameters in them.

    `parameters` are off at zero. `constants` belong to the effect; those in which chairs differ have a standard deviation,
    `known_to`, by which a fit with the effect adjusts them. `needs` names the laws it works with, e.g.
    ``{"caster": "swivelling"}``.
    """

    id: str
    title: str
    parameters: tuple[Parameter, ...]
    contributions: Sequence[Contribution] = ()
    rows: tuple[Row, ...] = ()
    constants: tuple[Parameter, ...] = ()
    needs: dict[str, str] = field(default_factory=dict)
    even: bool = False  # the response is (nearly) even in the parameters: the slope at zero says little
    delays_record: bool = False  # its parameter shifts the recorded inputs in time; no part of the FMU
    absorbs: Law | None = None  # the power [W] that goes into its states, below zero where they give some; for the energy's sum
    alike: tuple[Alike, ...] = ()  # what it does that others do as well
    through: tuple[str, ...] = ()  # ids of effects by which it reaches the chair: it may show only together with these
    # For each of its parameters, in order, what a value above zero does; and what is drawn of it, from left to right.
    signs: tuple[Shows, ...] = field(default=(), compare=False, repr=False)
    sketches: tuple[Sketch, ...] = field(default=(), compare=False, repr=False)
    program: Program | None = field(default=None, compare=False, repr=False)  # of a user's own, once it was read

    @cached_property
    def owned(self) -> tuple[Parameter, ...]:
        """All its parameters under their full names `effect.<id>.<name>`."""
        constants = tuple(replace(c, estimated=False) for c in self.constants)
        return tuple(p.owned_by(self.id) for p in (*self.parameters, *constants))

    @property
    def cause(self) -> str:
        """What it is a form of, or its own id."""
        return next((alike.what for alike in self.alike if alike.one_cause), self.id)

    def asks(self, symbol: str) -> bool:
        """Do its contributions or states read this quantity?"""
        laws = (*(c.law for c in self.contributions), *(law for row in self.rows for law in row.laws))
        return any(symbol in reads(law) for law in laws)

    @property
    def stateless(self) -> bool:
        return not self.rows and not self.needs and not self.delays_record
