"""Checks of campaign.toml by itself, before any recording is opened."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from math import copysign, degrees, hypot, isfinite, pi, remainder
from typing import Any

from ...faults import NOTE, SHOWN, WARNING, Fault, suggestion
from ...given import what_is
from ...model.former import clash, former, renamed
from ...model.mounting import FARTHEST
from ...units import UnitError, quantity
from .. import body
from ..axes import ISO, SAE
from ..channels import BY_FMU_NAME, BY_NAME, CHANNEL_NAMES, INPUTS, MOUNTED, SOURCES, TIME, Channel
from ..derived import ENDS
from ..devices import FASTEST, devices, parts, point, point_of
from ..document import REPEATED, Document, Entry, flatten, number
from ..draft import constant_value
from ..formats import formats, known_options
from ..noise import NAMES as NOISE_NAMES
from ..recorded import PUSHES_CLOCK
from ..schema import CAMPAIGN, COLUMN, OTHER_TABLES, PARAMETER_TABLES, RECORDING, RUN, TableRecord, fits

CASTERS = ("start.caster_l", "start.caster_r")
THIRDS, EIGHTHS = (1 / 3, 2 / 3), tuple(n / 8 for n in range(1, 9))  # as shares of a turn would be written
TYRE_LAW = "tyre.law"  # which a whole number stands for
OF_A_VARIANT = 'choose the law in a variant (tyre = "dugoff" under [laws]) and give that with --variant'
ROUNDED = 0.005  # by which a third may be
PLACED = frozenset(name for names in MOUNTED.values() for name in names)  # channels for which it matters where they are read
Known = Mapping[str, tuple[float, float]]
ROLES = ("fit", "holdout")
OFF = f"is more than {FARTHEST:g} m from the centre of mass, off any chair"
CURES_OF_KINDS = {"point": "give two numbers, [x, y] in m"}
CLOCK_KEYS = ("offset", "sd", "drift")
MOST_KEYS = 1000  # of a table; all parameters together are some hundred


def parameter_tables(known: Known | None) -> tuple[str, ...]:
    """Tables that hold parameters: the usual ones, and the first part of every known name."""
    others = {name.partition(".")[0] for name in known or () if "." in name}
    return (*PARAMETER_TABLES, *sorted(others.difference(PARAMETER_TABLES, OTHER_TABLES)))


def crowded(doc: Document) -> list[Fault]:
    """A table with more keys than there are names to give is no campaign's, and judging each would take for ever."""
    tables = {"the file": doc.data, **{f"[{name}]": value for name, value in doc.data.items() if isinstance(value, Mapping)}}
    tables |= {entry.title: entry.data for entry in doc.entries}
    found = [(name, len(value)) for name, value in tables.items() if len(value) > MOST_KEYS]
    return [
        doc.fault("", f"{name} has {count} keys, but at most {MOST_KEYS} make sense", "is this the right file?")
        for name, count in found[:SHOWN]
    ]


def unknown_table(doc: Document, known: Known | None) -> Iterator[Fault]:
    tables = (*OTHER_TABLES, *parameter_tables(known))
    for name, value in doc.data.items():
        if name not in tables and name != "g":
            what = "table" if isinstance(value, dict | list) else "key"
            yield doc.fault(name, f"no {what} {name!r} in a campaign", suggestion(name, tables))
        elif name in tables and name not in REPEATED and not isinstance(value, Mapping):
            yield doc.fault(name, f"{name} = {value!r} is not a table", f"write [{name}] and its keys below")


def _tables(doc: Document) -> Iterator[tuple[TableRecord, str, int | None, Mapping[str, Any]]]:
    """Every table whose keys are fixed: its record, how messages call it, its place in its list, and what it holds."""
    yield CAMPAIGN, "[campaign]", None, doc.table("campaign")
    for entry in doc.entries:
        yield RUN, entry.title, entry.place, entry.data
    for place, table in enumerate(doc.recordings):
        yield RECORDING, _device_title(place, table), place, table


def _device_title(place: int, table: Mapping[str, Any]) -> str:
    name = table.get("device")
    return f"recording {place + 1}" + (f" ({name})" if isinstance(name, str) and name else "")


def _kinds(record: TableRecord) -> dict[str, str]:
    """The keys of a table, options of formats among them where it describes files, and the kind of each."""
    options = {} if record is CAMPAIGN else {"format": "text"} | {name: o.kind for name, o in known_options().items()}
    return options | {k.name: k.kind for k in record.keys}


