"""A file of a run on its way to SI units, SAE J670 axes and the run's clock, with what was found odd on the way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from ..faults import Fault, suggestion
from ..surroundings.surfaces import SURFACES
from ..tables import FrameTable, Rows, Table
from ..units import UnitError, quantity
from . import body
from .angles import cleaned, wheel_speed
from .axes import to_sae
from .binding import Bindings, bind
from .channels import BY_NAME, CHANNEL_NAMES, FORCE, INPUT_NAMES, MOMENTUM, POSITION, PUSHED, ROLLING_FACTOR, SOURCES, Channel
from .derived import marker_columns, pose, position
from .devices import Part
from .document import Document, Entry, number
from .formats import open_recording
from .resampled import Resampled, resampled
from .series import only, spikes, tells, without
from .stamps import Stamps, stamps

COARSE = 0.05  # s: the yaw motion of a chair is over in less
SHORT_GAP = 0.1  # s: an input may be missing for less than this, and is then a straight line


@dataclass(frozen=True)
class Gap:
    """An input's gap that is not bridged: rows `start` to `stop` (not included) of the cut run."""

    start: int
    stop: int
    inside: bool


class Readings:
    """What one file or a whole run holds, as series by name: among them channels and inputs. All are (n,)."""

    if TYPE_CHECKING:  # a dataclass would take the property for the default of its field

        @property
        def values(self) -> Mapping[str, np.ndarray]: ...

    @property
    def inputs(self) -> dict[str, np.ndarray]:
        return {name: self.values[name] for name in INPUT_NAMES if name in self.values}

    @property
    def pushed(self) -> dict[str, np.ndarray]:
        """The inputs that hands give, and not the rider's body."""
        return {name: self.values[name] for name in PUSHED if name in self.values}

    @property
    def channels(self) -> dict[str, np.ndarray]:
        return {name: self.values[name] for name in CHANNEL_NAMES if name in self.values}

    @property
    def measured(self) -> dict[str, np.ndarray]:
        """The channels that say something: not those that are empty or stuck."""
        return {name: series for name, series in self.channels.items() if self._says(name, series)}

    def _says(self, name: str, series: np.ndarray) -> bool:
        return tells(series)


@dataclass(frozen=True, eq=False)
class Draft(Readings):
    """One file of a run before judgement. All series are (n,); `time`, by the run's clock, is None where the file has none."""

    doc: Document
    part: Part
    table: Table
    bindings: Bindings
    rows: Rows
    kept: np.ndarray  # rows of the file that the cut leaves, (n,)
    whole_time: np.ndarray | None  # s, all rows of the file, by its own clock
    stamps: Stamps | None  # its rows in the order of these times
    time: np.ndarray | None
    values: Mapping[str, np.ndarray]
    angles: Mapping[str, np.ndarray]  # rad, of the wheels that it tells, without jumps
    glitches: Mapping[str, np.ndarray]  # rows of the cut run where an angle was left out
    noise: Mapping[str, float]  # standard deviations of channels that were made from others
    gaps: Mapping[str, tuple[Gap, ...]]
    resampled: Mapping[str, Resampled]  # by channel, whose repeats are left out of `values`
    spikes: Mapping[str, Mapping[int, float]]  # left out of `values`: by channel, readings by their rows of the cut run
    seen: tuple[float, float] | None = None  # from when to when (s) the rider's body was seen, where it was looked at

    def slim(self) -> Draft:
        """Without what only checks of the run itself read: the file's text and its columns as they were."""
        return replace(
            self,
            table=FrameTable(self.file, self.table.headers, self.table.units, moments=self.table.moments, frame=pd.DataFrame()),
            rows=Rows({}, None),
            whole_time=None,
            stamps=None,
            kept=np.empty(0, int),
            resampled={},
        )

    @property
    def entry(self) -> Entry:
        return self.part.entry

    @property
    def file(self) -> str:
        return self.part.file

    @property
    def left_out(self) -> bool:
        """Is this the whole of a run that says nothing, although it has channels? The chair stood still, or the logger held."""
        known = constants(self.entry).keys() & set(CHANNEL_NAMES)
        return self.part.alone and bool(self.channels) and not self.measured and not known

    def header(self, name: str) -> str | None:
        """The header of the column that a channel is read from; None for one that is made from others."""
        return self.bindings.found[name].header if name in self.bindings.found else None

    def line(self, i: int) -> int | None:
        """Line in the file of row i of the cut run."""
        return self.rows.line(int(self.kept[i]))


