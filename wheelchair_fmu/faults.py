"""One fault of a file: place, fact, value, cure, on one line."""

from __future__ import annotations

import traceback
from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches

ERROR, WARNING, NOTE = "error", "warning", "note"
SHOWN = 10  # faults of one kind listed for one column; the rest are counted
LONG = 500  # characters of a fact; a cell may hold a million


@dataclass(frozen=True)
class Fault:
    """What is wrong, where, and what to do about it.

    `file` is its name as the user wrote it, `line` counts from 1 with the header as line 1,
    `column` is a whole header; `place` is the dotted key of campaign.toml that it is of, as in `chair.m`,
    and of the first run `run.0.u0`.
    An error stops `read`; a warning does not; of a note nothing is to be done.
    """

    file: str
    line: int | None
    column: str | None
    fact: str
    cure: str
    severity: str = ERROR
    in_run: bool = False  # the file is a recording of a campaign
    place: str = ""

    @property
    def where(self) -> str:
        """Its file, line and column in words."""
        place = f"run {self.file}" if self.in_run else self.file
        line = f" line {self.line}" if self.line is not None else ""
        column = f" column {short(repr(self.column))}" if self.column is not None else ""
        return f"{place}{line}{column}"

    @property
    def what(self) -> str:
        """The fact and its cure."""
        return f"{short(self.fact)}; {self.cure}"

    def __str__(self) -> str:
        kind = "" if self.severity == ERROR else f"{self.severity}: "
        return f"{kind}{self.where}: {self.what}"


def short(text: str) -> str:
    """The text, or its two ends where a file put too much into it."""
    return text if len(text) <= LONG else f"{text[: LONG // 2]} … {text[-LONG // 2 :]}"


def some(words: Iterable[str]) -> str:
    """The first of many words, with commas, and how many more there are."""
    words = list(words)
    more = f" and {len(words) - SHOWN} more" if len(words) > SHOWN else ""
    return ", ".join(words[:SHOWN]) + more


def run_fault(
    file: str, fact: str, cure: str, line: int | None = None, column: str | None = None, severity: str = ERROR
) -> Fault:
    """A fault in a recording."""
    return Fault(file, line, column, fact, cure, severity, in_run=True)


def raised(file: str, error: BaseException) -> tuple[str, int | None, str]:
    """Where a program's file failed, in the last of its lines that took part, and what it said, on one line."""
    if isinstance(error, SyntaxError):
        return error.filename or file, error.lineno, f"{type(error).__name__}: {error.msg}"
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file]
    said = f"{type(error).__name__}: {' '.join(str(error).split())}".removesuffix(": ")
    return file, lines[-1] if lines else None, said


def not_utf8(file: str, raw: bytes, error: UnicodeDecodeError) -> Fault:
    """The fault of bytes that are no UTF-8."""
    line = error.object[: error.start].count(b"\n") + 1
    fact = f"byte {error.start} (0x{error.object[error.start]:02X}) is not UTF-8 text"
    cure = "save the file as UTF-8"
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        cure = "it looks like UTF-16; save the file as UTF-8"
    return Fault(file, line, None, fact, cure)


def suggestion(name: str, known: Iterable[str]) -> str:
    """The cure for a misspelt name: the nearest known ones, or all of them."""
    known = list(known)
    close = get_close_matches(name, known, n=3, cutoff=0.5)
    if close:
        return f"did you mean {' or '.join(repr(c) for c in close)}?"
    return f"known: {', '.join(known)}"


def once(faults: Iterable[Fault]) -> list[Fault]:
    """The same faults without repetition (two runs may use one file), in order."""
    return list(dict.fromkeys(faults))
