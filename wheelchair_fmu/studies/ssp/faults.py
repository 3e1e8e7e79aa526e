"""One fault of an .ssp: file, line, element, fact, cure, on one line."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Fault:
    """What is wrong, where, and what to do about it. `line` is 0 where a file as a whole is meant."""

    file: str
    element: str
    fact: str
    cure: str
    line: int = 0

    def __str__(self) -> str:
        place = f"{self.file} line {self.line}" if self.line else self.file
        return f"{place}{', ' if self.element else ''}{self.element}: {self.fact}; {self.cure}"