def constant_value(channel: Channel, value: Any) -> float:
    """A constant in SI: a number, text with a unit, or the name of a floor. Raises UnitError."""
    if channel.name == ROLLING_FACTOR and isinstance(value, str) and (word := value.strip())[:1].isalpha():
        if word not in SURFACES:
            raise UnitError(f"there is no floor {word!r}", suggestion(word, SURFACES))
        return SURFACES[word].factor()
    if isinstance(value, str):
        return quantity(value, channel.unit.name)
    plain = number(value)
    if plain is None:
        raise UnitError(f"{value!r} is not a number", f"write a number in {channel.unit.name}")
    return plain


def constants(entry: Entry) -> dict[str, float]:
    """The usable ones; a check reports the others."""
    found = {}
    for name, value in entry.table("constant").items():
        if name in BY_NAME:
            try:
                found[name] = constant_value(BY_NAME[name], value)
            except UnitError:
                continue
    return found


def prepare(doc: Document, part: Part, path: Path, known: dict[Any, Any]) -> tuple[Draft | None, list[Fault]]:
    """Reads, binds, converts, turns and cuts. `known` keeps tables, so that a file is read once."""
    key = (path, repr(part.device.options))
    if key not in known:
        known[key] = open_recording(path, part.file, part.device.options)
    table, faults = known[key]
    if table is None:
        return None, list(faults)
    markers, met = marker_columns(part, table)
    bindings = bind(part.device, table, [table.headers[i] for i, _ in markers.values()])
    rows = table.rows(sorted({*(b.index for b in bindings.found.values()), *(i for i, _ in markers.values())}))
    faults = [*faults, *met, *bindings.faults, *rows.faults]
    return _converted(doc, part, table, bindings, rows, markers), faults


def _converted(
    doc: Document, part: Part, table: Table, bindings: Bindings, rows: Rows, markers: Mapping[str, tuple[int, float]]
) -> Draft:
    series = {name: rows.values[b.index] * b.scale for name, b in bindings.found.items()}
    whole_time = series.pop("time", None)
    length = len(next(iter(rows.values.values()))) if rows.values else 0
    common = None if whole_time is None else whole_time * (1 + part.clock.drift) + part.clock.offset
    ordered = None if whole_time is None else stamps(whole_time, rows.values.values())
    kept = np.arange(length) if common is None or ordered is None else ordered.rows[_cut(part.entry, common[ordered.rows])]
    time = None if common is None else common[kept]
    series = {name: s[kept] for name, s in series.items()}
    angles = {name: series.pop(name) for name in (c.name for c in SOURCES) if name in series}
    values = to_sae(series, part.device.axes)
    marked = {name: rows.values[i][kept] * scale for name, (i, scale) in markers.items()}
    values |= pose(marked)
    noise: dict[str, float] = {}
    moved = position(part, marked, time, values.get("yaw"))
    values |= {} if moved is None or POSITION in values else {POSITION: moved}
    seen = _body(doc, time, values, noise)
    glitched: dict[str, np.ndarray] = {}
    if time is not None:
        for name, angle in angles.items():
            angles[name], glitched[name] = cleaned(angle)
        for name, angle in angles.items():
            speed = name.replace("angle", "speed")
            if speed not in values and part.device.radius and part.device.columns.get(speed) != "":
                values[speed], noise[speed] = wheel_speed(time, angle, part.device.radius)
    measured = [c for c in CHANNEL_NAMES if c in values and c not in noise]
    slower = {c: how for c in measured if (how := resampled(values[c]))}
    values |= {c: only(values[c], how.places) for c, how in slower.items()}
    spiked = _spikes(time, {c: values[c] for c in measured})
    values |= {c: without(values[c], list(found)) for c, found in spiked.items()}
    gaps = {}
    for name in PUSHED:
        if name in values and time is not None:
            values[name], gaps[name] = bridge(time, values[name])
    return Draft(
        doc,
        part,
        table,
        bindings,
        rows,
        kept,
        whole_time,
        ordered,
        time,
        values,
        angles,
        glitched,
        noise,
        gaps,
        slower,
        spiked,
        seen,
    )


