"""A run on its way from the file to SI units and SAE J670 axes, with what was found odd on the way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from ..faults import Fault
from ..tables import FrameTable, Rows, Table
from ..units import UnitError, quantity
from .axes import to_sae
from .binding import Bindings, bind
from .channels import BY_NAME, CHANNEL_NAMES, INPUT_NAMES, Channel
from .document import Document, Entry, number
from .formats import open_table
from .resampled import Resampled, resampled
from .series import only, spikes, tells, without

COARSE = 0.05  # s: the yaw motion of a chair is over in less
SHORT_GAP = 0.1  # s: an input may be missing for less than this, and is then a straight line
_FIRST = 10  # samples from which the starting speed is taken


@dataclass(frozen=True)
class Gap:
    """An input's gap that is not bridged: rows `start` to `stop` (not included) of the cut run."""

    start: int
    stop: int
    inside: bool


@dataclass(frozen=True, eq=False)
class Draft:
    """A run before judgement. All series are (n,); `time` is None where the file has none."""

    doc: Document
    entry: Entry
    table: Table
    bindings: Bindings
    rows: Rows
    kept: np.ndarray  # rows of the file that the cut leaves, (n,)
    whole_time: np.ndarray | None  # s, all rows of the file
    time: np.ndarray | None
    values: Mapping[str, np.ndarray]
    constants: tuple[str, ...]
    gaps: Mapping[str, tuple[Gap, ...]]
    resampled: Mapping[str, Resampled]  # by channel, whose repeats are left out of `values`
    spikes: Mapping[str, Mapping[int, float]]  # left out of `values`: by channel, readings by their rows of the cut run

    def slim(self) -> Draft:
        """Without what only checks of the run itself read: the file's text and its columns as they were."""
        return replace(self, table=FrameTable(self.file, self.table.headers, pd.DataFrame()), rows=Rows({}, None),
                       whole_time=None, kept=np.empty(0, int), resampled={})  # fmt: skip

    @property
    def file(self) -> str:
        return self.entry.file

    @property
    def inputs(self) -> dict[str, np.ndarray]:
        return {name: self.values[name] for name in INPUT_NAMES if name in self.values}

    @property
    def channels(self) -> dict[str, np.ndarray]:
        return {name: self.values[name] for name in CHANNEL_NAMES if name in self.values}

    @property
    def measured(self) -> dict[str, np.ndarray]:
        """The channels that say something: not those that are empty or stuck."""
        return {name: s for name, s in self.channels.items() if name in self.constants or tells(s)}

    @property
    def silent(self) -> bool:
        """Does the run say nothing, although it has channels? The chair stood still, or nothing was recorded."""
        return bool(self.channels) and not self.measured

    @property
    def logged(self) -> dict[str, np.ndarray]:
        """What the file holds, without the constants."""
        return {name: series for name, series in self.values.items() if name not in self.constants}

    def header(self, name: str) -> str:
        return self.bindings.found[name].header

    def line(self, i: int) -> int | None:
        """Line in the file of row i of the cut run."""
        return self.rows.line(int(self.kept[i]))

    @cached_property
    def first_speed(self) -> float | None:
        """Speed at the first samples, m/s: from u, else from the wheels; None where nothing tells."""
        if "u" in self.values:
            series = [self.values["u"]]
        elif "wheel_speed_l" in self.values and "wheel_speed_r" in self.values:
            series = [self.values["wheel_speed_l"], self.values["wheel_speed_r"]]
        else:
            return None
        firsts = [s[np.isfinite(s)][:_FIRST] for s in series]
        if any(first.size == 0 for first in firsts):
            return None
        return float(np.mean([np.median(first) for first in firsts]))

    @property
    def u0(self) -> float | None:
        stated = self.entry.number("u0")
        return stated if stated is not None else self.first_speed


def constant_value(channel: Channel, value: Any) -> float:
    """A constant in SI: a number, or text with a unit. Raises UnitError."""
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


def prepare(doc: Document, entry: Entry, path: Path, known: dict[Any, Any]) -> tuple[Draft | None, list[Fault]]:
    """Reads, binds, converts, turns and cuts. `known` keeps tables, so that a file is read once."""
    key = (path, entry.text("format"), entry.text("side"), entry.number("radius"))
    if key not in known:
        known[key] = open_table(entry, path)
    table, faults = known[key]
    if table is None:
        return None, list(faults)
    bindings = bind(doc, entry.file, table.headers)
    rows = table.rows(sorted({b.index for b in bindings.found.values()}))
    faults = [*faults, *bindings.faults, *rows.faults]
    return _converted(doc, entry, table, bindings, rows), faults


def _converted(doc: Document, entry: Entry, table: Table, bindings: Bindings, rows: Rows) -> Draft:
    series = {name: rows.values[b.index] * b.scale for name, b in bindings.found.items()}
    whole_time = series.pop("time", None)
    length = len(next(iter(rows.values.values()))) if rows.values else 0
    kept = _cut(entry, whole_time, length)
    time = None if whole_time is None else whole_time[kept]
    values = {name: s[kept] for name, s in series.items()}
    given = constants(entry)
    values |= {name: np.full(len(kept), value) for name, value in given.items()}
    values = to_sae(values, doc.axes)
    measured = [c for c in CHANNEL_NAMES if c in values and c not in given]
    slower = {c: how for c in measured if (how := resampled(values[c]))}
    values |= {c: only(values[c], how.places) for c, how in slower.items()}
    spiked = _spikes(time, {c: values[c] for c in measured})
    values |= {c: without(values[c], list(found)) for c, found in spiked.items()}
    gaps = {}
    for name in INPUT_NAMES:
        if name in values and time is not None:
            values[name], gaps[name] = bridge(time, values[name])
    return Draft(doc, entry, table, bindings, rows, kept, whole_time, time, values, tuple(given), gaps, slower, spiked)


def _spikes(time: np.ndarray | None, channels: Mapping[str, np.ndarray]) -> dict[str, dict[int, float]]:
    """As in a draft; none in a coarse recording, where what is short may be over within a sample."""
    if time is None or len(time) < 2 or float(np.median(np.diff(time))) > COARSE:
        return {}
    places = {c: spikes(series) for c, series in channels.items()}
    return {c: dict(zip(at.tolist(), channels[c][at].tolist(), strict=True)) for c, at in places.items() if at.size}


def _cut(entry: Entry, time: np.ndarray | None, length: int) -> np.ndarray:
    """Rows with from <= time < to, so that adjoining runs share no sample."""
    if time is None:
        return np.arange(length)
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
