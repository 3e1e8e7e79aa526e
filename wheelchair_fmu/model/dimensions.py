"""Units of an effect that is written as an expression: what unit its parameter q must have, or why none fits.

The law is evaluated at random places, then again with the units of mass, length and time made smaller, one
after the other. Where it is a product of powers of units, its value grows by a power of the factor, the
same at every place; what is missing to the quantity it acts on is the unit of q.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from difflib import get_close_matches
from inspect import signature
from math import log, prod
from typing import Any

import casadi as cs
import numpy as np

from ..errors import ModelError, ShapeError, UsageError, unknown
from ..quantities import ONE, UNITS, Parameter, Quantity, Unit
from . import expression
from .arithmetic import shown
from .stage import Effect, adds
from .unlike import unlike
from .wheelchair import FORESEEN, Choice, Model, assemble

FACTOR = 1.7  # by which a unit is made smaller
PLACES = 4  # random places, at which all must agree
NEAR = 1e-6  # of a whole exponent
ROOT = "a root of a unit is left over; make what is under the root a plain number, as in sqrt(u / 1 [m/s])"
SYMBOLS = ("kg", "m", "s")


def vocabulary(model: Model) -> dict[str, Quantity]:
    """Every quantity that an expression may name, by its symbol."""
    records = (*model.parameters, *model.inputs, *model.states, *model.records.values())
    return {r.symbol: r for r in records if r.symbol in model.quantities}


def targets(model: Model) -> dict[str, Quantity]:
    """Quantities that an effect may act on: those that the stages define."""
    return dict(model.records)


def orders(model: Model) -> dict[str, int]:
    """When each quantity becomes known: 0 from the beginning, else its place in the line. A term that acts on one may read
    those before it."""
    line = {symbol: 1 + i for i, symbol in enumerate(model.records)}
    return {symbol: 0 if symbol in FORESEEN else line.get(symbol, 0) for symbol in (*vocabulary(model), *line)}


def unit_of_q(text: str, to: str, choice: Choice = Choice()) -> Unit:
    """The unit that q must have in `quantity += text`.

    Raises UsageError, with the reason in a sentence, where the expression is none, does not depend on q in proportion,
    reads what is not known at `to`, or adds unlike quantities.
    """
    law, model = expression.law(text), assemble(choice)
    if to not in model.records:
        raise unknown("quantity to act on", to, targets(model))
    known = vocabulary(model)
    _refuse_unreadable(text, to, law, choice, known)
    here, there = _exponents(text, known), model.records[to].unit
    wanted = [have - own for have, own in zip((there.kg, there.m, there.s), here, strict=True)]
    return there if not any(here) else named(*wanted)


def _refuse_unreadable(text: str, to: str, law: Callable[..., Any], choice: Choice, known: Mapping[str, Quantity]) -> None:
    """An expression must assemble: it reads only what is known, and has the shape of what it acts on."""
    if "q" not in signature(law).parameters:
        raise UsageError(f"{shown(text)} has no q in it; q is the size that is estimated, as in -q * u")
    if strange := next((n for n in signature(law).parameters if n != "q" and n not in known), None):
        raise UsageError(f"the expression reads {strange!r}, which is no quantity of this model{_meant(strange, known)}")
    q = Parameter("q", ONE, off=0.0, smallest_interesting=1.0)
    try:
        assemble(choice, [Effect("typed", "typed", (q,), (adds(to, law),))])
    except ShapeError as error:
        given, wanted = prod(error.given), prod(error.wanted)
        many = "one value" if given == 1 else f"{given} values"
        raise UsageError(
            f"{shown(text)} has {many}, where {to} has {wanted}; take one of them, as in N_r[0], or all, as in sum1(N_r)"
        ) from None
    except ModelError as error:
        raise UsageError(str(error).partition("; known here")[0].replace("effect typed", "the expression")) from None
    except (TypeError, RuntimeError, IndexError) as error:  # casadi's, for shapes and arguments that do not fit
        raise UsageError(f"{shown(text)} cannot be evaluated: {str(error).splitlines()[-1]}") from None


def _meant(name: str, known: Mapping[str, Quantity]) -> str:
    """The quantities that a name which is none may mean, by what they are called or by their meaning."""
    word = name.replace("_", " ").lower()
    called = re.compile(rf"\b{re.escape(word)}\b", re.IGNORECASE)
    told = sorted((n for n, q in known.items() if called.search(_briefly(q))), key=lambda n: len(_briefly(known[n])))
    other = [n for n in known if n.lower() == name.lower()]
    close = other or told[:3] or get_close_matches(name, known, n=3)
    return f"; did you mean {' or '.join(f'{n} ({_briefly(known[n])})' for n in close)}?" if close else ""


def _briefly(quantity: Quantity) -> str:
    """The first part of its meaning."""
    return re.split(r" \(|[,;:]", quantity.meaning)[0]


@np.errstate(all="ignore")  # what is not finite is refused in words
def _exponents(text: str, known: Mapping[str, Quantity]) -> tuple[int, int, int]:
    rng = np.random.default_rng(5)
    law, constants = expression.law_of_constants(text)
    units = {n: q.unit for n, q in known.items()} | {n: unit for n, (_, unit) in constants.items()}
    fixed = {n: np.array([value]) for n, (value, _) in constants.items()}
    names = [n for n in signature(law).parameters if n != "q" and n not in fixed]
    found = []
    for _ in range(PLACES):
        place = {n: rng.uniform(0.3, 1.3, known[n].size) for n in names} | fixed
        whole = _value(law, place, 1.0)
        if not np.all(np.isfinite(whole)):
            raise UsageError(f"{shown(text)} has no finite value: something is divided by zero, or grows without bound")
        if np.any(abs(_value(law, place, 2.0) - 2 * whole) > NEAR * abs(whole)):
            raise UsageError("the size q must be a factor of the whole: write q times something")
        found.append([_power(law, place, units, whole, **{unit: FACTOR}) for unit in SYMBOLS])
    spread = np.array(found)
    whole_numbers = np.round(spread[0])
    if not np.all(abs(spread - whole_numbers) < NEAR):
        where = unlike(text, known, lambda kg, m, s: named(kg, m, s).name) or ROOT
        raise UsageError(f"the units do not fit: {where}")
    kg, m, s = (int(e) for e in whole_numbers)
    return kg, m, s


def _power(
    law: Callable[..., Any],
    place: Mapping[str, np.ndarray],
    units: Mapping[str, Unit],
    whole: np.ndarray,
    kg: float = 1.0,
    m: float = 1.0,
    s: float = 1.0,
) -> float:
    scaled = _value(law, {n: v * units[n].scale(kg, m, s) for n, v in place.items()}, 1.0)
    i = int(np.argmax(abs(whole)))
    ratio = scaled[i] / whole[i] if whole[i] else np.nan
    return log(ratio) / log(FACTOR) if ratio > 0 else np.nan


def _value(law: Callable[..., Any], place: Mapping[str, np.ndarray], q: float) -> np.ndarray:
    return np.array(cs.DM(law(**{n: cs.DM(v) for n, v in place.items()}, **{"q": q}))).ravel()


def named(kg: int, m: int, s: int) -> Unit:
    """The project's own record of a unit, or a name made of its exponents."""
    own = [u for u in UNITS.values() if (u.kg, u.m, u.s) == (kg, m, s)]
    if own:
        return min(own, key=lambda u: abs(u.rad))
    above = [_written(n, e) for n, e in zip(SYMBOLS, (kg, m, s), strict=True) if e > 0]
    below = [_written(n, -e) for n, e in zip(SYMBOLS, (kg, m, s), strict=True) if e < 0]
    return Unit(".".join(above) or "1" if not below else f"{'.'.join(above) or '1'}/{'.'.join(below)}", kg=kg, m=m, s=s)


def _written(name: str, exponent: int) -> str:
    return name if exponent == 1 else f"{name}{exponent}"
