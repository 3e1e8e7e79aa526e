"""Which column of a table is which channel, and by what factor it becomes SI."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import SequenceMatcher
from typing import Any

from ..faults import SHOWN, WARNING, Fault, run_fault, some, suggestion
from ..tables import Table
from ..units import UnitError, factor, same_dimension, split, suffixed
from .channels import BY_NAME, SOURCES, TIME, Channel
from .devices import Device
from .document import Document, number

NEAR = 0.8  # likeness, by difflib, from which a header is a channel's name misspelt
MANY = 1000  # headers among which a misspelt one is looked for


@dataclass(frozen=True)
class Binding:
    """Column `index` of a table feeds `channel`: SI value = scale · number in the file, which may be of a turning wheel."""

    channel: Channel
    index: int
    header: str
    scale: float
    through_radius: bool = False


@dataclass(frozen=True)
class Wanted:
    """What [columns] says of one channel; by default the channel's own name."""

    header: str
    unit: str | None = None
    radius: float | None = None
    renamed: bool = False
    sign: float = 1.0


def wanted(device: Device, name: str) -> Wanted:
    """The entry of [columns] for a channel; wrong types read as absent and are reported by a check."""
    entry: Any = device.columns.get(name)
    if isinstance(entry, str):
        return Wanted(entry.strip(), renamed=True)
    if isinstance(entry, Mapping):
        column, unit, radius = entry.get("column"), entry.get("unit"), number(entry.get("radius"))
        renamed = isinstance(column, str)
        header = column.strip() if isinstance(column, str) else name
        sign = -1.0 if (number(entry.get("sign")) or 1.0) < 0 else 1.0
        return Wanted(header, unit if isinstance(unit, str) else None, radius, renamed, sign)
    return Wanted(name)


@dataclass(frozen=True)
class Bindings:
    """All bindings of one table by channel name, the faults met, and the renamed columns that were not there."""

    found: Mapping[str, Binding]
    faults: tuple[Fault, ...]
    absent: tuple[str, ...]


def bind(device: Device, table: Table, taken: Collection[str] = ()) -> Bindings:
    """Matches a table's headers to time, channels and inputs, and to what channels are made from; the time, too, where the file
    itself calls a column that. `taken` are headers that somebody else reads."""
    file, headers = table.file, table.headers
    found: dict[str, Binding] = {}
    faults: list[Fault] = list(_twice(file, headers))
    absent: list[str] = []
    places = Places(headers)
    for channel in (TIME, *BY_NAME.values(), *SOURCES):
        want = wanted(device, channel.name)
        if want.renamed and not want.header:
            continue  # "" says that this device is not to be asked
        matches = places.of(want.header)
        if not matches and want.renamed:
            absent.append(channel.name)
            want, matches = Wanted(channel.name), places.of(channel.name)
        if not matches and channel is TIME and table.time is not None:
            want, matches = Wanted(headers[table.time], renamed=True), [table.time]
            absent = [name for name in absent if name != TIME.name]
        if len({headers[i] for i in matches}) > 1:
            both = " and ".join(repr(headers[i]) for i in matches)
            cure = f"remove one, or choose one by its whole header in [columns] {channel.name}"
            faults.append(run_fault(file, f"{channel.name} could be {both}", cure, 1))
        if matches:
            binding, met = _scaled(device, table, channel, want, matches[0])
            found[channel.name] = binding
            faults += met
    used = {binding.index for binding in found.values()}
    extra = [header for i, header in enumerate(headers) if i not in used and header and header not in taken]
    faults += _unused(device, file, extra, found)
    return Bindings(found, tuple(faults), tuple(absent))


def _unused(device: Device, file: str, extra: Sequence[str], found: Collection[str]) -> Iterator[Fault]:
    """Headers that nothing is taken from; those that look like a missing channel, misspelt, each by itself."""
    names = [channel.name for channel in (*BY_NAME.values(), *SOURCES) if channel.name not in found]
    missing = [name for name in names if wanted(device, name).header]
    nearly = {header: near for header in extra[:MANY] if (near := _near(header, missing))}
    for header, near in nearly.items():
        fact = f"it looks like {' or '.join(near)}, but is not used"
        yield run_fault(file, fact, "correct the header, or name it in [columns]", 1, header, WARNING)
    rest = [repr(header) for header in extra if header not in nearly]
    if rest and not device.name:  # of a device one reads what one wants
        what = f"column{'s' * (len(rest) > 1)} {some(rest)} not used"
        yield run_fault(file, what, "name them in [columns] if they measure something", 1, severity=WARNING)


