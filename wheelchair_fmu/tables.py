"""Recordings as tables: headers, and columns of numbers on demand."""

from __future__ import annotations

import csv
import gzip
import io
import re
import zlib
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import datetime
from math import nan
from pathlib import Path
from typing import Any, Literal, Protocol

import numpy as np
import pandas as pd

from .dialect import GAPS as _GAPS
from .dialect import grouped
from .faults import SHOWN, Fault, run_fault
from .given import what_is
from .texts import Text, parse
from .timestamps import Clock, ClockError, Seconds, count_over, counted, is_date, is_stamp, named_time, stamps
from .units import split, suffixed, unit_of

MOST = 2**30  # bytes that a packed recording may have unpacked: a day at 100 Hz has less
_NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?|[-+]?inf(inity)?", re.IGNORECASE)


@dataclass(frozen=True)
class Rows:
    """Some columns of a table: `values[index]` is (n,) with NaN in gaps; `lines` is (n,), None where there are none."""

    values: dict[int, np.ndarray]
    lines: np.ndarray | None
    faults: tuple[Fault, ...] = ()

    def line(self, i: int) -> int | None:
        return None if self.lines is None else int(self.lines[i])


class Table(Protocol):
    """What every format is read into.

    `headers` are the raw texts; `units` stand beside them as the file gives them, None where it gives none. `notes` are
    sentences about what was found. `time` is the place of the column that the file itself calls its time, None where none
    does. Columns of stamps and of counts from 1970 or midnight, `moments`, are in s from the recording's own zero, whatever
    their headers say, and `started` is what the zero was.
    """

    file: str
    headers: tuple[str, ...]
    units: tuple[str | None, ...]
    notes: tuple[str, ...]
    started: datetime | None
    time: int | None

    @property
    def moments(self) -> frozenset[int]: ...

    def rows(self, indices: Sequence[int]) -> Rows: ...


@dataclass
class Headed:
    """What every table that a library has read says of its columns; see `Table`."""

    file: str
    headers: tuple[str, ...]
    units: tuple[str | None, ...] = ()  # by default as the headers give them
    notes: tuple[str, ...] = ()
    started: datetime | None = None
    time: int | None = None
    moments: frozenset[int] = frozenset()

    def __post_init__(self) -> None:
        if len(self.units) != len(self.headers):
            self.units = tuple(map(unit_of, self.headers))


@dataclass
class FrameTable(Headed):
    """A table that a library has read already: numbers, no lines."""

    frame: pd.DataFrame = field(kw_only=True)

    @property
    def length(self) -> int:
        return len(self.frame)

    def rows(self, indices: Sequence[int]) -> Rows:
        values, faults = {}, []
        for i in indices:
            values[i], met = numbers(self.file, self.headers[i], self.frame.iloc[:, i])
            faults += met
        return Rows(values, None, tuple(faults))


def numbers(file: str, header: str, column: pd.Series) -> tuple[np.ndarray, list[Fault]]:
    """A library's column (n,) as numbers; gaps, and the fault, where it holds something else."""
    try:
        return column.to_numpy(dtype=float, na_value=nan), []
    except (TypeError, ValueError):
        fact = f"the column holds {column.dtype}, not numbers"
        return np.full(len(column), nan), [run_fault(file, fact, "store it as numbers", column=header)]


