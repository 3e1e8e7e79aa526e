"""The clocks of a campaign's devices: found from what they see alike, and written into campaign.toml."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..writing import written
from .clocks import Clock, Shift, Signal, odd_ones_out, offsets
from .clocks.signals import rate
from .document import Document
from .layout import relaid
from .recorded import PUSHES_CLOCK, Recorded

CURE = f"give clocks = {{ {PUSHES_CLOCK} = … }} in the run if you know which it is"
PLACES = 5  # decimals of a second that are written
DRIFTS = 3.0  # standard errors from which a drift is written
LONGEST = 300.0  # s of a run of one file that are looked at


@dataclass(frozen=True)
class RunClocks:
    """What was found of one run: a clock for each device but the first, whose times the others are brought to; `middles` are
    by device those of its file times (s)."""

    run: Recorded
    reference: str
    clocks: Mapping[str, Clock | Shift]
    shared: float = 0.0  # s, standard error of the reference's own clock, in which all others' are the same
    middles: Mapping[str, float] = field(default_factory=dict)

    def seconds(self, device: str) -> float:
        """What to add to a device's times; 0 for the one that the others are brought to, NaN where nobody knows. Where a drift
        is too unsure to be written, it is what is right in the middle of the run."""
        clock = self.clocks.get(device)
        if clock is None or isinstance(clock, Shift):
            return clock.seconds if clock else 0.0
        return clock.offset if _drifts(clock) else clock.offset + clock.drift * self.middles.get(device, 0.0)

    def why(self, device: str) -> str:
        """In words: what told it, or what is missing."""
        clock = self.clocks[device]
        if not isinstance(clock, Shift):
            return clock.why
        told = f"its pushes against its readings, by {clock.way}"
        return told if clock.unique else f"{told}, tell {clock.seconds:.3f} s but for whole strokes; {CURE}"

    @property
    def sure(self) -> dict[str, dict[str, float]]:
        """What may be written, by device: offsets, and how unsure each device's own clock is."""
        found: dict[str, dict[str, float]] = {}
        for device, clock in self.clocks.items():
            if not (clock.unique if isinstance(clock, Shift) else clock.sure):
                continue
            se = clock.own if isinstance(clock, Clock) else clock.se
            found[device] = {"offset": round(self.seconds(device), PLACES), "sd": round(se, PLACES)}
            if isinstance(clock, Clock) and _drifts(clock):
                found[device]["drift"] = float(f"{clock.drift:.3g}")
        shared = round(self.shared, PLACES)
        return ({self.reference: {"offset": 0.0, "sd": shared}} if found and shared else {}) | found


def _drifts(clock: Clock) -> bool:
    """Is a clock surely faster or slower than the reference's?"""
    return abs(clock.drift) > DRIFTS * clock.drift_se


def signals(run: Recorded) -> Iterator[Signal]:
    """Everything that the devices of a run measured, each on its own clock."""
    for draft in run.drafts:
        if draft.time is None:
            continue
        clock = draft.part.clock
        own = (draft.time - clock.offset) / (1 + clock.drift)
        device = draft.part.device
        for name, series in draft.values.items():
            if name not in draft.noise:
                yield Signal(device.name, name, own, series)
        for name, angle in draft.angles.items():  # every sample of it: a speed over spans has lost some of when it was
            middle, speed = rate(own, angle)
            yield Signal(device.name, name.replace("angle", "speed"), middle, (device.radius or 1.0) * speed)


def _beginning(signal: Signal) -> Signal:
    """As much of it as tells the clock of a file's pushes, which is the same all along."""
    early = signal.time <= signal.time[:1] + LONGEST
    return replace(signal, time=signal.time[early], values=signal.values[early])


SHOWN = ("wheel_speed_l", "wheel_speed_r", "u", "x", "yaw_rate", "a_x", "F_rl", "F_rr", "M_rl", "M_rr")  # the first there is


def alike(run: Recorded) -> tuple[str, dict[str, tuple[np.ndarray, np.ndarray]]]:
    """What to draw of a run's devices beside each other, and for each its times and values (n,) on its own clock, less their
    median and in units of their range: a speed, or what comes nearest to it."""
    by_device: dict[str, list[Signal]] = {}
    for signal in signals(run):
        by_device.setdefault(signal.device, []).append(signal)
    curves = {}
    for device, own in by_device.items():
        best = next((s for name in SHOWN for s in own if s.quantity == name and np.isfinite(s.values).sum() > 1), None)
        if best is not None:
            there = np.isfinite(best.values)
            time, values = best.time[there], best.values[there]
            if best.quantity in ("x", "y"):
                time, values = 0.5 * (time[1:] + time[:-1]), np.diff(values) / np.diff(time)
            low, middle, high = np.percentile(values, [1, 50, 99])
            curves[device] = (time, (values - middle) / ((high - low) or 1.0))
    return "speed or push", curves


def find(runs: tuple[Recorded, ...], aside: Mapping[str, Sequence[Signal]] = {}) -> list[RunClocks]:
    """The clocks of every run with several devices; and of runs of one file, whose pushes belong to another time than the
    readings beside them. `aside` is, by run, what devices recorded that the campaign does not use: it tells of clocks too."""
    found = []
    for run in (r for r in runs if len(r.drafts) > 1):
        reference = run.drafts[0].part.device.name
        seen = [*signals(run), *aside.get(run.name, ())]
        known = offsets(seen, reference=reference)
        others = {d: c for d, c in known.items() if d != reference}
        shared = known[reference].own if reference in known else 0.0
        middles = {s.device: float(np.mean(s.time)) for s in seen}
        found.append(RunClocks(run, reference, others, shared, middles))
    alone = {str(i): tuple(map(_beginning, signals(r))) for i, r in enumerate(runs) if len(r.drafts) == 1}
    for i, shift in odd_ones_out(alone).items():
        found.append(RunClocks(runs[int(i)], "readings", {PUSHES_CLOCK: shift}))
    return found


def write(doc: Document, found: list[RunClocks]) -> None:
    """Put what is sure into campaign.toml, which keeps its comments and layout. Raises OSError."""
    content: dict[str, Any] = {**doc.data, "run": [dict(entry) for entry in doc.data["run"]]}
    for one in found:
        if one.sure:
            entry = content["run"][one.run.entry.place]
            entry["clocks"] = {**entry.get("clocks", {}), **one.sure}
    with written(doc.path) as beside:
        beside.write_text(relaid(doc.raw.decode("utf-8-sig"), content), encoding="utf-8")
