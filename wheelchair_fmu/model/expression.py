"""Effects written as an expression: "-q * sin(delta)" becomes a law, and a file that a user may edit.

A number may have a unit in brackets behind it, "-q * tanh(u / 3 [km/h])"; it counts in SI.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from inspect import Parameter, Signature
from typing import Any

from ..errors import UsageError
from ..quantities import Unit
from . import arithmetic

KEPT = 1024  # laws that are kept, so that one who types for hours fills no memory


@dataclass(frozen=True)
class ExpressionLaw:
    """A law whose arguments are the quantities that an expression names, in the order of its text.

    `expression` is what it says, in one way of writing and in SI: two laws are the same where it is. `given` is the same with
    numbers in the units they were given in.
    """

    expression: str
    given: str = field(compare=False)
    arguments: tuple[str, ...]
    tree: ast.expr = field(compare=False, repr=False)
    numbers: Mapping[int, float] = field(compare=False, repr=False)
    names: Mapping[int, str] = field(compare=False, repr=False)  # of numbers that are arguments too
    __signature__: Signature = field(init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        found = Signature([Parameter(name, Parameter.POSITIONAL_OR_KEYWORD) for name in self.arguments])
        object.__setattr__(self, "__signature__", found)

    def __call__(self, *values: Any, **named: Any) -> Any:
        known = self.__signature__.bind(*values, **named).arguments
        known = {name: float(v) if isinstance(v, int) else v for name, v in known.items()}
        return arithmetic.value(self.tree, known, {**self.numbers, **{place: known[n] for place, n in self.names.items()}})


@lru_cache(KEPT)
def law(expression: str) -> ExpressionLaw:
    """The expression as a function of the quantities it names.

    Raises UsageError for anything but arithmetic, numbers (with units), names and the known functions.
    """
    tree, numbers = arithmetic.parsed(expression)
    values = {place: number.value for place, number in numbers.items()}
    in_si = _written(expression, lambda number: repr(number.value))
    return ExpressionLaw(in_si, canonical(expression), arithmetic.names(tree), tree, values, {})


def law_of_constants(expression: str) -> tuple[ExpressionLaw, dict[str, tuple[float, Unit]]]:
    """The law as a function of its numbers with units too; by their names there, those numbers in SI and their units."""
    tree, numbers = arithmetic.parsed(expression)
    names = {place: f"_{i}" for i, place in enumerate(numbers)}  # which no quantity is called
    constants = {}
    for place, number in numbers.items():
        kg, m, s = number.exponents
        constants[names[place]] = number.value, Unit(number.unit, kg=kg, m=m, s=s)
    arguments = (*arithmetic.names(tree), *names.values())
    return ExpressionLaw(canonical(expression), canonical(expression), arguments, tree, {}, names), constants


def canonical(expression: str) -> str:
    """The expression in one way of writing, units as they were given. Raises UsageError as `law` does."""
    return _written(expression, lambda number: number.written)


def _written(expression: str, words: Callable[[arithmetic.Number], str]) -> str:
    """The text of the checked tree, with these words for the numbers that have units."""
    tree, numbers = arithmetic.parsed(expression)
    return arithmetic.written(tree, {place: words(number) for place, number in numbers.items()})


FILE = """{heading!r}

from wheelchair_fmu.model.expression import law
from wheelchair_fmu.model.stage import Effect, {kind}
from wheelchair_fmu.quantities import {records}

UNIT = {unit!r}
Q = Parameter("q", UNIT, {size_of!r}, off=0.0, smallest_interesting={size!r}, lower={lower!r}, upper={upper!r},
              source={source!r})

EFFECT = Effect(
    {id!r},
    {title!r},
    parameters=(Q,),
    contributions=({kind}({to!r}, law({expression!r})),),
)
"""


def effect_file(
    id: str,
    title: str,
    to: str,
    unit: Unit,
    expression: str,
    *,
    size: float,
    lower: float,
    upper: float,
    source: str = "proposed",
    factor: bool = False,
) -> str:
    """The text of an effect file that adds `expression`, which has q in it, to the quantity `to` (or scales it).

    An effect file is a program, so every word from outside is written as a literal that it cannot leave, and the expression
    as its checked tree reads. Raises UsageError for words that cannot be printed and for what is no expression.
    """
    for word in (id, title, to, source):
        if not word.isprintable():
            raise UsageError(f"{arithmetic.shown(word)} has characters that cannot be printed; use plain words")
    expression, kind = canonical(expression), "scales" if factor else "adds"
    return FILE.format(
        heading=f"{title}:  {to} += {expression}",
        id=id,
        title=title,
        to=to,
        unit=unit,
        expression=expression,
        size_of=f"size of: {title}",
        size=float(size),
        lower=float(lower),
        upper=float(upper),
        source=source,
        kind=kind,
        records="DisplayUnit, Parameter, Unit" if unit.display else "Parameter, Unit",
    )
