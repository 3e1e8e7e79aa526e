"""One line of the benchmark, and the lines as a table."""

from __future__ import annotations

import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter

from rich import box
from rich.table import Table


@dataclass(frozen=True)
class Row:
    """What was measured: `samples` in `unit`; the bound it has to keep, if any, and how.

    A row with a `peer` (a median in the same unit) has a target for how many times faster it is; any other for its
    median itself. `limit`, in the same unit, is what the arithmetic alone would take (`limits`), and `why` says what it
    is made of and what is between. `released` is the last release's median in the same run.
    """

    what: str
    unit: str
    samples: Sequence[float]
    target: float | None = None
    peer: float | None = None
    note: str = ""
    limit: float | None = None
    why: str = ""
    released: float | None = None

    @property
    def median(self) -> float:
        return statistics.median(self.samples)

    @property
    def ratio(self) -> float | None:
        return None if self.peer is None else self.peer / self.median

    @property
    def met(self) -> bool | None:
        if self.target is None:
            return None
        return self.median <= self.target if self.ratio is None else self.ratio >= self.target

    def against_target(self) -> str:
        """What was measured, and what is wanted."""
        if self.ratio is not None:
            return f"{self.ratio:.1f}×, not {self.target:g}×"
        return f"{self.median:.3g} {self.unit}".rstrip() + f", not {self.target:g}"

    def as_json(self) -> dict[str, object]:
        return {
            "what": self.what,
            "unit": self.unit,
            "median": self.median,
            "least": min(self.samples),
            "greatest": max(self.samples),
            "ratio": self.ratio,
            "target": self.target,
            "met": self.met,
            "note": self.note,
            "limit": self.limit,
            "why": self.why,
            "released": self.released,
        }


def timed(call: Callable[[], object], repeats: int) -> list[float]:
    """Milliseconds of each repeat, after one call that warms up."""
    call()
    samples = []
    for _ in range(repeats):
        start = perf_counter()
        call()
        samples.append(1e3 * (perf_counter() - start))
    return samples


def table(rows: Sequence[Row]) -> Table:
    shown = Table(box=box.SIMPLE)
    shown.add_column("what")
    for title in ("median", "least to greatest", "last release", "limit", "times faster", "target"):
        shown.add_column(title, justify="right")
    shown.add_column("verdict")
    shown.add_column("note")
    for row in rows:
        bound = "" if row.target is None else (f"≤ {row.target:g} {row.unit}" if row.peer is None else f"≥ {row.target:g}×")
        shown.add_row(
            row.what,
            f"{row.median:.3g} {row.unit}",
            f"{min(row.samples):.3g} to {max(row.samples):.3g}",
            "" if row.released is None else f"{row.released:.3g} {row.unit}",
            "" if row.limit is None else f"{row.limit:.3g} ({row.median / row.limit:.1f}×)",
            "" if row.ratio is None else f"{row.ratio:.1f}×",
            bound,
            "" if row.met is None else ("met" if row.met else "MISSED"),
            row.note,
        )
    return shown
