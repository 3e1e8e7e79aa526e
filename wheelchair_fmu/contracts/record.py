"""An effect's record is complete: of the right types, off at zero, with a size of interest, bounds, a meaning and a source."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator
from typing import Any

from ..model.coupling import SPEEDS
from ..model.signs import Shows
from ..model.sketch import Sketch
from ..model.stage import Alike, Contribution, Effect, Row
from ..model.variant import LAWS
from ..quantities import Parameter, State, Unit
from .subject import Breach

MIRROR = re.compile(r"[+-]\w*")
ROLES = {
    **{"parameters": Parameter, "constants": Parameter, "contributions": Contribution, "rows": Row, "alike": Alike},
    **{"signs": Shows, "sketches": Sketch},
}
NUMBERS = ("default", "lower", "upper", "off", "nominal", "smallest_interesting", "uncertainty")


def record(effect: Effect) -> list[Breach]:
    """Every fault of the record itself; the other contracts can only be asked of one that has none."""
    return [Breach(effect.id, "record", fact, cure) for fact, cure in _types(effect) or _values(effect)]


def _types(effect: Effect) -> list[tuple[str, str]]:
    found = []
    if not isinstance(effect.title, str) or not effect.title.strip():
        found.append((f"its title is {effect.title!r}", "say in a few words what it is"))
    for role, kind in ROLES.items():
        members = getattr(effect, role)
        if not isinstance(members, tuple | list) or not all(isinstance(m, kind) for m in members):
            found.append((f"{role} is {_short(members)}", f"write {role}=({kind.__name__}(...),) with the comma"))
    if not isinstance(effect.needs, dict) or not all(law in LAWS.get(kind, ()) for kind, law in effect.needs.items()):
        found.append((f"needs is {effect.needs!r}", 'write for example needs={"caster": "swivelling"}'))
    others = effect.through if isinstance(effect.through, tuple | list) else (effect.id,)
    if not all(isinstance(id, str) and id != effect.id for id in others):
        found.append((f"through is {effect.through!r}", 'write for example through=("caster_trail",), with the comma'))
    if found:
        return found
    found += [fault for p in (*effect.parameters, *effect.constants) for fault in _of_parameter(p)]
    found += [fault for c in effect.contributions for fault in _of_contribution(c)]
    return found + [fault for row in effect.rows for fault in _of_row(row)]


def _of_parameter(p: Parameter) -> Iterator[tuple[str, str]]:
    if not isinstance(p.name, str) or not p.name.isidentifier():
        yield f"a parameter is called {p.name!r}", "use letters, digits and underscores, like q or k_left"
    if not _is_unit(p.unit):
        yield f"the unit of {p.name} is {p.unit!r}", "import a Unit from wheelchair_fmu.quantities, such as N or N_S_M"
    if not isinstance(p.mirror, str) or not MIRROR.fullmatch(p.mirror):
        yield f"the mirror of {p.name} is {p.mirror!r}", 'write "+", "-", or one of these and the partner\'s symbol'
    for key in NUMBERS:
        value = getattr(p, key)
        if value is not None and (isinstance(value, bool) or not isinstance(value, int | float)):
            yield f"{key} of {p.name} is {value!r}", "write a number in SI units"


def _is_unit(unit: Any) -> bool:
    return isinstance(unit, Unit) and all(isinstance(n, int) for n in (unit.kg, unit.m, unit.s, unit.rad))


def _of_contribution(c: Contribution) -> Iterator[tuple[str, str]]:
    if not isinstance(c.to, str):
        yield f"a contribution is to {c.to!r}", "name a quantity that `wheelchair effects quantities` lists"
    if not isinstance(c.opposes, str):
        yield f"opposes is {c.opposes!r}", 'name a velocity, as in opposes="u"'
    if not callable(c.law):
        yield f"the law of its term in {c.to} is {_short(c.law)}", "give a function of quantities, by their symbols"


def _of_row(row: Row) -> Iterator[tuple[str, str]]:
    if not isinstance(row.state, State):
        yield f"the state of a row is {_short(row.state)}", "write Row(State(...), mass=..., rate=...)"
    elif not _is_unit(row.state.unit):
        yield f"the unit of the state {row.state.name} is {row.state.unit!r}", "import a Unit from wheelchair_fmu.quantities"
    for key in ("mass", "rate", "start"):
        law = getattr(row, key)
        if not callable(law) and not (key == "start" and law is None):
            yield f"{key} of a row is {_short(law)}", "give a function of quantities, by their symbols"
    if not isinstance(row.coupled, dict) or not all(s in SPEEDS and callable(law) for s, law in row.coupled.items()):
        yield f"coupled of a row is {row.coupled!r}", 'write for example coupled={"u": law}, with u, v or psi_dot'


def _values(effect: Effect) -> list[tuple[str, str]]:
    found = []
    if not effect.parameters:
        found.append(("it has no parameters", "give it one that is 0 when the effect is off"))
    if not effect.contributions and not effect.delays_record and not any(row.coupled for row in effect.rows):
        found.append(("it contributes to nothing", 'add for example adds("F_x", law)'))
    if effect.signs and len(effect.signs) != len(effect.parameters):
        found.append((f"signs has {len(effect.signs)} for {len(effect.parameters)} parameters", "give one for each, in order"))
    twice = _twice(q.symbol for q in (*effect.parameters, *effect.constants, *(row.state for row in effect.rows)))
    if twice:
        found.append((f"the symbol {twice} is used twice", "give each parameter, constant and state its own"))
    return found + [fault for p in effect.parameters for fault in _of_size(p)]


def _of_size(p: Parameter) -> Iterator[tuple[str, str]]:
    unit, size = p.unit.name, p.smallest_interesting
    if p.off != 0:
        yield f"{p.name} is off at {p.off}", f"write off=0.0, and the law so that {p.name} = 0 is the chair without it"
    if size is None or not size > 0:
        yield f"smallest_interesting of {p.name} is {size}", f"give the smallest {p.name} [{unit}] that would matter to you"
    elif not (math.isfinite(p.lower) and math.isfinite(p.upper)):
        yield f"the bounds of {p.name} are {p.lower:g} to {p.upper:g} {unit}", "give finite numbers, lower= and upper="
    elif not p.lower <= 0 < size < p.upper:
        yield (
            f"{p.name} goes from {p.lower:g} to {p.upper:g} {unit} and {size:g} {unit} is of interest",
            "it must go lower ≤ 0 < smallest_interesting < upper",
        )
    for key in ("meaning", "source"):
        if not getattr(p, key):
            yield f"{p.name} has no {key}", f"give {key}=, a few words in quotes"


def _twice(names: Iterable[str]) -> str:
    names = list(names)
    return ", ".join(sorted({name for name in names if names.count(name) > 1}))


def _short(value: Any) -> str:
    return (
        f"a {type(value).__name__}"
        if not isinstance(value, tuple | list)
        else (f"a {type(value).__name__} of {', '.join(sorted({type(v).__name__ for v in value})) or 'nothing'}")
    )
