"""A variant: which laws and effects a chair has, and with which values.

`wheelchair add` writes one, everything else reads it::

    [laws]
    tyre = "linear"          # linear | dugoff | magic_formula
    caster = "ideal"         # ideal | swivelling | slipping
    wheel = "rolling"        # rolling | spinning
    equations = "extended"   # extended | paper
    effects = ["relaxation_length"]

    [values]                 # any parameter of the FMU, SI units; the rest keep their defaults
    "tyre.C_lambda" = 4900.0
    "effect.relaxation_length.sigma" = 0.12

Effects and laws of a user's own are in the file too, as programs with their digests, see `carried`.
"""

from __future__ import annotations

import math
import tomllib
import warnings
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w

from ..errors import Failure, Note, UsageError, unknown
from ..given import toml
from ..quantities import Parameter
from . import carried
from .choice import KINDS, Choice, OwnLaw, configured, laws, names, serves, taken_along
from .effects import bundled
from .former import current
from .stage import Effect, Program
from .wheelchair import Model, assemble, base_parameters

LAWS = names()  # what may be chosen where no law comes along
NOTES = ("title", "for", "standard_errors", "origin", "tied")  # what else a file may say: whose values these are, and whence
Load = Callable[[carried.Carried], Mapping[str, Effect]]  # runs programs once somebody trusts them, and gives the effects


def effects_in(names: Iterable[str]) -> tuple[str, ...]:
    """The ids of the effects that parameters named so belong to, each once."""
    return tuple(dict.fromkeys(n.split(".")[1] for n in names if n.startswith("effect.") and n.count(".") > 1))


@dataclass(frozen=True)
class Variant:
    """Laws, effects by id, values by parameter name (SI units), and free notes on where they come from."""

    choice: Choice = Choice()
    effects: tuple[str, ...] = ()
    values: Mapping[str, float] = field(default_factory=dict)
    notes: Mapping[str, Any] = field(default_factory=dict)
    catalogue: Mapping[str, Effect] = field(default_factory=bundled, repr=False)

    def __post_init__(self) -> None:
        for kind, known in names(self.choice).items():
            if getattr(self.choice, kind) not in known:
                raise unknown(f"{kind} law", getattr(self.choice, kind), known)
        for effect in self.effects:
            if effect not in self.catalogue:
                raise unknown("effect", effect, self.catalogue)

    def with_effects(self, ids: Iterable[str]) -> Variant:
        """The same with more effects, and the laws that these need."""
        ids = tuple(ids)
        for effect in ids:
            if effect not in self.catalogue:
                raise unknown("effect", effect, self.catalogue)
        every = (need for effect in ids for need in self.catalogue[effect].needs.items())
        needs = {kind: law for kind, law in every if not serves(self.choice, kind, law)}
        more = tuple(e for e in ids if e not in self.effects)
        return replace(self, effects=(*self.effects, *more), choice=self.choice.with_laws(needs))

    def with_values(self, values: Mapping[str, float | str]) -> Variant:
        """The same with other values; a value of an effect that is off switches it on. Former names are read, with a warning.

        Raises UsageError for an unknown name, a number out of bounds or a word that is no choice.
        """
        values = current(values, self.values)
        grown = self.with_effects(e for e in effects_in(values) if e not in self.effects)
        records = {p.name: p for p in grown.parameters()}
        for name in values:
            if name not in records:
                _refuse_of_other_laws(name, grown.choice)
        numbers = {name: number(records, name, value) for name, value in values.items()}
        choice = grown.choice
        if "tyre.law" in numbers:
            choice = replace(choice, tyre=records["tyre.law"].choices[int(numbers.pop("tyre.law")) - 1])
        return replace(grown, choice=choice, values={**grown.values, **numbers})

    def parameters(self) -> tuple[Parameter, ...]:
        """The records of every parameter this chair has."""
        return self._parameters

    @cached_property
    def _parameters(self) -> tuple[Parameter, ...]:
        own = (p for e in sorted(self.effects) for p in self.catalogue[e].owned)
        return (*base_parameters(self.choice), *own)

    def active(self) -> tuple[Effect, ...]:
        return tuple(self.catalogue[e] for e in sorted(self.effects))

    def model(self) -> Model:
        return assemble(self.choice, self.active())

    def vector(self, values: Mapping[str, float] | None = None) -> np.ndarray:
        """Parameter values, shape (np,), in the order of `parameters()`; `values` go before the variant's own."""
        given = {**self.values, **(values or {}), "tyre.law": 1 + names(self.choice)["tyre"].index(self.choice.tyre)}
        return np.array([given.get(p.name, p.default) for p in self.parameters()])


def _refuse_of_other_laws(name: str, choice: Choice) -> None:
    """Raises UsageError for a parameter that only laws have which were not chosen."""
    for kind in KINDS:
        if owners := [law for law, record in laws(kind, choice).items() if any(p.name == name for p in record.parameters)]:
            one = " or ".join(f'{kind} = "{law}"' for law in owners)
            raise UsageError(
                f"{name} is a parameter of another {kind} law than {getattr(choice, kind)!r}, which this chair has; "
                f"choose {one} in the [laws] of a variant"
            )


