"""Checks of campaign.toml by itself, before any recording is opened."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from ...faults import WARNING, Fault, suggestion
from ...units import UnitError
from ..axes import ISO, SAE
from ..channels import BY_NAME, CHANNEL_NAMES, TIME
from ..document import CAMPAIGN_KEYS, OTHER_TABLES, PARAMETER_TABLES, RUN_KEYS, Document, Entry, flatten, number
from ..draft import constant_value
from ..formats import FORMATS
from ..noise import NAMES as NOISE_NAMES

Known = Mapping[str, tuple[float, float]]
ROLES = ("fit", "holdout")
_COLUMN_KEYS = {"column": str, "unit": str, "radius": float}


def parameter_tables(known: Known | None) -> tuple[str, ...]:
    """Tables that hold parameters: the usual ones, and the first part of every known name."""
    others = {name.partition(".")[0] for name in known or () if "." in name}
    return (*PARAMETER_TABLES, *sorted(others.difference(PARAMETER_TABLES, OTHER_TABLES)))


def unknown_table(doc: Document, known: Known | None) -> Iterator[Fault]:
    tables = (*OTHER_TABLES, *parameter_tables(known))
    for name, value in doc.data.items():
        if name not in tables and name != "g":
            what = "table" if isinstance(value, dict | list) else "key"
            yield doc.fault(name, f"no {what} {name!r} in a campaign", suggestion(name, tables))
        elif name in tables and name != "run" and not isinstance(value, Mapping):
            yield doc.fault(name, f"{name} = {value!r} is not a table", f"write [{name}] and its keys below")


def unknown_key(doc: Document, known: Known | None) -> Iterator[Fault]:
    for key in doc.table("campaign"):
        if key not in CAMPAIGN_KEYS:
            yield doc.fault(f"campaign.{key}", f"no key {key!r} in [campaign]", suggestion(key, CAMPAIGN_KEYS))
    for entry in doc.entries:
        for key in entry.data:
            if key not in RUN_KEYS:
                fact = f"{entry.title} has no key {key!r}"
                yield doc.fault(f"run.{key}", fact, suggestion(key, RUN_KEYS), entry.place)


def wrong_type(doc: Document, known: Known | None) -> Iterator[Fault]:
    right: dict[str, Callable[[Any], bool]] = {
        "text": lambda v: isinstance(v, str),
        "number": lambda v: number(v) is not None,
        "table": lambda v: isinstance(v, Mapping),
    }
    for entry in doc.entries:
        for key, kind in RUN_KEYS.items():
            if key in entry.data and not right[kind](entry.data[key]):
                fact = f"{entry.title} has {key} = {entry.data[key]!r}, which is no {kind}"
                yield doc.fault(f"run.{key}", fact, f"give a {kind}", entry.place)
    for key in ("name", "axes"):
        value = doc.table("campaign").get(key, "")
        if not isinstance(value, str):
            yield doc.fault(f"campaign.{key}", f"{key} = {value!r} is no text", "put it in quotes")


def no_runs(doc: Document, known: Known | None) -> Iterator[Fault]:
    runs = doc.data.get("run")
    if isinstance(runs, Mapping):
        yield doc.fault("run", "[run] is one table, but runs are a list", "write [[run]] with two brackets")
    elif not doc.entries:
        yield doc.fault("run", "there are no runs", "add a [[run]] with file, manoeuvre and role for each recording")


def no_file(doc: Document, known: Known | None) -> Iterator[Fault]:
    for entry in doc.entries:
        if "file" not in entry.data:
            yield doc.fault("run", f"{entry.title} names no file", 'add file = "..."', entry.place)


def missing_file(doc: Document, known: Known | None) -> Iterator[Fault]:
    for entry in doc.entries:
        if entry.file and not (doc.folder / entry.file).is_file():
            there = [p.relative_to(doc.folder).as_posix() for g in ("*.*", "*/*.*") for p in doc.folder.glob(g)]
            there = sorted(name for name in there if not name.endswith(".toml"))
            cure = suggestion(entry.file, there) if there else "put it beside campaign.toml"
            yield doc.fault("run.file", f"{entry.title}: no such file", cure, entry.place)


def bad_role(doc: Document, known: Known | None) -> Iterator[Fault]:
    for entry in doc.entries:
        role = entry.data.get("role")
        if role is None:
            yield doc.fault("run", f"{entry.title} has no role", 'add role = "fit" or "holdout"', entry.place)
        elif isinstance(role, str) and role not in ROLES:
            fact = f"{entry.title} has the unknown role {role!r}"
            yield doc.fault("run.role", fact, 'use "fit" or "holdout"', entry.place)


def no_fit_run(doc: Document, known: Known | None) -> Iterator[Fault]:
    if doc.entries and not any(entry.text("role") == "fit" for entry in doc.entries):
        yield doc.fault("run.role", "no run has the role 'fit'", 'give role = "fit" to the runs to learn from')


def no_holdout_run(doc: Document, known: Known | None) -> Iterator[Fault]:
    if doc.entries and not any(entry.text("role") == "holdout" for entry in doc.entries):
        cure = 'give role = "holdout" to a run, so that an effect can be proven on data it has not seen'
        yield doc.fault("run.role", "no run has the role 'holdout'", cure, severity=WARNING)


def no_manoeuvre(doc: Document, known: Known | None) -> Iterator[Fault]:
    for entry in doc.entries:
        if "manoeuvre" not in entry.data:
            cure = 'add manoeuvre = "coast-down", "slalom", ...'
            yield doc.fault("run", f"{entry.title} has no manoeuvre", cure, entry.place, WARNING)


def unknown_format(doc: Document, known: Known | None) -> Iterator[Fault]:
    for entry in doc.entries:
        kind = entry.text("format")
        if kind and kind not in FORMATS:
            yield doc.fault("run.format", f"{entry.title}: no format {kind!r}", suggestion(kind, FORMATS), entry.place)


def empty_cut(doc: Document, known: Known | None) -> Iterator[Fault]:
    for entry in doc.entries:
        start, stop = entry.number("from"), entry.number("to")
        if start is not None and stop is not None and start >= stop:
            fact = f"{entry.title} is cut from {start:g} to {stop:g} s, which is no time"
            yield doc.fault("run.from", fact, "make from smaller than to", entry.place)


def shared_samples(doc: Document, known: Known | None) -> Iterator[Fault]:
    """A held-out run must not hold what the fit has seen."""
    for holdout in (e for e in doc.entries if e.text("role") == "holdout" and e.file):
        for fit in (e for e in doc.entries if e.text("role") == "fit" and e.file == holdout.file):
            if _start(fit) < _stop(holdout) and _start(holdout) < _stop(fit):
                fact = f"{holdout.title} is held out but shares samples with run {fit.place + 1}, which is fitted"
                yield doc.fault("run", fact, "separate them by from and to", holdout.place, WARNING)


def _start(entry: Entry) -> float:
    value = entry.number("from")
    return float("-inf") if value is None else value


def _stop(entry: Entry) -> float:
    value = entry.number("to")
    return float("inf") if value is None else value


def bad_axes(doc: Document, known: Known | None) -> Iterator[Fault]:
    axes = doc.table("campaign").get("axes")
    if axes is None:
        cure = f'write axes = "{SAE}" (y right) or "{ISO}" (y left) in [campaign]'
        yield doc.fault("campaign", f"no axes given, {SAE} assumed", cure, severity=WARNING)
    elif isinstance(axes, str) and axes not in (SAE, ISO):
        yield doc.fault("campaign.axes", f"no axes {axes!r}", f'use "{SAE}" (y right) or "{ISO}" (y left)')


def bad_parameter(doc: Document, known: Known | None) -> Iterator[Fault]:
    for name, value in doc.parameters(parameter_tables(known)).items():
        yield from _parameter(doc, name, value, known, name)


def bad_set(doc: Document, known: Known | None) -> Iterator[Fault]:
    for entry in doc.entries:
        for name, value in flatten(entry.table("set")):
            yield from _parameter(doc, name, value, known, f"run.set.{name}", entry)


def bad_prior(doc: Document, known: Known | None) -> Iterator[Fault]:
    for name, value in flatten(doc.table("prior")):
        path, sd = f"prior.{name}", number(value)
        if known is not None and name not in known:
            yield doc.fault(path, f"no parameter {name!r}", suggestion(name, known))
        if sd is None or sd <= 0:
            fact = f"the prior of {name} is {value!r}"
            yield doc.fault(path, fact, "give a standard deviation above 0 in the unit of the parameter")


def _parameter(
    doc: Document, name: str, value: Any, known: Known | None, path: str, entry: Entry | None = None
) -> Iterator[Fault]:
    place, title = (entry.place, f"{entry.title}: ") if entry else (None, "")
    if known is not None and name not in known:
        yield doc.fault(path, f"{title}no parameter {name!r}", suggestion(name, known), place)
        return
    plain = number(value)
    if plain is None:
        yield doc.fault(path, f"{title}{name} = {value!r} is not a finite number", "give a number in SI units", place)
    elif known is not None:
        lower, upper = known[name]
        if not lower <= plain <= upper:
            fact = f"{title}{name} = {plain:g} is outside {lower:g} to {upper:g}"
            yield doc.fault(path, fact, "correct it; parameters are in SI units", place)


def bad_column(doc: Document, known: Known | None) -> Iterator[Fault]:
    names = (TIME.name, *BY_NAME)
    for name, value in doc.table("columns").items():
        path = f"columns.{name}"
        if name not in names:
            yield doc.fault(path, f"[columns] has no channel {name!r}", suggestion(name, names))
        elif isinstance(value, Mapping):
            yield from _column_table(doc, name, value, path)
        elif not isinstance(value, str):
            cure = 'write a header in quotes, or { column = "...", radius = ... }'
            yield doc.fault(path, f"[columns] {name} = {value!r} is no header", cure)


def _column_table(doc: Document, name: str, value: Mapping[str, Any], path: str) -> Iterator[Fault]:
    for key, entry in value.items():
        if key not in _COLUMN_KEYS:
            yield doc.fault(path, f"[columns] {name} has no key {key!r}", suggestion(key, _COLUMN_KEYS))
        elif key == "radius" and not (number(entry) or 0) > 0:
            yield doc.fault(path, f"[columns] {name}: radius = {entry!r}", "give a radius above 0, in m")
        elif key != "radius" and not isinstance(entry, str):
            yield doc.fault(path, f"[columns] {name}: {key} = {entry!r} is no text", "put it in quotes")
    if "radius" in value and BY_NAME.get(name, TIME).rotary is None:
        yield doc.fault(path, f"[columns] {name} has a radius, but no wheel turns it", "remove the radius")


def bad_constant(doc: Document, known: Known | None) -> Iterator[Fault]:
    for entry in doc.entries:
        for name, value in entry.table("constant").items():
            path = f"run.constant.{name}"
            if name not in BY_NAME:
                fact = f"{entry.title}: constant has no channel {name!r}"
                yield doc.fault(path, fact, suggestion(name, BY_NAME), entry.place)
                continue
            try:
                constant_value(BY_NAME[name], value)
            except UnitError as error:
                yield doc.fault(path, f"{entry.title}: constant {name}: {error.fact}", error.cure, entry.place)


def unknown_noise(doc: Document, known: Known | None) -> Iterator[Fault]:
    for table, names in (("noise", NOISE_NAMES), ("nuisance", CHANNEL_NAMES)):
        for name in doc.table(table):
            if name not in names:
                yield doc.fault(f"{table}.{name}", f"[{table}] has no channel {name!r}", suggestion(name, names))


DOCUMENT_CHECKS: tuple[Callable[[Document, Known | None], Iterator[Fault]], ...] = (
    unknown_table, unknown_key, wrong_type, no_runs, no_file, missing_file, bad_role, no_fit_run, no_holdout_run,
    no_manoeuvre, unknown_format, empty_cut, shared_samples, bad_axes, bad_parameter, bad_set, bad_prior, bad_column,
    bad_constant, unknown_noise,
)  # fmt: skip
