"""Recordings that were opened, by device and run: their columns with what the headers say, and their series."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path

import numpy as np

from ...faults import NOTE, WARNING, Fault
from ...tables import Table
from ...units import UnitError, factor
from ..binding import Places
from ..formats import open_recording, read_head
from ..spelling import respelt
from .guesses import Guess, guess, side_of, sides
from .naming import placed

PROSE = (".md", ".txt", ".rst", ".pdf", ".doc", ".docx", ".html", "")  # endings that texts about recordings have
OURS = (".toml", ".py", ".m", ".png", ".jpg", ".svg")
FEWEST = 20  # rows of a recording
ALIKE = 0.6  # of all headers that two files of one device have in common, at least
LONGEST = 300.0  # s of a recording that are looked at
STEPS = ((0.5, "s", 1.0), (500.0, "ms", 1e-3), (5e5, "us", 1e-6), (np.inf, "ns", 1e-9))  # largest step of a time in each unit
Series = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True)
class Column:
    """A column: its place, its header, the unit that the file gives, and what the header says it is."""

    index: int
    header: str
    unit: str | None
    guess: Guess | None

    @property
    def quantity(self) -> str:
        return self.guess.quantity if self.guess else ""


@dataclass(frozen=True)
class Opened:
    """A recording: where it is, how it is called, its table."""

    path: Path
    file: str
    table: Table


@dataclass(frozen=True, eq=False)
class Source:
    """A device: its recordings by run, the one of these that its columns are of, these, the side that its name tells, its time
    column and the unit of that."""

    name: str
    side: str
    files: Mapping[str, Opened]
    typical: Opened
    columns: tuple[Column, ...]
    time: Column | None
    time_unit: str
    time_by_size: bool
    _known: dict[tuple[str, int], Series | None] = field(default_factory=dict, repr=False)

    def of(self, *quantities: str) -> list[Column]:
        return [column for column in self.columns if column.quantity in quantities]

    def series(self, run: str, column: Column, si: str = "", unit: str | None = None) -> Series | None:
        """Times (s) and values of a column in a run, by the device's clock; in `si` where that is given, from `unit` or the
        file's. None where the run has no such column."""
        if run not in self.files or self.time is None:
            return None
        key, table = (run, column.index), self.files[run].table
        if key not in self._known:
            self._known[key] = self._read(table, column)
        found = self._known[key]
        if found is None or not si:
            return found
        return found[0], scale_of(unit if unit is not None else _unit_in(table, column), si) * found[1]

    def _read(self, table: Table, column: Column) -> Series | None:
        assert self.time is not None
        clock, at = _place_in(table, self.time), _place_in(table, column)
        if clock is None or at is None:
            return None
        values = table.rows(sorted({clock, at})).values
        if not np.isfinite(values[clock]).any():
            return None
        unit = self.time_unit if self.time_by_size else _unit_in(table, self.time) or self.time_unit
        time = values[clock] * (1.0 if clock in table.moments else scale_of(unit, "s"))
        good = np.isfinite(time)
        good[good] = np.concatenate([[True], np.diff(time[good]) > 0])[: good.sum()]
        good &= time < np.nanmin(time) + LONGEST
        found = np.where(np.isfinite(values[at]), values[at], np.nan)[good]
        return (time[good], found) if np.isfinite(found).sum() > FEWEST else None


def _place_in(table: Table, column: Column) -> int | None:
    """Where a column stands in a file, whose header may have another unit than in others."""
    if column.header in table.headers:
        return table.headers.index(column.header)
    return next(iter(Places(table.headers).of(column.header)), None)


def _unit_in(table: Table, column: Column) -> str | None:
    """The unit that a file gives for a column; where it gives none, that which others give."""
    at = _place_in(table, column)
    own = table.units[at] if at is not None else None
    return own if own is not None else column.unit


def scale_of(unit: str | None, si: str) -> float:
    """The factor to SI; 1 where there is none."""
    try:
        return factor(unit, si) if unit else 1.0
    except UnitError:
        return 1.0


def opened(paths: Sequence[tuple[Path, str]]) -> tuple[list[Opened], list[Fault]]:
    """The files that are recordings, and a sentence for each of the others. Paths come with the names that users know."""
    found, faults = [], []
    for path, file in paths:
        if path.name.lower() == "campaign.toml" or path.suffix.lower() in OURS:
            continue
        table, met = open_recording(path, file, {})
        prose = path.name.lower().startswith("readme") or path.suffix.lower() in PROSE
        if table is not None and (lacks := _lacking(table, file)):
            table, met = None, [] if prose else [lacks]
        if table is None:
            why = (
                met[0]
                if met and not prose
                else Fault(file, None, None, "the file is text, no recording", "nothing is to be done")
            )
            kind = NOTE if prose else WARNING
            faults.append(Fault(file, why.line, None, f"left out: {why.fact}", why.cure, kind))
            continue
        found.append(Opened(path, file, table))
    return found, faults


