"""The devices of a run on one clock, as far as what they saw alike tells it: for deciding what a column is by another's."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..clocks import Signal, offsets
from ..clocks.smoothing import smooth
from .gathering import Series

MOST = 6  # runs that are looked at
STEP = 0.02  # s
DECIDES = 0.5  # correlation from which a sign is told
Told = dict[tuple[str, str], Series]  # by device and quantity


@dataclass(frozen=True)
class Fit:
    """How one signal follows from another over all runs: value = gain · other, and the correlation with the gain's sign."""

    gain: float
    correlation: float

    @property
    def plain(self) -> bool:
        return abs(self.correlation) >= DECIDES

    @property
    def sign(self) -> float:
        return float(np.sign(self.correlation)) or 1.0

    @property
    def words(self) -> str:
        return f"correlation {abs(self.correlation):.2f}"


@dataclass(frozen=True, eq=False)
class Together:
    """Signals of some runs by device and quantity, and the sure offset (s) of each device's clock."""

    told: Mapping[str, Told]
    offsets: Mapping[str, Mapping[str, float]]

    def at(self, run: str, device: str, series: Series, order: int = 0) -> Series | None:
        """A series smoothed on the common clock's grid (differentiated with `order` 1); None where the clock is not sure."""
        if device not in self.offsets.get(run, {}):
            return None
        s = smooth(series[0] + self.offsets[run][device], series[1])
        if not len(s.value):
            return None
        grid = STEP * np.arange(np.ceil(s.time[0] / STEP), np.floor(s.time[-1] / STEP))
        return grid, s.at(grid)[order]

    def fit(self, one: Callable[[str], Series | None], other: Callable[[str], Series | None]) -> Fit | None:
        """One signal against another, given as their series on the common grid in each run; None where they share too little.
        What each shows on the middle of a run is taken out."""
        xs, ys = [], []
        for run in self.told:
            a, b = one(run), other(run)
            if a is None or b is None:
                continue
            places, of_a, of_b = np.intersect1d(np.round(a[0] / STEP), np.round(b[0] / STEP), return_indices=True)
            x, y = b[1][of_b], a[1][of_a]
            good = np.isfinite(x) & np.isfinite(y)
            if len(places) and good.sum() > 50:
                xs.append(x[good] - np.median(x[good]))
                ys.append(y[good] - np.median(y[good]))
        if not xs:
            return None
        x, y = np.concatenate(xs), np.concatenate(ys)
        xy, xx, yy = float(x @ y), float(x @ x), float(y @ y)
        return Fit(xy / xx, xy / np.sqrt(xx * yy)) if xx > 0 and yy > 0 else None

    def difference(self, run: str, left: tuple[str, str], right: tuple[str, str]) -> Series | None:
        """Of two signals on the common grid."""
        found = [self.told[run].get(key) for key in (left, right)]
        if found[0] is None or found[1] is None:
            return None
        a, b = self.at(run, left[0], found[0]), self.at(run, right[0], found[1])
        if a is None or b is None:
            return None
        grid, of_a, of_b = np.intersect1d(np.round(a[0] / STEP), np.round(b[0] / STEP), return_indices=True)
        return (STEP * grid, a[1][of_a] - b[1][of_b]) if len(grid) else None

    def speed(self, run: str, order: int = 0) -> Series | None:
        """The chair's speed, or its rate of change: the mean of both wheels, else one wheel, else along the markers' way."""
        for side in ("l", "r"):
            of = [(key, s) for key, s in self.told[run].items() if key[1] == f"wheel_speed_{side}"]
            other = "r" if side == "l" else "l"
            more = [(key, s) for key, s in self.told[run].items() if key[1] == f"wheel_speed_{other}"]
            if of:
                one = self.at(run, of[0][0][0], of[0][1], order)
                two = self.at(run, more[0][0][0], more[0][1], order) if more else None
                if one is not None and two is not None:
                    grid, a, b = np.intersect1d(np.round(one[0] / STEP), np.round(two[0] / STEP), return_indices=True)
                    return STEP * grid, 0.5 * (one[1][a] + two[1][b])
                if one is not None:
                    return one
        return None


def together(told: Mapping[str, Told]) -> Together:
    """Clocks of the runs that most devices recorded, some of them spread over all."""
    most = max((len({device for device, _ in of}) for of in told.values()), default=0)
    full = [run for run, of in told.items() if len({device for device, _ in of}) == most]
    chosen = [full[int(i)] for i in np.unique(np.linspace(0, len(full) - 1, min(MOST, len(full))).round())] if full else []
    return Together({run: told[run] for run in chosen}, {run: _sure(told[run]) for run in chosen})


def _sure(told: Told) -> dict[str, float]:
    signals = [Signal(device, quantity, *series) for (device, quantity), series in told.items()]
    devices = list(dict.fromkeys(s.device for s in signals))
    if not devices:
        return {}
    found = offsets(signals, reference=devices[0])
    return {devices[0]: 0.0} | {name: clock.offset for name, clock in found.items() if clock.sure}


def spread(runs: Sequence[str]) -> list[str]:
    """Some of many, from the first to the last."""
    return [runs[int(i)] for i in np.unique(np.linspace(0, len(runs) - 1, min(MOST, len(runs))).round())] if runs else []