def number(records: Mapping[str, Parameter], name: str, value: float | str) -> float:
    """The checked value of a parameter: a number within its bounds, or the number of a named choice."""
    if name not in records:
        raise unknown("parameter", name, records)
    record = records[name]
    if record.choices:
        if value not in record.choices:
            raise UsageError(f"{name} = {value}: choose one of {', '.join(record.choices)}")
        return 1.0 + record.choices.index(str(value))
    try:
        result = float(value)
    except (TypeError, ValueError):
        wanted = f"a number in{record.unit.behind}" if record.unit.behind else "a number"
        raise UsageError(f"{name} = {value!r} is not a number; give {wanted}") from None
    if not math.isfinite(result) or not record.lower <= result <= record.upper:
        raise UsageError(
            f"{name} = {value} is outside its bounds {record.lower:g} to "
            f"{record.upper:g}{record.unit.behind}; give a value between them"
        )
    return result


def read_variant(path: Path, catalogue: Mapping[str, Effect] | None = None, load: Load | None = None) -> Variant:
    """The variant in a TOML file; programs in it that the catalogue does not have are given to `load`.

    Raises Failure or UsageError that name the file and the fault.
    """
    known, table = catalogue if catalogue is not None else bundled(), _content(path)
    try:
        unread = _unread(carried.read(table, path), known, path)
        if unread:
            if load is None:
                raise Failure(f"{path}: carries the {' and the '.join(unread.programs())}, and programs are not run here")
            known = {**known, **load(unread)}
        return _variant(table, known, unread.laws)
    except UsageError as error:
        raise UsageError(f"{path}: {error}") from None


def programs_in(path: Path) -> dict[str, Program]:
    """The programs that a variant's file carries, by what each is ("effect my_drag"); none is run. Raises as `read_variant`."""
    try:
        return carried.read(_content(path), path).programs()
    except UsageError as error:
        raise UsageError(f"{path}: {error}") from None


def _content(path: Path) -> dict[str, Any]:
    try:
        return toml(Path(path).read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise Failure(f"{path}: no such file; give a variant that `wheelchair add` wrote") from None
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise Failure(f"{path}: not a TOML file in UTF-8: {error}") from error


def _unread(found: carried.Carried, catalogue: Mapping[str, Effect], path: Path) -> carried.Carried:
    """Those that are not here. What is here under the same name goes before; where that differs, a note says so."""
    here = {(kind, name): own for kind in KINDS for name, own in configured(kind).items()}
    pairs = [(program, catalogue[id].program) for id, program in found.effects.items() if id in catalogue]
    pairs += [(law.program, here[law.kind, law.name].program) for law in found.laws if (law.kind, law.name) in here]
    for theirs, own in pairs:
        if own and own.text != theirs.text:
            name = Path(theirs.file).stem
            warnings.warn(f"{path} carries another {name}; the one in {own.file} is taken", Note, stacklevel=3)
    return carried.Carried(
        {id: program for id, program in found.effects.items() if id not in catalogue},
        tuple(law for law in found.laws if (law.kind, law.name) not in here),
    )


def _variant(file: Mapping[str, Any], catalogue: Mapping[str, Effect], own: tuple[OwnLaw, ...] = ()) -> Variant:
    for key in file:
        if key not in ("laws", "values", *NOTES):
            raise unknown("table", key, ("laws", "values", *NOTES))
    laws, values = _table(file, "laws"), _table(file, "values")
    effects = laws.pop("effects", [])
    if not isinstance(effects, list) or not all(isinstance(e, str) for e in effects):
        raise UsageError(f'effects = {effects!r} in [laws] is no list of ids; write effects = ["relaxation_length"]')
    for effect in effects:
        if effect not in catalogue:
            raise UsageError(
                f"{unknown('effect', effect, catalogue)}; one of your own needs the folder of its file, by --effects"
            )
    for kind in laws:
        if kind not in LAWS:
            raise unknown("law in [laws]", kind, (*LAWS, "effects"))
    base = Variant(Choice(**laws, own=own), catalogue=catalogue, notes={key: file[key] for key in NOTES if key in file})
    return base.with_effects(effects).with_values(values)


def _table(file: Mapping[str, Any], key: str) -> dict[str, Any]:
    if not isinstance(file.get(key, {}), dict):
        raise UsageError(f"{key} = {file[key]!r} is no table; write [{key}] and one line each below it")
    return dict(file.get(key, {}))


def variant_text(variant: Variant) -> str:
    """The variant as TOML that `read_variant` reads, with the programs of a user's effects that are on and of their laws."""
    laws = {kind: getattr(variant.choice, kind) for kind in LAWS}
    told = {"laws": {**laws, "effects": list(variant.effects)}, "values": dict(variant.values), **variant.notes}
    return tomli_w.dumps(told) + carried.text(variant.active(), taken_along(variant.choice, variant.values))
