"""A run as all its devices recorded it: the times of all their samples, each channel where it was sampled, NaN elsewhere."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import takewhile
from pathlib import Path

import numpy as np

from .axes import to_sae
from .channels import BY_NAME, CHANNEL_NAMES, INPUT_NAMES
from .clocks.lag import CRYSTAL
from .devices import clock
from .document import Document, Entry
from .draft import Draft, Readings, constants
from .records import Clock
from .series import began

PUSHES_CLOCK = "pushes"  # what `clocks` calls the record of pushes in a run of one file
GRID = 1e-6  # s to which times of several devices are kept, so that two samples at one moment share a row


@dataclass(frozen=True, eq=False)
class Recorded(Readings):
    """The files of one run together. All series are (n,) at `time`, which is None where a file has no time column, or where no
    moment is covered by all records of pushes."""

    doc: Document
    entry: Entry
    drafts: tuple[Draft, ...]

    def slim(self) -> Recorded:
        """See `Draft.slim`."""
        return Recorded(self.doc, self.entry, tuple(d.slim() for d in self.drafts))

    @property
    def file(self) -> str:
        """The run's file, or how messages call several."""
        return self.drafts[0].file if len(self.drafts) == 1 else self.name

    @cached_property
    def name(self) -> str:
        """What its files' names have in common, unless the run has a name of its own."""
        stems = [Path(d.file).name.partition(".")[0] for d in self.drafts]
        alike = takewhile(lambda letters: len(set(letters)) == 1, zip(*stems, strict=False))
        shared = stems[0] if len(stems) == 1 else re.sub(r"[\W_]+$", "", "".join(letters[0] for letters in alike))
        return self.entry.text("name") or shared or f"run-{self.entry.place + 1}"

    @cached_property
    def constants(self) -> dict[str, float]:
        """Channels that were not logged but are known, in SI and SAE J670."""
        return to_sae(constants(self.entry), self.doc.axes)

    @cached_property
    def time(self) -> np.ndarray | None:
        times = [d.time for d in self.drafts]
        if len(times) == 1:
            return times[0]
        known = [t for t in times if t is not None and t.size]
        if len(known) < len(times):
            return None
        first, last = self._pushed
        together = np.unique(np.round(np.concatenate(known) / GRID) * GRID)
        inside = together[(together >= first - GRID) & (together <= last + GRID)]
        return inside if inside.size else None

    @property
    def _pushed(self) -> tuple[float, float]:
        """From when to when all records of pushes have samples."""
        times = [d.time for d in self.drafts if d.pushed and d.time is not None]
        return max((float(t[0]) for t in times), default=-np.inf), min((float(t[-1]) for t in times), default=np.inf)

    @cached_property
    def values(self) -> dict[str, np.ndarray]:
        """Everything recorded or known, by name: channels with NaN in gaps, inputs as straight lines between their samples."""
        if len(self.drafts) == 1:
            found = self._shifted(self.drafts[0])
            rows = len(next(iter(found.values()))) if found else len(self.drafts[0].kept)
        elif self.time is None:
            return {}
        else:
            rows = len(self.time)
            found = {name: self._on_rows(d, name) for d in self.drafts for name in d.values}
        return found | {name: np.full(rows, value) for name, value in self.constants.items()}

    @property
    def late(self) -> float:
        """How many seconds after the times in a run's only file the chair felt its pushes."""
        return clock(self.entry, PUSHES_CLOCK).offset if len(self.drafts) == 1 else 0.0

    def _shifted(self, draft: Draft) -> dict[str, np.ndarray]:
        """What a run's only file holds, its pushes read when the chair felt them."""
        late, found = self.late, dict(draft.values)
        if late and draft.time is not None:
            found |= {name: np.interp(draft.time - late, draft.time, push) for name, push in draft.pushed.items()}
        return found

    def _on_rows(self, draft: Draft, name: str) -> np.ndarray:
        assert self.time is not None and draft.time is not None
        own, series = draft.time, draft.values[name]
        there = np.isfinite(series)
        if name in INPUT_NAMES:
            return np.interp(self.time, own[there], series[there]) if there.any() else np.full(len(self.time), np.nan)
        at = np.searchsorted(self.time, np.round(own[there] / GRID) * GRID - GRID / 2)
        out, inside = np.full(len(self.time), np.nan), at < len(self.time)
        inside &= own[there] >= self.time[0] - GRID
        out[at[inside]] = series[there][inside]
        return out

    def _says(self, name: str, series: np.ndarray) -> bool:
        """A constant never changes, and yet somebody has given it."""
        return name in self.constants or super()._says(name, series)

    @property
    def silent(self) -> bool:
        """Does the run say nothing, although it has channels? The chair stood still, or nothing was recorded."""
        return bool(self.channels) and not self.measured

    @property
    def logged(self) -> dict[str, np.ndarray]:
        """What the files hold, without the constants, each at its own device's samples: a push that is read between them, at
        another one's, has less noise."""
        return {name: series for d in self.drafts for name, series in d.values.items() if name not in self.constants}

    def draft_of(self, name: str) -> Draft | None:
        """The file that a channel or an input is from; None for a constant."""
        return next((d for d in self.drafts if name in d.values), None) if name not in self.constants else None

    def knows_clock_of(self, draft: Draft) -> bool:
        """Is it said how far a device's clock is off, or is it the first one's, which the others are held against?"""
        return draft is self.drafts[0] or draft.part.device.name in self.entry.table("clocks")

    @property
    def clocks(self) -> tuple[Clock, ...]:
        """What is left uncertain of the devices' clocks; where the first one's is, those too that add no error of their own."""
        if len(self.drafts) == 1:
            own = clock(self.entry, PUSHES_CLOCK)
            return (Clock(PUSHES_CLOCK, frozenset(), _fmu_names(self.drafts[0].pushed), own.sd, own.offset),) if own.sd else ()
        return tuple(
            Clock(
                d.part.device.name,
                frozenset(d.channels) & frozenset(CHANNEL_NAMES),
                _fmu_names(d.inputs),
                d.part.clock.sd,
                d.part.clock.offset,
                d is self.drafts[0],
                _wander(d),
            )
            for d in self.drafts
            if d.part.clock.sd > 0 or self.drafts[0].part.clock.sd > 0
        )

    @property
    def seen(self) -> tuple[float, float] | None:
        """From when to when the rider's body was seen, by the run's clock; None where nobody looked."""
        return next((d.seen for d in self.drafts if d.seen is not None), None)

    @property
    def steps(self) -> dict[str, float]:
        """Time between the samples of each recorded push, in s, where several devices recorded the run."""
        if len(self.drafts) == 1:
            return {}
        steps = {d.file: float(np.median(np.diff(d.time))) for d in self.drafts if d.time is not None and d.time.size > 1}
        return {BY_NAME[name].fmu: steps[d.file] for d in self.drafts if d.file in steps for name in d.inputs}

    @cached_property
    def first_speed(self) -> float | None:
        """Speed at the first samples, m/s: from u, else from the wheels; None where nothing tells."""
        if "u" in self.values:
            series = [self.values["u"]]
        elif "wheel_speed_l" in self.values and "wheel_speed_r" in self.values:
            series = [self.values["wheel_speed_l"], self.values["wheel_speed_r"]]
        else:
            return None
        firsts = [value for s in series if self.time is not None and (value := began(self.time, s)) is not None]
        return float(np.mean(firsts)) if len(firsts) == len(series) else None

    @property
    def u0(self) -> float | None:
        stated = self.entry.number("u0")
        return stated if stated is not None else self.first_speed


def _fmu_names(inputs: Sequence[str] | Mapping[str, np.ndarray]) -> frozenset[str]:
    return frozenset(BY_NAME[name].fmu for name in inputs)


def _wander(draft: Draft) -> float:
    """Standard deviation, in s, of how much further off a device's clock is at its own time 0 than in the middle of its file,
    where nobody knows its rate."""
    if draft.time is None or draft.part.clock.drift:
        return 0.0
    return CRYSTAL * abs(float(np.mean(draft.time)) - draft.part.clock.offset)