def _near(header: str, missing: Sequence[str]) -> list[str]:
    """The channels that a header comes nearest to; none where it is like none."""
    bare = suffixed(split(header)[0])[0].lower()
    alike = {name: SequenceMatcher(None, bare, name.lower()).ratio() for name in missing}
    best = max(alike.values(), default=0.0)
    return [name for name, ratio in alike.items() if ratio == best >= NEAR]


class Places:
    """Where each header stands: by the whole header first, then without the bracket, then without an ending that tells the
    unit."""

    def __init__(self, headers: Sequence[str]):
        self._ways = [defaultdict[str, list[int]](list) for _ in range(3)]
        for i, header in enumerate(headers):
            bare = split(header)[0]
            for known, name in zip(self._ways, (header, bare, suffixed(bare)[0]), strict=True):
                known[name].append(i)

    def of(self, header: str) -> list[int]:
        whole, *bare = self._ways
        return next((found for found in (whole.get(header), *(way.get(split(header)[0]) for way in bare)) if found), [])


def _twice(file: str, headers: Sequence[str]) -> Iterator[Fault]:
    often = [(header, n) for header, n in Counter(headers).items() if header and n > 1]
    for header, n in often[:SHOWN]:
        yield run_fault(file, f"the header {header!r} stands there {n} times", "rename or remove all but one", 1)
    if len(often) > SHOWN:
        yield run_fault(file, f"{len(often) - SHOWN} more headers like these", "rename or remove all but one each", 1)


def _scaled(device: Device, table: Table, channel: Channel, want: Wanted, index: int) -> tuple[Binding, list[Fault]]:
    """The binding with its factor to SI; 1 where there is none, and then a fault. The unit that the file gives goes before that
    of the header in [columns]; a check of all files says where these differ."""
    file, header = table.file, table.headers[index]
    own, asked = table.units[index], split(want.header)[1]
    faults = []
    if index in table.moments:  # read into seconds already
        want, own, asked = replace(want, unit=None), "s", None
    unit = next((u for u in (want.unit, own, asked) if u is not None), None)
    if unit is None and want.renamed:
        fact = f"the column that is {channel.name} gives no unit"
        cure = f'write [columns] {channel.name} = {{ column = "{header}", unit = "{channel.unit.name}" }} with its unit'
        return Binding(channel, index, header, 1.0), [run_fault(file, fact, cure, 1, header)]
    if unit is None:
        fact = f"no unit given, {channel.unit.name} assumed"
        cure = f"write the header as '{split(header)[0]} [{channel.unit.name}]'"
        faults.append(run_fault(file, fact, cure, 1, header, WARNING))
        unit = channel.unit.name
    if want.radius is not None and (channel.rotary is None or not same_dimension(unit, channel.rotary.name)):
        fact = f"[columns] gives a radius, but {unit!r} needs none"
        faults.append(run_fault(file, fact, "remove the radius, or correct the unit", 1, header, WARNING))
    try:
        scale = want.sign * _factor(device, channel, unit, want.radius)
        turns = channel.rotary is not None and same_dimension(unit, channel.rotary.name)
        return Binding(channel, index, header, scale, turns), faults
    except UnitError as error:
        faults.append(run_fault(file, error.fact, error.cure, 1, header))
        return Binding(channel, index, header, 1.0), faults


def _factor(device: Device, channel: Channel, unit: str, radius: float | None) -> float:
    """To SI; where the unit is of a turning wheel, through the radius in [columns], else of the device, or [wheel] R."""
    rotary = channel.rotary
    if rotary is None or not same_dimension(unit, rotary.name):
        return factor(unit, channel.unit.name)
    radius = radius if radius is not None else device.radius
    if radius is None or radius <= 0:
        fact = f"{channel.name} is given in {unit}, which needs the wheel's radius to become {channel.unit.name}"
        cure = f"write [columns] {channel.name} = {{ column = ..., radius = ... }} or [wheel] R, in m"
        raise UnitError(fact, cure)
    return factor(unit, rotary.name) * radius**channel.rotary_power


def absent_fault(doc: Document, device: Device, name: str, headers: Sequence[str]) -> Fault:
    """A column that [columns] names and no run has."""
    header = wanted(device, name).header
    of = f" of {device.name}" if device.name else ""
    fact = f"no run has the column {header!r} that [columns]{of} gives for {name}"
    return doc.fault(f"{device.path}.{name}", fact, suggestion(header, [h for h in headers if h][:MANY]), device.place)
