"""A sweep's plan: a TOML file as data, or all its faults with line and cure.

::

    [sweep]
    method = "sobol"                 # grid | random | sobol | morris | saltelli
    samples = 1024                   # not for a grid
    seed = 1
    campaign = "my-campaign"         # optional: the whitened RMS error against it

    [parameters]                     # any FMI parameter, SI units
    "tyre.C_lambda" = { from = 2500, to = 10000, steps = 5, log = true }
    "chair.m" = [60, 80, 100]

    [[manoeuvre]]                    # options as those of `wheelchair simulate`; a list is one manoeuvre for each
    name = "slalom"
    delta_force = [5, 10]

    [[variant]]                      # optional: files that `wheelchair add` wrote
    file = "better.toml"
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from inspect import signature
from itertools import product
from math import isfinite
from pathlib import Path
from typing import Any

from ...contracts.own import checked, variant_in
from ...errors import FileError, WheelchairError
from ...faults import Fault, not_utf8, suggestion
from ...given import toml
from ...handling.manoeuvres import MANOEUVRES, Manoeuvre, manoeuvre
from ...model.effects import sources
from ...model.former import former
from ...model.recipe import Recipe
from ...model.stage import Effect
from ...model.variant import effects_in, number
from ...quantities import Parameter
from .design import INDICES, METHODS, Axis, Design

TABLES = ("sweep", "parameters", "manoeuvre", "variant")
SWEEP_KEYS = ("method", "samples", "seed", "campaign")
RANGE_KEYS = ("from", "to", "steps", "log")
BALANCED = ("sobol", "saltelli")  # sequences whose properties hold for powers of two


class PlanError(FileError):
    """Faults in a plan."""


@dataclass(frozen=True)
class Course:
    """A manoeuvre by name and options; `label` tells it from the others."""

    label: str
    name: str
    options: tuple[tuple[str, float], ...]

    def manoeuvre(self) -> Manoeuvre:
        return manoeuvre(self.name, **dict(self.options))


@dataclass(frozen=True)
class Chair(Recipe):
    """A variant that the plan names by a `label`."""

    label: str = "default"


@dataclass(frozen=True)
class Plan:
    """Which chairs, which variants of each, through which manoeuvres and whether against a campaign."""

    design: Design
    courses: tuple[Course, ...]
    chairs: tuple[Chair, ...]
    campaign: Path | None = None

    @property
    def cases(self) -> int:
        """Runs of each chair; all recorded runs of a campaign count as one."""
        return len(self.chairs) * (len(self.courses) + (self.campaign is not None))

    @property
    def runs(self) -> int:
        return self.design.chairs * self.cases


def read_plan(path: Path, effects: Path | None = None) -> Plan:
    """The plan in a TOML file, which may name the `effects` in a folder of the user's own.

    Raises PlanError with every fault, ModelError for a folder that is not there, and EffectError for what is wrong with the
    effects in it.
    """
    own = sources(effects) if effects else ()
    checked(own)
    reader = _Reader(path, Chair(own=own))
    plan = reader.plan()
    if reader.faults or plan is None:
        reader.faults.sort(key=lambda fault: (fault.line is None, fault.line or 0))
        raise PlanError(reader.faults)
    return plan


def variant_files(path: Path) -> list[Path]:
    """The variants that a plan names; none where it cannot be read, which `read_plan` says."""
    try:
        entries = toml(path.read_text(encoding="utf-8-sig")).get("variant", [])
    except (OSError, ValueError):
        return []
    named = (entry.get("file") for entry in entries if isinstance(entry, dict)) if isinstance(entries, list) else ()
    return [path.parent / file for file in dict.fromkeys(named) if isinstance(file, str)]


@dataclass
class _Reader:
    path: Path
    bare: Chair
    faults: list[Fault] = field(default_factory=list)
    data: dict[str, Any] = field(default_factory=dict)
    lines: dict[str, int] = field(default_factory=dict)

    @cached_property
    def catalogue(self) -> Mapping[str, Effect]:
        return self.bare.variant().catalogue

    def plan(self) -> Plan | None:
        if not self._load():
            return None
        for key in self.data:
            if key not in TABLES:
                self.fault(key, f"no table {key!r} in a plan", suggestion(key, TABLES))
        sweep = self._table("sweep")
        for key in sweep:
            if key not in SWEEP_KEYS:
                self.fault(f"sweep.{key}", f"[sweep] has no {key!r}", suggestion(key, SWEEP_KEYS))
        chairs = self._chairs()
        design = self._design(sweep, chairs)
        courses = tuple(self._courses())
        campaign = self._campaign(sweep)
        if not courses and not self._tables("manoeuvre") and "campaign" not in sweep:
            self.fault("", "there is nothing to run", 'add [[manoeuvre]] with name = "steady-turn", or a campaign')
        if self.faults:
            return None
        effects = self._effects_of(axis.name for axis in design.axes)
        return Plan(design, courses, tuple(c.with_effects(effects) for c in chairs), campaign)

    def fault(self, key: str, fact: str, cure: str) -> None:
        self.faults.append(Fault(self.path.name, self._line(key), None, fact, cure))

    def refused(self, key: str, error: WheelchairError) -> None:
        """The fault of what something else has refused in a sentence of fact and cure."""
        words = re.sub(r"--([a-z][a-z-]*)", lambda option: option[1].replace("-", "_"), str(error))
        fact, _, cure = words.partition("; " if "; " in words else ": ")
        self.fault(key, fact, cure)

    def _line(self, key: str) -> int | None:
        while key and key not in self.lines:
            key = key.rpartition(".")[0]
        return self.lines.get(key)

    def _load(self) -> bool:
        try:
            raw = self.path.read_bytes()
            text = raw.decode("utf-8-sig").replace("\r\n", "\n")
            self.data = toml(text)
        except FileNotFoundError:
            self.fault("", "no such file", "check the path")
        except UnicodeDecodeError as error:
            self.faults.append(not_utf8(self.path.name, raw, error))
        except tomllib.TOMLDecodeError as error:
            place = re.search(r" \(at line (\d+), column \d+\)", str(error))
            line = int(place[1]) if place else text.count("\n") + 1
            self.faults.append(
                Fault(
                    self.path.name,
                    line,
                    None,
                    f"not valid TOML: {str(error).partition(' (at ')[0].lower()}",
                    "correct this line",
                )
            )
        else:
            self.lines = _lines(text)
            return True
        return False

    def _table(self, name: str) -> dict[str, Any]:
        value = self.data.get(name, {})
        if isinstance(value, dict):
            return value
        self.fault(name, f"{name} is no table", f"write [{name}] on a line of its own")
        return {}

    def _tables(self, name: str) -> list[dict[str, Any]]:
        value = self.data.get(name, [])
        if isinstance(value, list) and all(isinstance(entry, dict) for entry in value):
            return value
        self.fault(name, f"{name} is no list of tables", f"write [[{name}]] on a line of its own")
        return []

    # the chairs

    def _design(self, sweep: Mapping[str, Any], chairs: tuple[Chair, ...]) -> Design:
        method = sweep.get("method", "grid")
        if method not in METHODS:
            self.fault("sweep.method", f"no method {method!r}", suggestion(str(method), METHODS))
            method = ""  # whatever is said for one that is known would be said in vain
        axes = tuple(self._axes(method, chairs))
        if not self._table("parameters"):
            if method not in ("grid", ""):
                self.fault("sweep.method", f"{method} needs parameters to vary", "add [parameters] with a range for each")
            return Design("grid", ())
        samples = self._whole(sweep, "samples", 2 if method in INDICES else 1) if method not in ("grid", "") else 1
        if method == "grid" and "samples" in sweep:
            self.fault("sweep.samples", "a grid has no samples", "leave it out; each parameter has its own steps or list")
        elif method in BALANCED and samples & (samples - 1):
            below = 1 << (samples.bit_length() - 1)
            self.fault(
                "sweep.samples",
                f"samples = {samples} is no power of two, and Sobol' points are even only then",
                f"give {below} or {2 * below}",
            )
        return Design(method, axes, max(samples, 1), self._whole(sweep, "seed", 0, 0))

    def _whole(self, table: Mapping[str, Any], key: str, least: int, default: int | None = None) -> int:
        value = table.get(key, default)
        if isinstance(value, int) and not isinstance(value, bool) and value >= least:
            return value
        fact = f"{key} is missing" if value is None else f"{key} = {value!r} is no whole number of at least {least}"
        self.fault(f"sweep.{key}", fact, f"write for example {key} = {max(least, 64)}")
        return least

    def _axes(self, method: str, chairs: tuple[Chair, ...]) -> Iterator[Axis]:
        given = dict(_flat(self._table("parameters"), set(self._records((self.bare,), tuple(self.catalogue)))))
        records = self._records(chairs or (self.bare,), self._effects_of(given))
        effects = {**self.catalogue, **{id: e for c in chairs for id, e in c.variant().catalogue.items()}}
        for name, value in given.items():
            key = f"parameters.{name}"
            if instead := dict(former([name])).get(name):
                names = " and ".join(p.name for p in instead)
                self.fault(key, f"{name} is the former name of a part of {names}", f"vary {names}")
                continue
            if name not in records:
                self.fault(key, f"no parameter {name!r}", suggestion(name, records))
                continue
            effect = name.split(".")[1] if name.startswith("effect.") else ""
            if effect and effects[effect].delays_record:
                self.fault(key, f"effect {effect!r} shifts recorded pushes and is no part of a chair", "leave it out")
                continue
            try:
                yield self._axis(method, records[name], value)
            except WheelchairError as error:
                self.refused(key, error)
            except ValueError as error:
                fact, cure = error.args
                self.fault(key, f"{name}: {fact}", cure)

    def _effects_of(self, names: Iterable[str]) -> tuple[str, ...]:
        """The effects in the catalogue that parameters named so belong to."""
        return tuple(effect for effect in effects_in(names) if effect in self.catalogue)

    def _records(self, chairs: tuple[Chair, ...], effects: tuple[str, ...]) -> dict[str, Parameter]:
        """Every parameter that all of the chairs have, or can have by an effect; with these `effects` on."""
        optional = {p.name: p for e in self.catalogue.values() for p in e.owned}
        own = [{p.name: p for p in c.with_effects(effects).variant().parameters()} for c in chairs]
        return optional | {name: p for name, p in own[0].items() if all(name in other for other in own)}

    def _axis(self, method: str, record: Parameter, value: Any) -> Axis:
        """Raises ValueError(fact, cure), or what `number` raises."""
        records = {record.name: record}
        if isinstance(value, list):
            if method in INDICES:
                raise ValueError("sensitivity indices need a range, not a list", "write { from = …, to = … }")
            if not value or any(isinstance(v, bool | list | dict) for v in value):
                raise ValueError(f"{value!r} is no list of values", "write for example [60, 80, 100]")
            return Axis(record.name, tuple(number(records, record.name, v) for v in value), choices=record.choices)
        if not isinstance(value, dict):
            raise ValueError(f"{value!r} is neither a list nor a range", f"write [{value!r}], or {{ from = …, to = … }}")
        return self._range(method, record, value)

    def _range(self, method: str, record: Parameter, value: dict[str, Any]) -> Axis:
        if record.choices:
            raise ValueError("named choices have no range", f"write a list of {', '.join(record.choices)}")
        for key in value:
            if key not in RANGE_KEYS:
                raise ValueError(f"a range has no {key!r}", suggestion(key, RANGE_KEYS))
        if "from" not in value or "to" not in value:
            raise ValueError("the range has no beginning or no end", "write { from = …, to = … }")
        if any(isinstance(value[key], bool | str | list | dict) for key in ("from", "to")):
            raise ValueError(
                f"from = {value['from']!r}, to = {value['to']!r} are no numbers", f"give numbers in {record.unit.name}"
            )
        lower, upper = (number({record.name: record}, record.name, value[key]) for key in ("from", "to"))
        steps, log = value.get("steps", 0), value.get("log", False)
        if not lower < upper:
            raise ValueError(f"the range goes from {lower:g} to {upper:g}", "let it rise")
        if method == "grid" and (not isinstance(steps, int) or isinstance(steps, bool) or steps < 2):
            raise ValueError("a grid needs steps, a whole number of at least 2", "write { from = …, to = …, steps = 5 }")
        if method not in ("grid", "") and "steps" in value:
            raise ValueError(f"steps mean nothing for {method}", "leave them out; samples says how many points there are")
        if not isinstance(log, bool) or (log and lower <= 0):
            raise ValueError(f"log = {log!r} from {lower:g}", "give true or false, and true only for ranges above 0")
        return Axis(record.name, lower=lower, upper=upper, steps=steps, log=log)

    # what they are put through

    def _courses(self) -> Iterator[Course]:
        labels: set[str] = set()
        for i, entry in enumerate(self._tables("manoeuvre")):
            key = f"manoeuvre.{i}"
            name = entry.get("name")
            if name not in MANOEUVRES:
                self.fault(f"{key}.name", f"no manoeuvre {name!r}", suggestion(str(name), MANOEUVRES))
                continue
            for course in self._expanded(key, str(name), {k: v for k, v in entry.items() if k != "name"}):
                if course.label in labels:
                    self.fault(key, f"manoeuvre {course.label!r} comes twice", "leave one out, or give it other options")
                labels.add(course.label)
                yield course

    def _expanded(self, key: str, name: str, given: Mapping[str, Any]) -> Iterator[Course]:
        """One course for each combination of listed options."""
        known = tuple(signature(MANOEUVRES[name]).parameters)
        lists: dict[str, list[float]] = {}
        for option, value in given.items():
            numbers = value if isinstance(value, list) else [value]
            if option not in known:
                self.fault(f"{key}.{option}", f"{name} has no {option!r}", suggestion(option, known))
            elif not numbers or not all(_plain(v) for v in numbers):
                self.fault(f"{key}.{option}", f"{option} = {value!r} is no number", "give a number, or a list of numbers")
            else:
                lists[option] = [float(v) for v in numbers]
        for values in product(*lists.values()):
            options = tuple(zip(lists, values, strict=True))
            course = Course(" ".join((name, *(f"{option}={value:g}" for option, value in options))), name, options)
            try:
                course.manoeuvre()
            except WheelchairError as error:
                self.refused(key, error)
            else:
                yield course

    def _chairs(self) -> tuple[Chair, ...]:
        chairs = tuple(self._named_chairs())
        return chairs if self._tables("variant") else (self.bare,)

    def _named_chairs(self) -> Iterator[Chair]:
        labels: set[str] = set()
        for i, entry in enumerate(self._tables("variant")):
            key = f"variant.{i}"
            for word in entry:
                if word not in ("file", "name"):
                    self.fault(f"{key}.{word}", f"[[variant]] has no {word!r}", suggestion(word, ("file", "name")))
            file = entry.get("file")
            if not isinstance(file, str):
                self.fault(f"{key}.file", "the variant has no file", 'write file = "better.toml", relative to the plan')
                continue
            label = str(entry.get("name", Path(file).stem))
            if label in labels:
                self.fault(key, f"variant {label!r} comes twice", "give each its own name")
            labels.add(label)
            try:
                variant = variant_in(self.path.parent / file, self.catalogue)
            except WheelchairError as error:
                self.refused(f"{key}.file", error)
            else:
                yield replace(Chair.of(variant), label=label)

    def _campaign(self, sweep: Mapping[str, Any]) -> Path | None:
        if "campaign" not in sweep:
            return None
        place = self.path.parent / str(sweep["campaign"])
        if not place.exists():
            self.fault("sweep.campaign", f"{place}: no such folder", "give a folder with campaign.toml, relative to the plan")
        return place


def _plain(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value)


def _flat(table: Mapping[str, Any], known: set[str], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Dotted names and their lists or ranges: [parameters.chair] m and [parameters] "chair.m" are both chair.m."""
    for key, value in table.items():
        name = f"{prefix}.{key}" if prefix else key
        if isinstance(value, dict) and name not in known and not set(value) & set(RANGE_KEYS):
            yield from _flat(value, known, name)
        else:
            yield name, value


_HEADER = re.compile(r"\s*(\[\[?)\s*([^\[\]]+?)\s*\]")
_KEY = re.compile(r"""\s*((?:"[^"]*"|'[^']*'|[\w-]+)(?:\s*\.\s*(?:"[^"]*"|'[^']*'|[\w-]+))*)\s*=""")


def _lines(text: str) -> dict[str, int]:
    """Line of every table and key by dotted name, counted from 1; of [[tables]] with their place, as manoeuvre.0.name."""
    lines: dict[str, int] = {}
    counts: dict[str, int] = {}
    table = ""
    for i, row in enumerate(text.split("\n"), start=1):
        if header := _HEADER.match(row):
            table = re.sub(r"[\"'\s]", "", header[2])
            if header[1] == "[[":
                counts[table] = counts.get(table, -1) + 1
                lines.setdefault(table, i)
                table = f"{table}.{counts[table]}"
            lines.setdefault(table, i)
        elif key := _KEY.match(row):
            name = re.sub(r"[\"']", "", re.sub(r"\s*\.\s*", ".", key[1]))
            lines.setdefault(f"{table}.{name}" if table else name, i)
    return lines
