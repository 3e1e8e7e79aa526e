"""Wheels under each other's name. In a turn the outer wheel goes farther, and an accelerometer feels which way it is pushed.

The instruments of two wheels mirror each other as a rule: exchanged, they turn the chair rightly, but backwards.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ...faults import WARNING, Fault, run_fault
from ..channels import SIDES
from ..clocks.smoothing import WIDTH, Smooth, smooth
from ..document import FILE
from ..recorded import Recorded

PLAIN = 0.5  # correlation from which a sign is told,
CLOSE = 0.9  # and from which a factor is,
FACTOR = 3.0  # where it is beyond what chairs have by so much
LONGEST = 300.0  # s of a run that are looked at
STEP = 0.02  # s
FEWEST = 50  # steps


@dataclass(frozen=True)
class Law:
    """What two wheels (left, right) say of one `channel`: `of_wheels` is so many times `of_channel` as lies `between` two
    numbers. `odd` is what it looks like where the sign is the other one, `cure` what helps where it is so in every run."""

    channel: str
    of_wheels: Callable[[Smooth, Smooth, np.ndarray], np.ndarray]
    of_channel: Callable[[Smooth, np.ndarray], np.ndarray]
    between: tuple[float, float]
    odd: str
    cure: str


@dataclass(frozen=True)
class Told:
    """A correlation of wheels and a channel, and how many times too small the channel is; 1.0 where it may be right."""

    correlation: float
    factor: float


def _difference(left: Smooth, right: Smooth, at: np.ndarray) -> np.ndarray:
    return left.at(at)[0] - right.at(at)[0]


def _gain(left: Smooth, right: Smooth, at: np.ndarray) -> np.ndarray:
    return 0.5 * (left.at(at)[1] + right.at(at)[1])


def _value(s: Smooth, at: np.ndarray) -> np.ndarray:
    return s.at(at)[0]


def _slope(s: Smooth, at: np.ndarray) -> np.ndarray:
    return s.at(at)[1]


TRACK = (0.3, 1.0)  # m between the rear wheels of chairs
TURNED = "the wheels' speeds differ against the chair's turning"
EXCHANGED = "exchange left and right, or correct axes or the sign of {}"
HERE = "exchange the {} of left and right in this run, or correct the sign of {} in it"
LAWS = (
    Law("yaw_rate", _difference, _value, TRACK, TURNED, EXCHANGED),
    Law("yaw", _difference, _slope, TRACK, TURNED, EXCHANGED),
    Law("a_x", _gain, _value, (0.5, 2.0), "the wheels gain speed where a_x has the chair lose it", "correct the sign of {}"),
)
FACTORS = {
    180 / np.pi: "as if rad were called deg",
    np.pi / 180: "as if deg were called rad",
    9.80665: "as if g were called m/s2",
}
FACTORS |= {1 / 9.80665: "as if m/s2 were called g"}


def exchanged(runs: Sequence[Recorded]) -> list[Fault]:
    """A warning for each run in which left and right wheel seem to be exchanged, or a channel is in another unit than it says;
    one for all together, where all are so."""
    faults: list[Fault] = []
    for law in LAWS:
        told = [(run, found) for run in runs if (found := _told(run, law)) is not None]
        faults += _of_another_size([(run, found.factor) for run, found in told], law)
        signed = [(run, found.correlation) for run, found in told if found.factor == 1.0 and abs(found.correlation) > PLAIN]
        wrong = [(run, found) for run, found in signed if found < 0]
        if wrong and len(wrong) == len(signed):
            fact = f"{law.odd}, in every run that tells (correlation {min(found for _, found in wrong):.2f})"
            faults.append(Fault(FILE, None, None, fact, law.cure.format(law.channel), WARNING))
        else:
            faults += _in_some(wrong, law, {fault.file for fault in faults})
    return faults


def _in_some(wrong: Sequence[tuple[Recorded, float]], law: Law, said: set[str]) -> Iterator[Fault]:
    """A sentence for each run that nothing was said of."""
    for run, found in wrong:
        if run.file not in said:
            cure = HERE.format("columns" if len(run.drafts) == 1 else "files", law.channel)
            yield run_fault(run.file, f"{law.odd} (correlation {found:.2f}), unlike in other runs", cure, severity=WARNING)


def _of_another_size(told: Sequence[tuple[Recorded, float]], law: Law) -> Iterator[Fault]:
    wrong = [(run, factor) for run, factor in told if factor != 1.0]
    cure = f"correct the unit of {law.channel}, or of the wheels"
    if len(wrong) > 1 and len(wrong) == len(told):
        factor = float(np.median([factor for _, factor in wrong]))
        yield Fault(FILE, None, None, f"{_size(law, factor)}, in every run that tells", cure, WARNING)
        return
    for run, factor in wrong:
        yield run_fault(run.file, _size(law, factor), cure, severity=WARNING)


def _size(law: Law, factor: float) -> str:
    known = next((f" ({words})" for at, words in FACTORS.items() if 1 / FACTOR < factor / at < FACTOR), "")
    much = f"{factor:.2g} times too small" if factor > 1 else f"{1 / factor:.2g} times too large"
    return f"{law.channel} goes with the wheels, but is about {much}{known}"


def _told(run: Recorded, law: Law) -> Told | None:
    """What the wheels say of the channel; None where nothing tells it, or the two do not fit one another."""
    needed = (*SIDES, law.channel)
    if not set(needed) <= run.channels.keys() or (grid := looked_at(run, needed)) is None:
        return None
    left, right, other = (smoothed(run, name) for name in needed)
    x, y = law.of_wheels(left, right, grid), law.of_channel(other, grid)
    there = np.isfinite(x) & np.isfinite(y)
    if there.sum() < FEWEST:
        return None
    x, y = x[there] - np.median(x[there]), y[there] - np.median(y[there])
    xy, xx, yy = float(x @ y), float(x @ x), float(y @ y)
    if xx <= 0 or yy <= 0:
        return None
    correlation, slope, (least, most) = xy / np.sqrt(xx * yy), abs(xy) / yy, law.between
    if least < slope < most:
        return Told(correlation, 1.0)
    off = slope > FACTOR * most or slope < least / FACTOR
    return Told(correlation, slope / np.sqrt(least * most)) if off and abs(correlation) > CLOSE else None


def looked_at(run: Recorded, names: Sequence[str]) -> np.ndarray | None:
    """Times (n,) of a run's beginning at which these may be compared; None where its time or their clocks are not sure."""
    if run.time is None or len(run.time) < FEWEST or not _on_one_clock(run, names):
        return None
    if (np.diff(run.time) <= 0).any():
        return None  # which has its own sentence
    return np.arange(run.time[0], run.time[_beginning(run.time)][-1], STEP)


def smoothed(run: Recorded, name: str, width: float = WIDTH) -> Smooth:
    """A channel or a push in a run's beginning."""
    assert run.time is not None
    first = _beginning(run.time)
    return smooth(run.time[first], run.values[name][first], width)


def _beginning(time: np.ndarray) -> np.ndarray:
    return np.asarray(time <= time[0] + LONGEST)


def _on_one_clock(run: Recorded, names: Sequence[str]) -> bool:
    """Are the clocks known of all devices that tell these? Turns to and fro look turned round where one is half a turn late."""
    telling = {draft.file: draft for draft in (run.draft_of(name) for name in names) if draft is not None}
    return len(telling) == 1 or all(map(run.knows_clock_of, telling.values()))