@dataclass
class CsvTable:
    """A CSV file; its body is parsed once for each set of columns that is asked for."""

    file: str
    headers: tuple[str, ...]
    body: str
    separator: str
    decimal: str
    header_line: int = 1
    units: tuple[str | None, ...] = ()
    notes: tuple[str, ...] = ()
    started: datetime | None = None
    time: int | None = None
    first_line: int = 2  # of the body
    rate: float | None = None  # Hz: then the last header is a time made from the rows, or from the column `counter`
    counter: tuple[int, float] | None = None  # its place, and where it starts again at 0
    clocks: dict[int, Clock] = field(default_factory=dict, repr=False)
    stamped: dict[int, np.ndarray] = field(default_factory=dict, repr=False)  # columns of stamps, read already
    _known: dict[tuple[int, ...], Rows] = field(default_factory=dict, repr=False)

    def rows(self, indices: Sequence[int]) -> Rows:
        key = tuple(indices)
        if key not in self._known:
            made = len(self.headers) - 1 if self.rate else None
            asked = tuple(i for i in key if i != made)
            if made in key and self.counter and self.counter[0] not in asked:
                asked = (*asked, self.counter[0])
            rows = self._fast(asked) or self._careful(asked)
            for i, clock in self.clocks.items():
                if i in rows.values:
                    rows.values[i] = clock.seconds(rows.values[i]).values
            if made in key and self.rate:
                count = np.arange(len(rows.lines if rows.lines is not None else ()), dtype=float)
                if self.counter:
                    count = count_over(rows.values[self.counter[0]], self.counter[1])
                rows.values[made] = count / self.rate
            self._known[key] = rows
        return self._known[key]

    @property
    def moments(self) -> frozenset[int]:
        return frozenset((*self.stamped, *(i for i, clock in self.clocks.items() if clock.moment)))

    def words(self, index: int) -> list[str]:
        """A column of text, one word for each row of `rows`."""
        blank = re.search(rf"^[ \t\f\v{re.escape(self.separator)}]*$", self.body.strip("\n"), re.MULTILINE)
        if '"' not in self.body and not blank:
            with suppress(ValueError):  # rows of different length: cell by cell, then
                words = pd.read_csv(
                    io.StringIO(self.body),
                    sep=self.separator,
                    header=None,
                    usecols=[index],
                    dtype=str,
                    na_filter=False,
                    index_col=False,
                    quoting=csv.QUOTE_NONE,
                )
                return [str(word).strip() for word in words[index]]
        filled = (row for row in self._cells() if any(cell.strip() for cell in row))
        return [row[index].strip() if index < len(row) else "" for row in filled]

    def _fast(self, indices: tuple[int, ...]) -> Rows | None:
        """Pandas' C parser; None where anything is odd, so that the careful way can say what and where."""
        body = self.body.rstrip("\r\n")
        rows = body.count("\n") + 1
        if not body or '"' in body or "\n\n" in body or body[0] in "\r\n" or "\n\r" in body:
            return None
        separators, width = body.count(self.separator), len(self.headers) - bool(self.rate)
        trailing = separators == rows * width and body.count(self.separator + "\n") + body.endswith(self.separator) == rows
        if separators != rows * (width - 1) and not trailing:
            return None
        numbers = [i for i in indices if i not in self.stamped]
        try:
            frame = pd.read_csv(
                io.StringIO(body),
                sep=self.separator,
                decimal=self.decimal,
                header=None,
                usecols=numbers or [0],
                dtype=float if numbers else str,
                keep_default_na=False,
                na_values=list(_GAPS),
                index_col=False,
            )
        except ValueError:  # ParserError is one
            return None
        known = [self.stamped[i] for i in indices if i in self.stamped]
        if len(frame) != rows or any(len(times) != rows or np.isnan(times).any() for times in known):
            return None
        lines = np.arange(rows) + self.first_line
        values = {i: self.stamped[i] if i in self.stamped else frame[i].to_numpy() for i in indices}
        return Rows(values, lines, tuple(self._infinite(values, lines)))

    def _careful(self, indices: tuple[int, ...]) -> Rows:
        """Cell by cell, to name the line of every fault."""
        reader, too_long = self._cells(), list[Fault]()
        cells: dict[int, list[float]] = {i: [] for i in indices}
        lines: list[int] = []
        bad: dict[int, list[tuple[int, str]]] = {i: [] for i in indices}
        ragged: list[tuple[int, str]] = []
        width = len(self.headers) - bool(self.rate)
        while True:
            try:
                row = next(reader)
            except StopIteration:
                break
            except csv.Error as error:
                line = reader.line_num + self.first_line - 1
                too_long.append(run_fault(self.file, f"the row cannot be read ({error})", "export the file again", line))
                break
            if not any(cell.strip() for cell in row):
                continue
            line = reader.line_num + self.first_line - 1
            if len(row) != width and any(cell.strip() for cell in row[width:] or ["short"]):
                ragged.append((line, f"{len(row)} cells, but the header has {width}"))
            for i in indices:
                text = row[i].strip() if i < len(row) else ""
                cells[i].append(self._moment(i, len(lines)) if i in self.stamped else self._number(text))
                if np.isnan(cells[i][-1]) and text not in _GAPS:
                    bad[i].append((line, f"{text!r} is not {'a time' if i in self.stamped else self._numeric(text)}"))
            lines.append(line)
        values = {i: np.array(cells[i], dtype=float) for i in indices}
        faults = too_long + self._listed(ragged, None, "write one cell for each column")
        for i in indices:
            faults += self._listed(bad[i], self.headers[i], "write a number, or leave the cell empty for a gap")
        faults += self._infinite(values, np.array(lines))
        return Rows(values, np.array(lines), tuple(faults))

    def _cells(self) -> Any:
        return csv.reader(io.StringIO(self.body), delimiter=self.separator, quoting=self._quoting())

    def _quoting(self) -> Literal[0, 3]:
        """A quote that is never closed would swallow the rest of the file: then quotes are plain characters."""
        return csv.QUOTE_NONE if self.body.count('"') % 2 else csv.QUOTE_MINIMAL

    def _moment(self, i: int, row: int) -> float:
        return float(self.stamped[i][row]) if row < len(self.stamped[i]) else nan

    def _number(self, text: str) -> float:
        if self.decimal == ",":
            if "." in text and grouped(text + ",0"):
                return nan  # 1.234 among decimal commas
            text = text.replace(",", ".")
        return float(text) if _NUMBER.fullmatch(text) else nan

    def _numeric(self, text: str) -> str:
        return "a number without separators of thousands" if grouped(text) else "a number"

    def _infinite(self, values: dict[int, np.ndarray], lines: np.ndarray) -> list[Fault]:
        faults = []
        for i, series in values.items():
            places = [(int(lines[row]), "the value is infinite") for row in np.flatnonzero(np.isinf(series))]
            faults += self._listed(places, self.headers[i], "leave the cell empty where the sensor gave nothing")
        return faults

    def _listed(self, places: list[tuple[int, str]], column: str | None, cure: str) -> list[Fault]:
        faults = [run_fault(self.file, fact, cure, line, column) for line, fact in places[:SHOWN]]
        if len(places) > SHOWN:
            more = f"{len(places) - SHOWN} more cells like these"
            faults.append(run_fault(self.file, more, cure, places[SHOWN][0], column))
        return faults


