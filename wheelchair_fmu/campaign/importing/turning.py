"""What a sensor tells about itself: whether it turns with a wheel or stands on the frame, which way is up, and which way is
forward for a wheel that mostly rolls forward."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from .gathering import Column, Series, Source

AXES = "xyz"
TURNS = 1.2  # g between low and high readings of an axis through which gravity turns (2 when it turns all round)
STEADY = 0.8  # g at least on an axis that points up,
WANDERS = 0.7  # g at most between its low and high readings
PLAIN = 0.2  # share of all travel by which one way must prevail


@dataclass(frozen=True)
class Lean:
    """Which way prevails: `sign`, and its `share` from 0 (neither) to 1 (only this)."""

    sign: float
    share: float

    @property
    def plain(self) -> bool:
        return self.share >= PLAIN


def axes(source: Source, quantity: str) -> dict[str, Column]:
    """The columns of a sensor of three axes, by axis."""
    return {c.guess.axis: c for c in source.of(quantity) if c.guess and c.guess.axis}


def on_spokes(source: Source) -> str:
    """The axis along the axle of a sensor that turns with a wheel: gravity turns through both others. "" for any other."""
    spans = {axis: _span(source, column) for axis, column in axes(source, "acc").items()}
    g = gravity(source)
    turning = [axis for axis, (low, high) in spans.items() if g and high - low > TURNS * g]
    gyros = axes(source, "gyro")
    still = [axis for axis in gyros if axis not in turning]
    if len(turning) == 2 and len(still) == 1:
        return still[0]
    if not spans and source.side and gyros:  # a gyroscope alone, named after a side: it is on that wheel
        return max(gyros, key=lambda axis: travel(_all(source, gyros[axis]))[1])
    return ""


def upright(source: Source) -> tuple[str, float] | None:
    """The axis on which gravity stands, and whether it points up (+1) or down. An accelerometer at rest reads +1 g upwards."""
    g = gravity(source)
    for axis, column in axes(source, "acc").items():
        low, high = _span(source, column)
        middle = 0.5 * (low + high)
        if g and abs(middle) > STEADY * g and high - low < WANDERS * g:
            return axis, float(np.sign(middle))
    return None


def gravity(source: Source) -> float:
    """The size of gravity in the numbers of an accelerometer of three axes; 0 where it has fewer."""
    columns = axes(source, "acc")
    if len(columns) < 3:
        return 0.0
    norms = []
    for run in source.files:
        found = [source.series(run, columns[axis]) for axis in AXES]
        if all(one is not None for one in found):
            norms.append(np.nanmedian(np.sqrt(sum(one[1] ** 2 for one in found if one is not None))))
    return float(np.median(norms)) if norms else 0.0


def travel(series: Iterable[Series]) -> tuple[float, float]:
    """How far a speed goes on the whole, forward less back, and both together, after what it shows at rest is taken out."""
    net = whole = 0.0
    for time, speed in series:
        good = np.isfinite(speed)
        steps = np.gradient(time[good]) * (speed[good] - _rest(speed[good]))
        net, whole = net + float(steps.sum()), whole + float(np.abs(steps).sum())
    return net, whole


def forward(series: Iterable[Series]) -> Lean:
    """Which way a wheel mostly rolls."""
    net, whole = travel(series)
    return Lean(float(np.sign(net)) or 1.0, abs(net) / whole if whole else 0.0)


def pushing(series: Iterable[Series]) -> Lean:
    """Which way hands push: they push forward more than they brake, and what a rim shows without hands is in the middle."""
    net = whole = 0.0
    for _, push in series:
        good = push[np.isfinite(push)]
        off = good - np.median(_quietest(good))
        off[np.abs(off) < 0.2 * np.max(np.abs(off), initial=0.0)] = 0.0
        net, whole = net + float(off.sum()), whole + float(np.abs(off).sum())
    return Lean(float(np.sign(net)) or 1.0, abs(net) / whole if whole else 0.0)


def _quietest(values: np.ndarray, parts: int = 40) -> np.ndarray:
    """The parts of a record that change least, a fifth of it."""
    if len(values) < 4 * parts:
        return values
    blocks = values[: len(values) // parts * parts].reshape(parts, -1)
    return np.asarray(blocks[np.argsort(blocks.std(axis=1))[: parts // 5]].ravel())


def _rest(speed: np.ndarray) -> float:
    """What a gyroscope shows at rest: the middle of the quietest fifth, where that is near zero."""
    quiet = float(np.median(_quietest(speed)))
    return quiet if abs(quiet) < 0.05 * float(np.max(np.abs(speed), initial=0.0)) else 0.0


def _all(source: Source, column: Column) -> Sequence[Series]:
    return [one for run in source.files if (one := source.series(run, column)) is not None]


def _span(source: Source, column: Column) -> tuple[float, float]:
    found = [one[1] for one in _all(source, column)]
    if not found:
        return 0.0, 0.0
    low, high = np.nanpercentile(np.concatenate(found), [5, 95])
    return float(low), float(high)