def _body(
    doc: Document, time: np.ndarray | None, values: dict[str, np.ndarray], noise: dict[str, float]
) -> tuple[float, float] | None:
    """Adds what a position of the rider's body says of its momentum; from when to when it was seen, None without any."""
    if time is None or len(time) < 2 or not {POSITION, MOMENTUM} & values.keys():
        return None
    mass = number(doc.table("rider").get("m"))
    if POSITION in values and mass is not None and mass > 0:
        found = body.of_position(time, values[POSITION], mass)
        noise |= {} if MOMENTUM in values else {MOMENTUM: found.noise}
        values |= {name: series for name, series in found.series.items() if name == POSITION or MOMENTUM not in values}
    if MOMENTUM not in values:
        return None  # checks say that the mass is missing, or none
    values.setdefault(FORCE, body.rate(time, values[MOMENTUM]))
    seen = body.stretch(time, values[MOMENTUM], SHORT_GAP)
    values |= {name: _straight(time, values[name]) for name in (POSITION, MOMENTUM, FORCE) if name in values}
    return seen


def _straight(time: np.ndarray, series: np.ndarray) -> np.ndarray:
    """With its gaps as straight lines."""
    there = np.isfinite(series)
    return np.interp(time, time[there], series[there]) if there.any() else series


def _spikes(time: np.ndarray | None, channels: Mapping[str, np.ndarray]) -> dict[str, dict[int, float]]:
    """As in a draft; none in a coarse recording, where what is short may be over within a sample."""
    if time is None or len(time) < 2 or float(np.median(np.diff(time))) > COARSE:
        return {}
    places = {c: spikes(series) for c, series in channels.items()}
    return {c: dict(zip(at.tolist(), channels[c][at].tolist(), strict=True)) for c, at in places.items() if at.size}


def _cut(entry: Entry, time: np.ndarray) -> np.ndarray:
    """Rows with from <= time < to, so that adjoining runs share no sample."""
    keep = np.isfinite(time)
    start, stop = entry.number("from"), entry.number("to")
    if start is not None and stop is not None and start >= stop:
        return np.flatnonzero(keep)  # a check reports the bounds; the rest is judged as if there were none
    if start is not None:
        keep &= time >= start
    if stop is not None:
        keep &= time < stop
    return np.flatnonzero(keep)


def bridge(time: np.ndarray, series: np.ndarray) -> tuple[np.ndarray, tuple[Gap, ...]]:
    """Fills the short gaps of an input by straight lines and names the others. All (n,)."""
    missing = ~np.isfinite(series)
    if not missing.any():
        return series, ()
    edges = np.diff(np.concatenate(([0], missing.astype(int), [0])))
    filled, left = series.copy(), []
    for start, stop in zip(np.flatnonzero(edges == 1), np.flatnonzero(edges == -1), strict=True):
        inside = start > 0 and stop < len(series)
        if inside and time[stop] - time[start - 1] < SHORT_GAP + 1e-9:
            ends = [start - 1, stop]
            filled[start:stop] = np.interp(time[start:stop], time[ends], series[ends])
        else:
            left.append(Gap(int(start), int(stop), bool(inside)))
    return filled, tuple(left)