def unknown_key(doc: Document, known: Known | None) -> Iterator[Fault]:
    for record, title, place, table in _tables(doc):
        allowed = _kinds(record)
        for key in table:
            if key not in allowed:
                fact = f"no key {key!r} in {title}" if place is None else f"{title} has no key {key!r}"
                yield doc.fault(f"{record.name}.{key}", fact, suggestion(key, allowed), place)


def wrong_type(doc: Document, known: Known | None) -> Iterator[Fault]:
    for record, title, place, table in _tables(doc):
        for key, kind in _kinds(record).items():
            if key in table and not fits(table[key], kind):
                of, give = (f"{title} has ", f"give a {kind}") if place is not None else ("", "put it in quotes")
                cure = CURES_OF_KINDS.get(kind, give)
                fact = f"{of}{key} = {table[key]!r}{', which' if of else ''} is no {kind}"
                yield doc.fault(f"{record.name}.{key}", fact, cure, place)


def bad_recording(doc: Document, known: Known | None) -> Iterator[Fault]:
    if isinstance(doc.data.get("recording"), Mapping):
        fact = "[recording] is one table, but devices are a list"
        yield doc.fault("recording", fact, "write [[recording]] with two brackets")
    seen: dict[str, int] = {}
    for place, table in enumerate(doc.recordings):
        name = table.get("device")
        if not isinstance(name, str) or not name:
            yield doc.fault("recording", f"recording {place + 1} has no device", 'add device = "..."', place)
        elif name in seen:
            fact = f"recording {place + 1} describes the device {name!r} again, as recording {seen[name] + 1} does"
            yield doc.fault("recording.device", fact, "give each device one name and one [[recording]]", place)
        else:
            seen[name] = place
    used = {name for entry in doc.entries for name in entry.table("files")}
    for name in seen.keys() - used:
        yield doc.fault(
            "recording.device",
            f"no run has a file of the device {name!r}",
            suggestion(name, used) if used else "write files = { " + name + ' = "..." } in a run',
            seen[name],
            WARNING,
        )


def bad_markers(doc: Document, known: Known | None) -> Iterator[Fault]:
    for place, table in enumerate(doc.recordings):
        named = table.get("markers")
        if not isinstance(named, Mapping) or not named:
            continue
        title = _device_title(place, table)
        for name in named:
            if name not in (*ENDS, *body.MARKERS):
                fact = f"{title}: markers has no place {name!r}"
                yield doc.fault("recording.markers", fact, suggestion(name, (*ENDS, *body.MARKERS)), place)
        if named.keys() & set(body.MARKERS) and not named.keys() & body.TRUNKS:
            fact = f"{title}: markers are on the body, but none on the trunk"
            yield doc.fault("recording.markers", fact, "name one of shoulder_l, shoulder_r, c7 and sternum, or none", place)


def bad_files(doc: Document, known: Known | None) -> Iterator[Fault]:
    there = devices(doc)
    for entry in doc.entries:
        if "file" in entry.data and "files" in entry.data:
            yield doc.fault("run.files", f"{entry.title} has file and files", "keep one of them", entry.place)
        for name, file in entry.table("files").items():
            if name not in there:
                fact = f"{entry.title}: no device {name!r}"
                cure = suggestion(name, there) if there else f'describe it by [[recording]] device = "{name}"'
                yield doc.fault("run.files", fact, cure, entry.place)
            if not isinstance(file, str):
                yield doc.fault(
                    "run.files", f"{entry.title}: the file of {name} is {file!r}", "put its name in quotes", entry.place
                )


def bad_clocks(doc: Document, known: Known | None) -> Iterator[Fault]:
    for entry in doc.entries:
        files = entry.table("files")
        for name, stands in entry.table("clocks").items():
            if name not in (files or (PUSHES_CLOCK,)):
                fact = f"{entry.title}: clocks has {name!r}, of which it has no file"
                yield doc.fault("run.clocks", fact, suggestion(name, files or (PUSHES_CLOCK,)), entry.place)
            given = stands if isinstance(stands, Mapping) else {"offset": stands}
            for fact, cure in _of_a_clock(given):
                yield doc.fault("run.clocks", f"{entry.title}: the clock of {name} has {fact}", cure, entry.place)
            if not files and number(given.get("drift")):
                fact = f"{entry.title}: the drift of {name} changes nothing: they stand in the same file as the readings"
                yield doc.fault("run.clocks", fact, "leave it out", entry.place, WARNING)


