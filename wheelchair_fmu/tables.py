"""Recordings as tables: headers, and columns of numbers on demand."""

from __future__ import annotations

import csv
import gzip
import io
import re
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from math import nan
from pathlib import Path
from typing import Any, Literal, Protocol

import numpy as np
import pandas as pd

from .faults import SHOWN, Fault, not_utf8, run_fault
from .given import what_is

MOST = 2**30  # bytes that a packed recording may have unpacked: a day at 100 Hz has less
_GAPS = ("", "NaN", "nan", "NAN")
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
    """What every format is read into."""

    file: str
    headers: tuple[str, ...]

    def rows(self, indices: Sequence[int]) -> Rows: ...


@dataclass
class FrameTable:
    """A table that a library has read already: numbers, no lines."""

    file: str
    headers: tuple[str, ...]
    frame: pd.DataFrame

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
    _known: dict[tuple[int, ...], Rows] = field(default_factory=dict, repr=False)

    def rows(self, indices: Sequence[int]) -> Rows:
        key = tuple(indices)
        if key not in self._known:
            self._known[key] = self._fast(key) or self._careful(key)
        return self._known[key]

    def words(self, index: int) -> list[str]:
        """A column of text, one word for each row of `rows`."""
        filled = (row for row in self._cells() if any(cell.strip() for cell in row))
        return [row[index].strip() if index < len(row) else "" for row in filled]

    def _fast(self, indices: tuple[int, ...]) -> Rows | None:
        """Pandas' C parser; None where anything is odd, so that the careful way can say what and where."""
        body = self.body.rstrip("\r\n")
        rows = body.count("\n") + 1
        if not body or '"' in body or "\n\n" in body or body[0] in "\r\n" or "\n\r" in body:
            return None
        if body.count(self.separator) != rows * (len(self.headers) - 1):
            return None
        try:
            frame = pd.read_csv(
                io.StringIO(body), sep=self.separator, decimal=self.decimal, header=None, usecols=list(indices),
                dtype=float, keep_default_na=False, na_values=list(_GAPS), index_col=False,
            )  # fmt: skip
        except ValueError:  # ParserError is one
            return None
        if len(frame) != rows:
            return None
        lines = np.arange(rows) + self.header_line + 1
        values = {i: frame[i].to_numpy() for i in indices}
        return Rows(values, lines, tuple(self._infinite(values, lines)))

    def _careful(self, indices: tuple[int, ...]) -> Rows:
        """Cell by cell, to name the line of every fault."""
        reader, too_long = self._cells(), list[Fault]()
        cells: dict[int, list[float]] = {i: [] for i in indices}
        lines: list[int] = []
        bad: dict[int, list[tuple[int, str]]] = {i: [] for i in indices}
        ragged: list[tuple[int, str]] = []
        while True:
            try:
                row = next(reader)
            except StopIteration:
                break
            except csv.Error as error:
                line = reader.line_num + self.header_line
                too_long.append(run_fault(self.file, f"the row cannot be read ({error})", "export the file again", line))
                break
            if not any(cell.strip() for cell in row):
                continue
            line = reader.line_num + self.header_line
            lines.append(line)
            if len(row) != len(self.headers) and any(cell.strip() for cell in row[len(self.headers) :] or ["short"]):
                ragged.append((line, f"{len(row)} cells, but the header has {len(self.headers)}"))
            for i in indices:
                text = row[i].strip() if i < len(row) else ""
                cells[i].append(self._number(text))
                if np.isnan(cells[i][-1]) and text not in _GAPS:
                    bad[i].append((line, f"{text!r} is not a number"))
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

    def _number(self, text: str) -> float:
        text = text.replace(",", ".") if self.decimal == "," else text
        return float(text) if _NUMBER.fullmatch(text) else nan

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


def read_csv(file: str, raw: bytes) -> tuple[CsvTable | None, list[Fault]]:
    """A CSV table from its bytes; separator and decimal sign are found by looking."""
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        return None, [not_utf8(file, raw, error, in_run=True)]
    if not text.strip():
        return None, [run_fault(file, "the file is empty", "export it again, or leave it out")]
    text = text.replace("\r\n", "\n").replace("\r", "\n")
    blank = len(text) - len(text.lstrip("\n"))
    first, _, body = text[blank:].partition("\n")
    separator = _separator(first)
    try:
        headers = tuple(cell.strip() for cell in next(csv.reader([first], delimiter=separator)))
    except csv.Error as error:
        cure = "is it a table with one line of headers?"
        return None, [run_fault(file, f"the header cannot be read ({error})", cure, blank + 1)]
    if not body.strip():
        return None, [run_fault(file, "the file has a header but no rows", "export it again, or leave it out")]
    decimal = "," if separator != "," and "," in body else "."
    return CsvTable(file, headers, body, separator, decimal, blank + 1), []


def _separator(header: str) -> str:
    """The separator that the header holds most often; a comma where there is none."""
    bare = re.sub(r'\[[^\]]*\]|"[^"]*"', "", header)
    return max(",;\t", key=bare.count)


def as_frame_table(file: str, frame: Any) -> FrameTable:
    """A frame whose column names are headers."""
    return FrameTable(file, tuple(str(name).strip() for name in frame.columns), frame)
