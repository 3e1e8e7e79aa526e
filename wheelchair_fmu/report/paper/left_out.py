"""What was left out of the data, or found odd in them, and why."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import astuple, dataclass, fields

import pandas as pd

from ...campaign import Run
from ...campaign.recorded import PUSHES_CLOCK
from ...faults import Fault
from .case import Case

LEFT_OUT = "left out"  # as checks and notes say it
RESTS = "an acceleration where the chair comes to rest is foretold by no slope, and its reading says nothing"
UNKNOWN = "it is not what its name says, or was not measured in time"
PUSHES = "the pushes that the chair felt then are not in the record, once it is read at the time of the readings"
STOOD = "the chair stood or hardly rolled, so that forces which nobody recorded may have moved it or not"
SHIFT = 1e-3  # s, less than which no run is called shorter


@dataclass(frozen=True)
class Remark:
    """A row of left_out.csv: where, what it is about, why, who says so, and whether anything was left out."""

    place: str
    what: str
    why: str
    said_by: str
    left_out: bool


def left_out(case: Case) -> pd.DataFrame:
    """What `check` says of the files, and what the diagnosis left out or remarked on."""
    rows = [*map(_of_check, case.campaign.warnings), *_channels(case), *_shorter(case)]
    rows += _notes(case, {row.why for row in rows})
    return pd.DataFrame([astuple(row) for row in rows], columns=[f.name for f in fields(Remark)])


def _of_check(fault: Fault) -> Remark:
    line = f" line {fault.line}" if fault.line is not None else ""
    return Remark(f"{fault.file}{line}", fault.column or "", fault.fact, "check", LEFT_OUT in fault.fact)


def _channels(case: Case) -> Iterator[Remark]:
    """Channels that the diagnosis did not use, or of which it did not use every reading."""
    for run in case.campaign.runs:
        pieces = [piece["channels"] for piece in case.pieces(run)]
        for channel in run.channels:
            kept = [piece[channel] for piece in pieces if channel in piece]
            readings = sum(one["readings"] for one in kept)
            missing = sum(one["readings"] - one["used"] for one in kept if one["used"] is not None)
            if not kept:
                yield Remark(run.name, channel, _reason(case, channel, run), "diagnosis", True)
            elif missing:
                yield Remark(run.name, f"{channel}: {missing} of {readings} readings", RESTS, "diagnosis", True)


def _reason(case: Case, channel: str, run: Run) -> str:
    notes = [n for n in case.told["notes"] if channel in n or n.startswith(f"{run.name}:")]
    return notes[0] if notes else UNKNOWN


def _shorter(case: Case) -> Iterator[Remark]:
    """What a run lost where its chair did not roll, or when its pushes were read at another time."""
    for run in case.campaign.runs:
        late = abs(case.told.get("sync", {}).get(run.name, {}).get(PUSHES_CLOCK, {}).get("offset", 0.0))
        for first, last in _gaps(float(run.time[0]), float(run.time[-1]), case.used(run)):
            why = STOOD if case.with_forces and last - first > late + SHIFT else PUSHES
            yield Remark(run.name, f"{first:.3f} to {last:.3f} s ({last - first:.3f} s)", why, "diagnosis", True)


def _gaps(begins: float, ends: float, used: Sequence[tuple[float, float]]) -> Iterator[tuple[float, float]]:
    """From when to when a run was not used, of which these stretches were."""
    if used:
        edges = [begins, *(edge for stretch in used for edge in stretch), ends]
        yield from ((a, b) for a, b in zip(edges[::2], edges[1::2], strict=True) if b - a > SHIFT)


def _notes(case: Case, said: set[str]) -> Iterator[Remark]:
    for note in (n for n in case.told["notes"] if n not in said):
        yield Remark(case.campaign.name, "", note, "diagnosis", LEFT_OUT in note or note == case.campaign.thinned)