def read_bytes(path: Path) -> bytes:
    """The file's bytes, unpacked where its name ends in .gz. Raises OSError, also for more than MOST unpacked bytes."""
    if kind := what_is(path):
        raise OSError(f"it is {kind}")
    if path.suffix != ".gz":
        return path.read_bytes()
    try:
        with gzip.open(path) as packed:
            raw = packed.read(MOST + 1)
    except (EOFError, zlib.error) as error:
        raise OSError(f"broken gzip: {error}") from error
    if len(raw) > MOST:
        raise OSError(f"it unpacks to more than {MOST / 2**30:g} GiB; unpack it yourself if that is right")
    return raw


def unreadable(file: str, error: OSError) -> Fault:
    """The fault of a file that is there but cannot be read."""
    what = error.strerror or str(error)
    return run_fault(file, f"the file cannot be read ({what})", "check the file and the rights to read it")


def read_csv(file: str, raw: bytes, options: Mapping[str, Any] | None = None) -> tuple[CsvTable | None, list[Fault]]:
    """A table from the bytes of a text file; how it is written is found by looking, where `options` do not say it.

    These may hold encoding, separator, decimal, skip, dates (day first or month first) and rate (Hz).
    """
    text, faults = parse(file, raw, options)
    if text is None:
        return None, faults
    table = CsvTable(
        file,
        text.headers,
        text.body,
        text.separator,
        text.decimal,
        text.header_line,
        text.units,
        text.notes,
        first_line=text.first_line,
    )
    return _timed(table, text, options or {})


