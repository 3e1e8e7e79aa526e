"""What was left out of the data, or found odd in them, and why."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import astuple, dataclass, fields

import pandas as pd

from ...campaign import Run
from ...faults import Fault
from .case import Case

LEFT_OUT = "left out"  # as checks and notes say it
RESTS = "an acceleration where the chair comes to rest is foretold by no slope, and its reading says nothing"
UNKNOWN = "it is not what its name says, or was not measured in time"
PUSHES = "the pushes that the chair felt then are not in the record, once it is read at the time of the readings"
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
    used = case.final["runs"]
    for run in case.campaign.runs:
        kept = used.get(run.name, {}).get("channels", {})
        for channel in run.channels:
            if channel not in kept:
                yield Remark(run.name, channel, _reason(case, channel, run), "diagnosis", True)
            elif (n := kept[channel]["used"]) is not None and n < kept[channel]["readings"]:
                readings = kept[channel]["readings"]
                yield Remark(run.name, f"{channel}: {readings - n} of {readings} readings", RESTS, "diagnosis", True)


def _reason(case: Case, channel: str, run: Run) -> str:
    notes = [n for n in case.told["notes"] if channel in n or n.startswith(f"{run.name}:")]
    return notes[0] if notes else UNKNOWN


def _shorter(case: Case) -> Iterator[Remark]:
    """What a run lost when its pushes were read at another time."""
    for run in case.campaign.runs:
        used = case.final["runs"].get(run.name)
        for lost, first, last in () if used is None else _lost(run, used["from"], used["to"]):
            yield Remark(run.name, f"{first:.3f} to {last:.3f} s ({lost:.3f} s)", PUSHES, "diagnosis", True)


def _lost(run: Run, first: float, last: float) -> Iterator[tuple[float, float, float]]:
    begins, ends = float(run.time[0]), float(run.time[-1])
    if first - begins > SHIFT:
        yield first - begins, begins, first
    if ends - last > SHIFT:
        yield ends - last, last, ends


def _notes(case: Case, said: set[str]) -> Iterator[Remark]:
    for note in (n for n in case.told["notes"] if n not in said):
        yield Remark(case.campaign.name, "", note, "diagnosis", LEFT_OUT in note or note == case.campaign.thinned)