def _lacking(table: Table, file: str) -> Fault | None:
    """What a table lacks of a recording: at least two columns, and rows enough, of numbers. None where it has them."""
    if len(table.headers) < 2:
        return Fault(file, None, None, "the file has one column, and a recording has a time and readings", "export it again")
    values = table.rows([0, len(table.headers) - 1]).values.values()
    rows = min(len(v) for v in values)
    if 0 < rows < FEWEST:
        many = f"{rows} rows are" if rows > 1 else "one row is"
        return Fault(
            file, None, None, f"{many} no recording, which has {FEWEST} or more", "record for longer, or take the file away"
        )
    if not any(np.isfinite(v).sum() >= FEWEST for v in values):
        return Fault(file, None, None, "the file has no column of numbers", "export it again")
    return None


Kind = frozenset[str]  # the headers of the first of its files


def kinds(files: Sequence[Opened]) -> dict[str, Kind]:
    """Which files may be of one device: those with mostly the same headers, as a marker more or a column less may happen."""
    heads: list[Kind] = []
    found = {}
    for one in files:
        own = frozenset(one.table.headers)
        near = next((head for head in heads if len(own & head) > ALIKE * len(own | head)), None)
        if near is None:
            heads.append(own)
        found[one.file] = own if near is None else near
    return found


@lru_cache(256)
def same_but_spelt(one: Kind, other: Kind) -> bool:
    """Are these mostly the same headers, where those count as the same that are only spelt otherwise?"""
    again = respelt(one, other)
    same = len(one & other) + len(again)
    return bool(again) and same > ALIKE * (len(one) + len(other) - same)


def sources(files: Sequence[Opened], on: Mapping[str, str] = {}) -> tuple[list[Source], list[str]]:
    """The devices, and the names of the runs in order. `on` is the side of devices of which somebody has said it."""
    by_file = {one.file: one for one in files}
    places = placed(list(by_file), kinds(files), same_but_spelt)
    runs = sorted({place.run for place in places}, key=_natural)
    devices = list(dict.fromkeys(place.device for place in sorted(places, key=lambda p: _natural(p.run))))
    told = {**sides(devices), **on}
    found = [_source(name, told[name], {p.run: by_file[p.file] for p in places if p.device == name}) for name in devices]
    return found, runs


def _natural(name: str) -> list[tuple[int, str]]:
    """Run 2 before run 10."""
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", name)]


def _source(name: str, side: str, files: Mapping[str, Opened]) -> Source:
    files = dict(sorted(files.items(), key=lambda item: _natural(item[0])))
    typical = _typical(list(files.values()))
    table = typical.table
    columns = tuple(
        Column(i, header, unit, guess(header, unit) if header else None)
        for i, (header, unit) in enumerate(zip(table.headers, table.units, strict=True))
    )
    time = next((c for c in columns if c.index == table.time), None)
    time = time or next((c for c in columns if c.quantity == "time" and (c.unit is None or c.unit not in ("1", "-"))), None)
    unit, by_size = _time_unit(table, time)
    return Source(name, side or _written_side(typical), files, typical, columns, time, unit, by_size)


def _typical(files: Sequence[Opened]) -> Opened:
    """The first recording that has the most of the headers that more than half of them have: none is spelt otherwise there."""
    counts = Counter(header for one in files for header in set(one.table.headers))
    usual = {header for header, n in counts.items() if 2 * n > len(files)}
    return max(files, key=lambda one: len(usual.intersection(one.table.headers)))


def _time_unit(table: Table, time: Column | None) -> tuple[str, bool]:
    """The unit of a time column; from the size of its steps where the file gives none."""
    if time is None or time.index in table.moments:
        return "s", False
    if time.unit:
        return time.unit, False
    steps = np.diff(table.rows([time.index]).values[time.index])
    usual = float(np.nanmedian(steps)) if steps.size else 0.01
    return next(unit for most, unit, _ in STEPS if usual < most), True


def _written_side(one: Opened) -> str:
    """The side that stands in the lines above the header, as in "Wheel Side :Right"."""
    try:
        head = read_head(one.path)[:2000].decode("latin-1")
    except OSError:
        return ""
    lines = [line for line in head.splitlines()[:20] if "side" in line.lower() and ":" in line]
    return next((side for line in lines if (side := side_of(line.partition(":")[2]))), "")