def _timed(table: CsvTable, text: Text, options: Mapping[str, Any]) -> tuple[CsvTable | None, list[Fault]]:
    """The table with its column of time in s, where it has one."""
    columns = [[row[i] for row in text.rows if i < len(row) and row[i]] for i in range(len(table.headers))]
    dated = [i for i, cells in enumerate(columns) if cells and 2 * sum(map(is_stamp, cells)) > len(cells)]
    try:
        for i in dated:
            _stamp(table, i, dated, columns, str(options.get("dates") or ""))
    except ClockError as error:
        return None, [run_fault(table.file, error.fact, error.cure, text.first_line, table.headers[i])]
    called = [i for i, header in enumerate(table.headers) if named_time(_bare(header))]
    called = [i for i in called if i in dated or i in text.numeric] or called
    exact = [i for i in called if split(table.headers[i])[0] == "time"]
    clocks = [i for i in table.stamped if not all(map(is_date, columns[i]))]
    table.time = next(iter(exact or [i for i in called if i in clocks] or called or clocks), None)
    if table.time is not None and table.time not in table.stamped:
        _counted(table, table.time, columns[table.time])
    return _rated(table, options.get("rate"))


def _bare(header: str) -> str:
    """A header without its unit."""
    return suffixed(split(header)[0])[0]


def _stamp(table: CsvTable, i: int, dated: list[int], columns: list[list[str]], order: str) -> None:
    """Column i, of stamps, becomes seconds; a column of dates alone goes with the first one of times of day."""
    if all(map(is_date, columns[i])) and len(dated) > 1:
        table.stamped[i] = stamps(table.words(i), order, european=table.decimal == ",").values
        return  # its time of day stands beside it
    words = table.words(i)
    days = [d for d in dated if d != i and all(map(is_date, columns[d]))]
    if days and not any(map(is_date, (word.split()[0] for word in columns[i][:1]))):
        words = [f"{day} {word}" for day, word in zip(table.words(days[0]), words, strict=True)]
    found = stamps(words, order, european=table.decimal == ",")
    table.stamped[i] = found.values
    table.units = _with(table.units, i, "s")
    _noted(table, i, found)


def _counted(table: CsvTable, i: int, cells: list[str]) -> None:
    """Column i, of numbers, becomes seconds where it counts from 1970, from midnight or in days."""
    sample = np.array([table._number(cell) for cell in cells])
    clock = counted(table.headers[i], table.units[i], sample)
    if clock is not None:
        table.clocks[i] = clock
        table.units = _with(table.units, i, clock.unit)
        _noted(table, i, clock.seconds(sample))


def _noted(table: CsvTable, i: int, found: Seconds) -> None:
    table.started = table.started or found.started
    table.notes += (f"column {table.headers[i]!r}: {found.note}",) if found.note else ()


def _with(units: tuple[str | None, ...], i: int, unit: str | None) -> tuple[str | None, ...]:
    return (*units[:i], unit, *units[i + 1 :])


_COUNTERS = {"packetcounter": 65536.0, "counter": 65536.0, "sample": 1e12, "sample number": 1e12, "frame": 1e12, "frame#": 1e12}


def _rated(table: CsvTable, rate: Any) -> tuple[CsvTable | None, list[Fault]]:
    """With a rate, a last column of time is made from the counter of samples, else from the rows."""
    if not isinstance(rate, int | float) or isinstance(rate, bool):
        return table, []
    if rate <= 0:
        return None, [run_fault(table.file, f"a rate of {rate:g} Hz", "give the samples per second")]
    if table.time is not None:
        fact = f"the rate {rate:g} Hz is given, but the file has a time of its own"
        return None, [run_fault(table.file, fact, "leave out one of them", table.header_line, table.headers[table.time])]
    names = [split(header)[0].casefold() for header in table.headers]
    place = next((i for i, name in enumerate(names) if name in _COUNTERS), None)
    table.counter = None if place is None else (place, _COUNTERS[names[place]])
    table.headers, table.units, table.rate = (*table.headers, "time [s]"), (*table.units, "s"), float(rate)
    table.time = len(table.headers) - 1
    by = "the rows" if place is None else f"the counter {table.headers[place]!r}"
    table.notes += (f"time made from {by} at {rate:g} Hz",)
    return table, []


def as_frame_table(file: str, frame: Any) -> FrameTable:
    """A frame whose column names are headers."""
    return FrameTable(file, tuple(str(name).strip() for name in frame.columns), frame=frame)
