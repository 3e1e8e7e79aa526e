"""What a format is: one record, in a file of its own."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...faults import Fault
from ...tables import Table

Read = tuple[Table | None, list[Fault]]


@dataclass(frozen=True)
class Option:
    """A key of a run that tells how its file is to be read. `kind` is text or number; `default` says what holds without it."""

    key: str
    kind: str
    unit: str
    default: str
    meaning: str


@dataclass(frozen=True)
class Format:
    """A way in which files are written.

    `recognises` gets the path and the first 64 kB of its content, unpacked where the name ends in .gz, and looks for what no
    other format has. `read` gets the path, the file as the user names it, and all keys of the run; it raises nothing: what
    is wrong becomes faults. `needs` is the library that reads it, as pip names it, where it is not installed with the package.
    """

    id: str
    title: str
    suffixes: tuple[str, ...]
    meaning: str
    options: tuple[Option, ...]
    needs: str | None
    recognises: Callable[[Path, bytes], bool]
    read: Callable[[Path, str, Mapping[str, Any]], Read]


RATE = Option("rate", "number", "Hz", "the file's own time", "samples per second, where the file has no time")
DATES = Option(
    "dates", "text", "", "as the dates tell", 'whether 3/4/2026 is in April ("day first") or in March ("month first")'
)
TEXT = (
    Option("encoding", "text", "", "found by looking", "how the letters are stored, such as cp1252 or utf-16"),
    Option("separator", "text", "", "found by looking", 'what stands between cells: ",", ";", "tab", "spaces"'),
    Option("decimal", "text", "", "found by looking", 'the decimal sign, "." or ","'),
    Option("skip", "number", "", "found by looking", "lines before the header"),
    DATES,
    RATE,
)
