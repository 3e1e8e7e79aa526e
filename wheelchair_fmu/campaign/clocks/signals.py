"""What a device measured, as features that can be set beside another device's."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from .smoothing import NODES, WIDTH, Smooth, smooth

LEFT, RIGHT, MEAN, ALONG, TURN, FORWARD = "left wheel", "right wheel", "mean of the wheels", "speed", "yaw rate", "a_x"
PUSH_L, PUSH_R = "left push", "right push"
APART, TURN2 = "difference of the wheels", "square of the yaw rate"
SWAY, SWAYING = "body behind the pushes", "speed of the body behind the pushes"
BODY, DAMPING = 2 * np.pi * 1.25, 0.4  # rad/s and 1: how a trunk swings on a chair that is pushed, about
NAMES = {
    "wheel_speed_l": LEFT,
    "wheel_speed_r": RIGHT,
    "u": ALONG,
    "yaw_rate": TURN,
    "a_x": FORWARD,
    "F_rl": PUSH_L,
    "F_rr": PUSH_R,
    "M_rl": PUSH_L,
    "M_rr": PUSH_R,
}

SLOWEST = 2.0  # sampling intervals in the Gaussian's width, at least

Series = tuple[np.ndarray, np.ndarray]  # times and values


@dataclass(frozen=True, eq=False)
class Signal:
    """One quantity as one device recorded it: `quantity` is a channel's or push's name (`wheel_speed_l`, `M_rr`, ...), `time`
    (n,) in s on the device's own clock, rising, `values` (n,) in SI and SAE J670 axes with NaN in gaps; `sd` is one standard
    deviation of its noise where somebody knows it."""

    device: str
    quantity: str
    time: np.ndarray
    values: np.ndarray
    sd: float | None = None


@dataclass(frozen=True, eq=False)
class Device:
    """All signals of one clock, and what follows from them: speed from positions, yaw rate from the heading."""

    name: str
    features: Mapping[str, Series]
    width: float = WIDTH

    @cached_property
    def _grid(self) -> tuple[int, int]:
        step = self.width / NODES
        ends = [t[np.isfinite(y)][[0, -1]] for t, y in self.features.values()]
        return int(np.floor(min(e[0] for e in ends) / step)), int(np.ceil(max(e[1] for e in ends) / step)) + 1

    @cached_property
    def _known(self) -> dict[tuple[str, int], Smooth]:
        return {}

    def smooth(self, feature: str, order: int = 0) -> Smooth:
        """A feature, or with `order` 1 its rate of change, on this device's grid."""
        key = feature, order
        if key not in self._known:
            time, values = self._series(feature)
            for _ in range(order):
                time, values = rate(time, values)
            self._known[key] = self._fitted(smooth(time, values, self.width))
        return self._known[key]

    def _series(self, feature: str) -> Series:
        if feature in (MEAN, APART):
            (t, left), (tr, right) = self.features[LEFT], self.features[RIGHT]
            right = _on(t, tr, right)
            return t, 0.5 * (left + right) if feature == MEAN else left - right
        if feature == TURN2:
            s = self.smooth(TURN)
            return s.time, s.value**2
        if feature in (SWAY, SWAYING):
            return self._body(feature == SWAYING)
        return self.features[feature]

    def _body(self, speed: bool) -> Series:
        """How far (or how fast) a mass on a spring and a damper stays behind when pushed by the sum of the pushes."""
        pushes = [self.smooth(p) for p in (PUSH_L, PUSH_R) if p in self.features]
        total = np.nan_to_num(np.sum([p.value for p in pushes], axis=0))
        system = ([1.0, 0.0] if speed else [1.0], [1.0, 2 * DAMPING * BODY, BODY**2])
        start = float(np.median(total[:NODES]))
        return self.grid, scipy.signal.lsim(system, total - start, self.width / NODES * np.arange(len(total)))[1]

    def _fitted(self, s: Smooth) -> Smooth:
        first, end = self._grid
        value, slope = np.full((2, end - first), np.nan)
        at = round(s.start / s.step) - first
        room = slice(max(at, 0), min(at + len(s.value), end - first))
        there = slice(room.start - at, room.stop - at)
        value[room], slope[room] = s.value[there], s.slope[there]
        return Smooth(first * s.step, s.step, value, slope)

    @property
    def grid(self) -> np.ndarray:
        first, end = self._grid
        return self.width / NODES * np.arange(first, end)

    def has(self, *features: str) -> bool:
        wanted = [f for name in features for f in ((LEFT, RIGHT) if name in (MEAN, APART) else (name,))]
        return all(f in self.features for f in wanted)


def devices(signals: Iterable[Signal], width: float | None = None) -> dict[str, Device]:
    """The devices by name, in the order of their first signal. By default all are smoothed alike, so that the slowest
    of them resolves it."""
    by_device: dict[str, dict[str, Series]] = {}
    for s in signals:
        by_device.setdefault(s.device, {})[s.quantity] = (np.asarray(s.time, float), np.asarray(s.values, float))
    found = {name: features(of) for name, of in by_device.items()}
    intervals = [float(np.median(np.diff(t))) for of in found.values() for t, _ in of.values() if len(t) > 2]
    chosen = width or band(max(intervals, default=0.0))
    return {name: Device(name, of, chosen) for name, of in found.items()}


def band(interval: float) -> float:
    """Width (s) of the Gaussian for signals of which the slowest is sampled at this interval (s)."""
    return max(WIDTH, SLOWEST * interval)


def features(series: Mapping[str, Series]) -> dict[str, Series]:
    """What can be compared, from series by quantity."""
    found = {NAMES[q]: s for q, s in series.items() if q in NAMES and _alive(s)}
    if "yaw" in series and TURN not in found:
        time, yaw = series["yaw"]
        good = np.isfinite(yaw)
        unwrapped = np.full(len(yaw), np.nan)
        unwrapped[good] = np.unwrap(yaw[good])
        found[TURN] = rate(time, unwrapped)
    if "x" in series and "y" in series and ALONG not in found:
        found[ALONG] = _along(series)
    return {name: s for name, s in found.items() if _alive(s)}


def rate(time: np.ndarray, values: np.ndarray) -> Series:
    """Rate of change (n − 1,) at the middles between samples; smoothing it afterwards is the same as differentiating what is
    smoothed."""
    step = np.diff(time)
    return 0.5 * (time[1:] + time[:-1]), np.diff(values) / np.where(step > 0, step, np.nan)


def _along(series: Mapping[str, Series]) -> Series:
    """Speed of a point along the heading, or where none was recorded along its path (which knows no backwards)."""
    time, vx = rate(*series["x"])
    ty, vy = rate(*series["y"])
    vy = vy if np.array_equal(time, ty) else np.interp(time, ty, vy)
    if "yaw" in series:
        t, yaw = series["yaw"]
        psi = np.interp(time, t, yaw)
        return time, vx * np.cos(psi) + vy * np.sin(psi)
    return time, np.hypot(smooth_at(time, vx), smooth_at(time, vy))


def _on(time: np.ndarray, other: np.ndarray, values: np.ndarray) -> np.ndarray:
    return values if np.array_equal(time, other) else np.interp(time, other, values, left=np.nan, right=np.nan)


def smooth_at(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    return smooth(time, values).at(time)[0]


def _alive(s: Series) -> bool:
    good = s[1][np.isfinite(s[1])]
    return good.size > 3 and bool(good.min() < good.max())
