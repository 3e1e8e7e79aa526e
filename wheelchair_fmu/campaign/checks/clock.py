"""Checks of a recording's time column, over the whole file."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from ...faults import ERROR, NOTE, SHOWN, WARNING, Fault, run_fault, some
from ..draft import COARSE, Draft

LONGEST = 600.0  # s without a sample, over which nobody can foretell where the chair is
_UNEVEN = 0.5  # share of the usual step by which one may differ


def no_time(draft: Draft) -> Iterator[Fault]:
    if draft.whole_time is None:
        fact = f"no time column among {some(map(repr, draft.table.headers))}"
        home = "[columns] time" if draft.part.alone else f"columns.time of the [[recording]] of {draft.part.device.name}"
        yield run_fault(draft.file, fact, f"name it 'time [s]', give its header in {home}, or write rate = ... in Hz", 1)


def empty_time(draft: Draft) -> Iterator[Fault]:
    if draft.whole_time is not None:
        places = np.flatnonzero(np.isnan(draft.whole_time))
        bad = {fault.line for fault in draft.rows.faults if fault.column == draft.header("time")}
        places = places[[draft.rows.line(int(row)) not in bad for row in places]] if bad else places
        yield from _listed(draft, places, lambda i: "the time is empty", "fill it in, or remove the row")


def time_goes_back(draft: Draft) -> Iterator[Fault]:
    time, rows = _finite(draft)
    steps = np.flatnonzero(np.diff(time) < 0) + 1
    if 2 * len(steps) > len(time):
        fact = f"time runs backwards, from {time[0]:.10g} to {time[-1]:.10g} s"
        yield run_fault(draft.file, fact, "sort the rows, the earliest first", draft.rows.line(int(rows[steps[0]])))
        return
    yield from _listed(
        draft,
        rows[steps],
        lambda i: f"time goes back from {_before(draft, i):.10g} to {_time(draft, i):.10g} s",
        "remove or sort the rows",
    )


def time_twice(draft: Draft) -> Iterator[Fault]:
    time, rows = _finite(draft)
    steps = np.flatnonzero(np.diff(time) == 0) + 1
    yield from _listed(draft, rows[steps], lambda i: f"time {_time(draft, i):.10g} s is there twice", "remove one of the rows")


def copies(draft: Draft) -> Iterator[Fault]:
    """Rows that a logger sent twice, or not quite in turn: it is said what was done with them."""
    found = draft.stamps
    if found is not None and found.copies.size:
        n, line = len(found.copies), draft.rows.line(int(found.copies[0]))
        fact = f"{n} {'rows are copies' if n > 1 else 'row is a copy'} of the one before, with its time, and left out"
        yield run_fault(draft.file, fact, "nothing is to be done", line, severity=NOTE)
    if found is not None and found.overtaken.size:
        n, line = len(found.overtaken), draft.rows.line(int(found.overtaken[0]))
        whose = f"{n} rows stand behind a later one" if n > 1 else "a row stands behind a later one"
        fact = f"{whose}, by {found.by:.2g} s{' at most' if n > 1 else ''}, and {'are' if n > 1 else 'is'} read in turn"
        yield run_fault(draft.file, fact, "nothing is to be done", line, severity=NOTE)


def uneven(draft: Draft) -> Iterator[Fault]:
    time, rows = _finite(draft)
    steps = np.diff(time)
    steps_up = steps[steps > 0]
    if steps_up.size < 2:
        return
    usual = float(np.median(steps_up))
    odd = np.flatnonzero((steps > 0) & (np.abs(steps - usual) > _UNEVEN * usual))
    if odd.size:
        i = odd[np.argmax(steps[odd])]
        worst = f"the largest is {steps[i]:.4g} s after {time[i]:.10g} s"
        fact = f"{odd.size} time step{'s' * (odd.size > 1)} far from the usual {usual:.4g} s; {worst}"
        cure = "check the logger for lost samples"
        if steps[i] > LONGEST:
            cure = "nothing is known of so long a time; make two runs of it by from and to, or check the unit of time"
        severity = ERROR if steps[i] > LONGEST else WARNING
        yield run_fault(draft.file, fact, cure, draft.rows.line(int(rows[i + 1])), draft.header("time"), severity)


def coarse(draft: Draft) -> Iterator[Fault]:
    time, _ = _finite(draft)
    steps = np.diff(time)
    steps = steps[steps > 0]
    if steps.size and (usual := float(np.median(steps))) > COARSE:
        fact = f"one sample each {usual:.4g} s is too coarse for the chair's yaw motion"
        yield run_fault(draft.file, fact, "log at 50 Hz or more; check the unit of time", 1, draft.header("time"), WARNING)


def _finite(draft: Draft) -> tuple[np.ndarray, np.ndarray]:
    """Times that are there, as they are read, and their rows in the file."""
    if draft.whole_time is None or draft.stamps is None:
        return np.empty(0), np.empty(0, dtype=int)
    rows = draft.stamps.rows
    return draft.whole_time[rows], rows


def _time(draft: Draft, row: int) -> float:
    assert draft.whole_time is not None
    return float(draft.whole_time[row])


def _before(draft: Draft, row: int) -> float:
    """The last time above this row."""
    time, rows = _finite(draft)
    return float(time[np.searchsorted(rows, row) - 1])


def _listed(draft: Draft, places: np.ndarray, fact: Callable[[int], str], cure: str) -> Iterator[Fault]:
    for row in places[:SHOWN]:
        yield run_fault(draft.file, fact(int(row)), cure, draft.rows.line(int(row)))
    if len(places) > SHOWN:
        line = draft.rows.line(int(places[SHOWN]))
        yield run_fault(draft.file, f"{len(places) - SHOWN} more rows like these", cure, line)


CLOCK_CHECKS: tuple[Callable[[Draft], Iterator[Fault]], ...] = (
    no_time,
    empty_time,
    time_goes_back,
    time_twice,
    copies,
    uneven,
    coarse,
)