def _of_a_clock(given: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """What is wrong in how a clock stands, and what to do about it."""
    for key, value in given.items():
        told = number(value)
        if key not in CLOCK_KEYS:
            yield f"no key {key!r}", suggestion(key, CLOCK_KEYS)
        elif told is None or (key == "sd" and told < 0):
            yield f"{key} = {value!r}", "give a number in s" if key != "drift" else "give a number"
        elif key == "drift" and abs(told) > FASTEST:
            yield f"drift = {value!r}, but no clock gains so much", "give it in s per s: 40e-6 for 40 parts per million"


def bad_point(doc: Document, known: Known | None) -> Iterator[Fault]:
    for name, entry in doc.table("sensor").items():
        if name not in CHANNEL_NAMES:
            yield doc.fault(f"sensor.{name}", f"[sensor] has no channel {name!r}", suggestion(name, CHANNEL_NAMES))
        elif point_of(entry) is None:
            cure = f"write sensor.{name}.at = [x, y], in m forward and to the right of the centre of mass"
            yield doc.fault(f"sensor.{name}", f"[sensor] {name} = {entry!r} is no point", cure)
        elif hypot(*(point_of(entry) or ())) > FARTHEST:
            yield doc.fault(f"sensor.{name}", f"[sensor] {name}.at = {entry['at']} {OFF}", "write it in m")
        elif name not in PLACED:
            fact = f"[sensor] {name}.at changes nothing: {name} reads the same wherever it sits"
            yield doc.fault(f"sensor.{name}", fact, "leave it out", severity=NOTE)
    for place, table in enumerate(doc.recordings):
        if hypot(*(point(table.get("at")) or ())) > FARTHEST:
            fact = f"{_device_title(place, table)}: at = {table['at']} {OFF}"
            yield doc.fault("recording.at", fact, "write it in m", place)


def no_runs(doc: Document, known: Known | None) -> Iterator[Fault]:
    runs = doc.data.get("run")
    if isinstance(runs, Mapping):
        yield doc.fault("run", "[run] is one table, but runs are a list", "write [[run]] with two brackets")
    elif isinstance(runs, list) and len(doc.entries) < len(runs):
        yield doc.fault("run", f"{len(runs) - len(doc.entries)} of the runs are no tables", "write [[run]] above each")
    elif not doc.entries:
        yield doc.fault("run", "there are no runs", "add a [[run]] with file, manoeuvre and role for each recording")


def no_file(doc: Document, known: Known | None) -> Iterator[Fault]:
    for entry in doc.entries:
        file = entry.data.get("file", "")
        if "files" not in entry.data and isinstance(file, str) and not file.strip():
            yield doc.fault("run.file", f"{entry.title} names no file", 'add file = "..."', entry.place)


def missing_file(doc: Document, known: Known | None) -> Iterator[Fault]:
    there: list[str] | None = None
    for entry in doc.entries:
        for part in (p for p in parts(doc, entry) if p.file.strip()):
            kind, key = what_is(doc.folder / part.file), "run.file" if part.alone else "run.files"
            of = "" if part.alone else f" as {part.file!r} of {part.device.name}"
            if kind == "no file":
                there = _recordings(doc) if there is None else there
                cure = suggestion(part.file, there) if there else "put it beside campaign.toml"
                yield doc.fault(key, f"{entry.title}: no such file{of}", cure, entry.place)
            elif kind:
                yield doc.fault(key, f"{entry.title}: this is {kind}, not a recording", "name a file", entry.place)


def _recordings(doc: Document) -> list[str]:
    """Files beside campaign.toml and in folders there."""
    names = (p.relative_to(doc.folder).as_posix() for g in ("*.*", "*/*.*") for p in doc.folder.glob(g) if p.is_file())
    return sorted(name for name in names if not name.endswith(".toml"))


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
    for record, title, place, table in _tables(doc):
        kind = table.get("format")
        if record is not CAMPAIGN and isinstance(kind, str) and kind and kind not in formats()[0]:
            yield doc.fault(f"{record.name}.format", f"{title}: no format {kind!r}", suggestion(kind, formats()[0]), place)


def own_formats(doc: Document, known: Known | None) -> Iterator[Fault]:
    """Formats of the user's own that cannot be used."""
    yield from formats()[1]


def empty_cut(doc: Document, known: Known | None) -> Iterator[Fault]:
    for entry in doc.entries:
        start, stop = entry.number("from"), entry.number("to")
        if start is not None and stop is not None and start >= stop:
            fact = f"{entry.title} is cut from {start:g} to {stop:g} s, which is no time"
            yield doc.fault("run.from", fact, "make from smaller than to", entry.place)


def shared_samples(doc: Document, known: Known | None) -> Iterator[Fault]:
    """A held-out run must not hold what the fit has seen."""
    files = {entry.place: {part.file for part in parts(doc, entry)} for entry in doc.entries}
    for holdout in (e for e in doc.entries if e.text("role") == "holdout"):
        for fit in (e for e in doc.entries if e.text("role") == "fit" and files[e.place] & files[holdout.place]):
            if _overlap(fit, holdout):
                fact = f"{holdout.title} is held out but shares samples with run {fit.place + 1}, which is fitted"
                yield doc.fault("run", fact, "separate them by from and to", holdout.place, WARNING)


def fitted_twice(doc: Document, known: Known | None) -> Iterator[Fault]:
    """Samples that count twice make estimates look surer than they are."""
    fitted = [(entry, {part.file for part in parts(doc, entry)}) for entry in doc.entries if entry.text("role") == "fit"]
    for i, (entry, files) in enumerate(fitted):
        for other, those in fitted[:i]:
            if files and files == those and _overlap(entry, other):
                fact = f"{entry.title} has the samples of run {other.place + 1} again, and both are fitted"
                yield doc.fault("run", fact, "remove one of them, or separate them by from and to", entry.place, WARNING)


def _overlap(one: Entry, other: Entry) -> bool:
    return _start(one) < _stop(other) and _start(other) < _stop(one)


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
    yield from _parameters(doc, doc.parameters(parameter_tables(known)), known)


def bad_set(doc: Document, known: Known | None) -> Iterator[Fault]:
    for entry in doc.entries:
        yield from _parameters(doc, dict(flatten(entry.table("set"))), known, entry)


def _parameters(doc: Document, values: Mapping[str, Any], known: Known | None, entry: Entry | None = None) -> Iterator[Fault]:
    """What is wrong with the values, and a warning that says how former names are read."""
    path, place, title = ("run.set.", entry.place, f"{entry.title}: ") if entry else ("", None, "")
    old = [name for name, _ in former(values)]
    for name, value in values.items():
        if name not in old:
            yield from _parameter(doc, name, value, known, path + name, entry)
        elif number(value) is None:
            yield from _parameter(doc, name, value, None, path + name, entry)
    if not old or any(number(values[name]) is None for name in old):
        return
    where = path + old[0]
    if fact := clash(values):
        yield doc.fault(where, title + fact.partition("; ")[0], fact.partition("; ")[2], place)
        return
    tables = parameter_tables(known)
    before = doc.known(tables) if entry and not clash(doc.parameters(tables)) else {}
    today, notes = renamed({name: values[name] for name in old}, before)
    for note in notes:
        yield doc.fault(where, title + note, "write these", place, WARNING)
    for name, value in today.items():
        yield from _parameter(doc, name, value, known, where, entry)


def bad_prior(doc: Document, known: Known | None) -> Iterator[Fault]:
    for name, value in flatten(doc.table("prior")):
        path, sd = f"prior.{name}", number(value)
        if instead := dict(former([name])).get(name):
            names = " and ".join(p.name for p in instead)
            yield doc.fault(path, f"{name} is a former name, which has no prior of its own", f"give those of {names}")
            continue
        if known is not None and name not in known:
            yield doc.fault(path, f"no parameter {name!r}", _instead(name, known))
        if sd is None or sd <= 0:
            fact = f"the prior of {name} is {value!r}"
            yield doc.fault(path, fact, "give a standard deviation above 0 in the unit of the parameter")


def _parameter(
    doc: Document, name: str, value: Any, known: Known | None, path: str, entry: Entry | None = None
) -> Iterator[Fault]:
    place, title = (entry.place, f"{entry.title}: ") if entry else (None, "")
    if known is not None and name not in known:
        yield doc.fault(path, f"{title}no parameter {name!r}", _instead(name, known), place)
        return
    plain = number(value)
    if plain is None:
        yield doc.fault(path, f"{title}{name} = {value!r} is not a finite number", _in_number(name, value), place)
    elif known is not None:
        lower, upper = known[name]
        if not lower <= plain <= upper:
            fact = f"{title}{name} = {plain:g} is outside {lower:g} to {upper:g}"
            yield doc.fault(path, fact, "correct it; parameters are in SI units, angles in rad, pressures in bar", place)
        elif name == TYRE_LAW and plain % 1:
            cure = f"give a whole number from {lower:g} to {upper:g}"
            yield doc.fault(path, f"{title}{name} = {plain:g} is no law", cure, place)
        elif name == TYRE_LAW and entry:
            yield doc.fault(path, f"{title}{name} is one for all runs", OF_A_VARIANT, place)
        elif name == TYRE_LAW:
            yield doc.fault(path, f"{name} = {plain:g} of a campaign chooses no law", OF_A_VARIANT, place, WARNING)
        elif name in CASTERS and (turns := _share_of_a_turn(plain)):
            fact = f"{title}{name} = {plain:g} is {degrees(plain):.0f}°, as it is in rad"
            angle = remainder(2 * pi * turns, 2 * pi) or 0.0  # and not -0.0
            yield doc.fault(path, fact, f"if a share of a turn is meant, write {angle:.4f}", place, NOTE)


def _instead(name: str, known: Known) -> str:
    """What to write for a parameter that there is not: an input is given in a run, another name is misspelt."""
    channel = BY_FMU_NAME.get(name)
    if channel is None or channel not in INPUTS:
        return suggestion(name, known)
    return f'it is an input: write constant = {{ "{channel.name}" = ... }} in each run'


def _share_of_a_turn(angle: float) -> float:
    """The third of a turn, perhaps rounded, or the eighth that a number looks like, with its sign; 0.0 if like none."""
    size = abs(angle)
    share = next((third for third in THIRDS if abs(third - size) < ROUNDED), size if size in EIGHTHS else 0.0)
    return copysign(share, angle)


def _in_number(name: str, value: Any) -> str:
    """What to write instead of what is no number: the angle itself, where it was given with a unit."""
    if name in CASTERS and isinstance(value, str):
        with suppress(UnitError):
            if isfinite(angle := quantity(value, "rad")):
                return f"write it in rad: {remainder(angle, 2 * pi):.4f}"
    return "give a number in SI units"


def bad_column(doc: Document, known: Known | None) -> Iterator[Fault]:
    yield from _columns(doc, doc.table("columns"), "columns", None)
    for place, table in enumerate(doc.recordings):
        columns = table.get("columns")
        if isinstance(columns, Mapping):
            yield from _columns(doc, columns, "recording.columns", place)


def _columns(doc: Document, columns: Mapping[str, Any], path: str, place: int | None) -> Iterator[Fault]:
    known = {c.name: c for c in (TIME, *BY_NAME.values(), *SOURCES)}
    for name, value in columns.items():
        where = f"{path}.{name}"
        if name not in known:
            yield doc.fault(where, f"[columns] has no channel {name!r}", suggestion(name, known), place)
        elif isinstance(value, Mapping):
            yield from _column_table(doc, known[name], value, where, place)
        elif not isinstance(value, str):
            cure = 'write a header in quotes, or { column = "...", radius = ... }'
            yield doc.fault(where, f"[columns] {name} = {value!r} is no header", cure, place)


def _column_table(doc: Document, channel: Channel, value: Mapping[str, Any], path: str, place: int | None) -> Iterator[Fault]:
    name, keys = channel.name, [k.name for k in COLUMN.keys]
    for key, entry in value.items():
        if key not in keys:
            yield doc.fault(path, f"[columns] {name} has no key {key!r}", suggestion(key, keys), place)
        elif key == "radius" and not (number(entry) or 0) > 0:
            yield doc.fault(path, f"[columns] {name}: radius = {entry!r}", "give a radius above 0, in m", place)
        elif key == "sign" and number(entry) not in (1.0, -1.0):
            yield doc.fault(path, f"[columns] {name}: sign = {entry!r}", "give 1 or -1", place)
        elif key in ("column", "unit") and not isinstance(entry, str):
            yield doc.fault(path, f"[columns] {name}: {key} = {entry!r} is no text", "put it in quotes", place)
    if "radius" in value and channel.rotary is None and channel not in SOURCES:
        yield doc.fault(path, f"[columns] {name} has a radius, but no wheel turns it", "remove the radius", place)


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
    for table, names in (("noise", NOISE_NAMES), ("nuisance", NOISE_NAMES)):
        for name in doc.table(table):
            if name not in names:
                yield doc.fault(f"{table}.{name}", f"[{table}] has no channel {name!r}", suggestion(name, names))


DOCUMENT_CHECKS: tuple[Callable[[Document, Known | None], Iterator[Fault]], ...] = (
    unknown_table,
    unknown_key,
    wrong_type,
    no_runs,
    bad_recording,
    bad_markers,
    bad_files,
    bad_clocks,
    bad_point,
    no_file,
    missing_file,
    bad_role,
    no_fit_run,
    no_holdout_run,
    no_manoeuvre,
    unknown_format,
    own_formats,
    empty_cut,
    shared_samples,
    fitted_twice,
    bad_axes,
    bad_parameter,
    bad_set,
    bad_prior,
    bad_column,
    bad_constant,
    unknown_noise,
)
