"""campaign.toml as data that remembers its lines."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from typing import Any

from ..faults import ERROR, Fault, not_utf8
from ..given import toml, what_is
from ..model.former import renamed
from .channels import BY_NAME
from .syntax import HEADER, KEY, fault_of_syntax

FILE = "campaign.toml"
REPEATED = ("run", "recording")  # written [[run]], each a list
Lines = dict[tuple[str, int | None], int]


def number(value: Any) -> float | None:
    """A finite number as float; None for anything else (true and false are no numbers)."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    try:
        return float(value) if isfinite(value) else None
    except OverflowError:  # an integer of hundreds of digits
        return None


def flatten(table: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Dotted name and value of every leaf: [tyre.force] C and [tyre] "force.C" are both tyre.force.C."""
    for key, value in table.items():
        name = f"{prefix}.{key}" if prefix else key
        if isinstance(value, Mapping):
            yield from flatten(value, name)
        else:
            yield name, value


def numbers(table: Mapping[str, Any]) -> dict[str, float]:
    """What in the table is a finite number."""
    return {name: plain for name, value in table.items() if (plain := number(value)) is not None}


@dataclass(frozen=True)
class Entry:
    """One [[run]], or another table of a list. `place` counts from 0."""

    place: int
    data: Mapping[str, Any]

    def text(self, key: str, default: str = "") -> str:
        value = self.data.get(key)
        return value if isinstance(value, str) else default

    def number(self, key: str) -> float | None:
        return number(self.data.get(key))

    def table(self, key: str) -> dict[str, Any]:
        value = self.data.get(key)
        return dict(value) if isinstance(value, Mapping) else {}

    @property
    def file(self) -> str:
        return self.text("file")

    @property
    def title(self) -> str:
        return f"run {self.place + 1}" + (f" ({self.file})" if self.file else "")


@dataclass(frozen=True)
class Document:
    """The content of campaign.toml; wrong types read as absent and are reported by the checks."""

    path: Path
    raw: bytes
    data: Mapping[str, Any]
    lines: Lines = field(repr=False)

    @property
    def folder(self) -> Path:
        return self.path.parent

    def table(self, name: str) -> dict[str, Any]:
        value = self.data.get(name)
        return dict(value) if isinstance(value, Mapping) else {}

    @property
    def entries(self) -> tuple[Entry, ...]:
        runs = self.data.get("run")
        runs = runs if isinstance(runs, list) else []
        return tuple(Entry(i, run) for i, run in enumerate(runs) if isinstance(run, Mapping))

    @property
    def recordings(self) -> tuple[Mapping[str, Any], ...]:
        """The tables [[recording]]; what is no table reads as an empty one."""
        found = self.data.get("recording")
        return tuple(r if isinstance(r, Mapping) else {} for r in (found if isinstance(found, list) else []))

    @property
    def axes(self) -> str:
        value = self.table("campaign").get("axes")
        return value if isinstance(value, str) else ""

    def parameters(self, names: tuple[str, ...]) -> dict[str, Any]:
        """Dotted parameter names and their values as written."""
        found = dict(flatten({name: self.table(name) for name in names}))
        if "g" in self.data:
            found["g"] = self.data["g"]
        return found

    def known(self, names: tuple[str, ...]) -> dict[str, float]:
        """The parameters that are numbers, by today's names. Raises UsageError where a former one stands beside these."""
        return renamed(numbers(self.parameters(names)), {})[0]

    def line(self, path: str, run: int | None = None) -> int | None:
        """Line of the dotted key, or of the nearest table that holds it."""
        while path:
            if (path, run) in self.lines:
                return self.lines[path, run]
            path = path.rpartition(".")[0]
        return None

    def fault(self, path: str, fact: str, cure: str, run: int | None = None, severity: str = ERROR) -> Fault:
        table, _, key = path.partition(".")
        place = path if run is None else f"{table}.{run}.{key}"
        return Fault(self.path.name, self.line(path, run), None, fact, cure, severity, place=place)


def load(path: str | Path) -> tuple[Document | None, list[Fault]]:
    """Reads the folder's campaign.toml, or the file itself; no document where it cannot be parsed."""
    path = Path(path)
    if not path.exists():
        return None, [Fault(str(path), None, None, "no such folder or file", "check the path")]
    if path.is_dir():
        path = path / FILE
        if not path.is_file():
            what = f"no {FILE} in this folder"
            return None, [Fault(str(path.parent), None, None, what, "write one that names the chair and the runs")]
    elif kind := what_is(path):
        return None, [Fault(str(path), None, None, f"this is {kind}", "give a folder with campaign.toml, or that file")]
    try:
        raw = path.read_bytes()
    except OSError as error:
        fact = f"the file cannot be read ({error.strerror})"
        return None, [Fault(path.name, None, None, fact, "check the rights to read it")]
    try:
        text = raw.decode("utf-8-sig").replace("\r\n", "\n")
        data = toml(text)
    except UnicodeDecodeError as error:
        return None, [not_utf8(path.name, raw, error)]
    except tomllib.TOMLDecodeError as error:
        return None, [fault_of_syntax(path.name, text, str(error))]
    return Document(path, raw, _named(data), _lines(text)), []


CHANNELLED = ("columns", "noise", "nuisance", "constant")  # tables whose keys are names of channels
PARTS = frozenset(name.partition(".")[0] for name in BY_NAME if "." in name)


def _named(data: Any) -> Any:
    """The same where what TOML takes for a table in a table, as in [noise] rider.momentum = 2, is the channel of that name."""
    if isinstance(data, list):
        return [_named(one) for one in data]
    if not isinstance(data, Mapping):
        return data
    return {
        key: _whole(value) if key in CHANNELLED and isinstance(value, Mapping) else _named(value) for key, value in data.items()
    }


def _whole(table: Mapping[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in table.items():
        if key in PARTS and isinstance(value, Mapping):
            found |= {f"{key}.{name}": inner for name, inner in value.items()}
        else:
            found[key] = value
    return found


def _lines(text: str) -> Lines:
    """Line of every table and key: (dotted name, place in its list or None) → line, counted from 1."""
    lines: Lines = {}
    table, last = "", dict.fromkeys(REPEATED, -1)
    for i, row in enumerate(text.split("\n"), start=1):
        if header := HEADER.match(row):
            table = re.sub(r"[\"'\s]", "", header[2])
            if table in last and header[1]:
                last[table] += 1
            lines.setdefault((table, _place(table, last)), i)
        elif key := KEY.match(row):
            name = re.sub(r"[\"']", "", re.sub(r"\s*\.\s*", ".", key[1]))
            name = f"{table}.{name}" if table else name
            lines.setdefault((name, _place(table, last)), i)
    return lines


def _place(table: str, last: Mapping[str, int]) -> int | None:
    """Where in its list a table stands that is written now."""
    place = last.get(table.partition(".")[0], -1)
    return None if place < 0 else place
