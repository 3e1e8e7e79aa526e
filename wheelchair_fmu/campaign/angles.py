"""Wheel angles as encoders give them, wrapped at each turn, and the wheel's speed from them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .series import estimate

_FAR = 0.02  # turns by which a reading must be off both neighbours to be a glitch,
_TIMES = 4.0  # and times what these differ from each other
_DIFFERENCES = np.sqrt(2.0)  # sd of a difference of two readings, in units of the sd of one


@dataclass(frozen=True)
class WheelSpeed:
    """Speed of a rim from its angle: differences of neighbours, at the times between them.

    `time` and `speed` are (n - 1,), in s and m/s, with NaN where a reading is missing. `sd` is that of the noise in `speed`,
    by the encoder's step and by what the readings scatter, whichever is larger. Each reading is in two differences, with
    opposite signs: the noise is a moving average of order one whose neighbours correlate by `correlation`, and the sum of the
    speeds over a time is no worse than two readings of the angle. `glitches` are the places of readings left out.
    """

    time: np.ndarray
    speed: np.ndarray
    sd: float
    glitches: np.ndarray
    correlation: float = -0.5


def unwrapped(angle: np.ndarray, turn: float) -> np.ndarray:
    """An angle (n,) without its jumps by a `turn` (360 or 2 pi), gaps (NaN) left as they are; within ±180 or 0 to 360 alike.

    From one reading to the next, also across a gap, the wheel is taken to have turned by less than half a turn.
    """
    result = np.array(angle, dtype=float)
    finite = np.flatnonzero(np.isfinite(result))
    result[finite] = np.unwrap(result[finite], period=turn)
    return result


def glitches(angle: np.ndarray, turn: float) -> np.ndarray:
    """Places of single readings far from both neighbours, which agree: the index of an encoder spoils one reading each turn."""
    finite = np.flatnonzero(np.isfinite(angle))
    if finite.size < 3:
        return finite[:0]
    values = np.asarray(angle, dtype=float)[finite]
    before, after = _short(np.diff(values)[:-1], turn), _short(np.diff(values)[1:], turn)
    across = np.abs(_short(values[2:] - values[:-2], turn))
    off = np.minimum(np.abs(before), np.abs(after))
    return finite[1:-1][(off > _FAR * turn) & (off > _TIMES * across)]


def wheel_speed(time: np.ndarray, angle: np.ndarray, turn: float, radius: float) -> WheelSpeed:
    """Speed at the rim from a wrapped wheel angle. `time` in s and `angle` are (n,); `radius` in m; a `turn` is 360 or 2 pi.

    The sign is the angle's: where it falls as the chair rolls forward, give -angle.
    """
    bad = glitches(angle, turn)
    clean = np.array(angle, dtype=float)
    clean[bad] = np.nan
    scale = 2 * np.pi / turn * radius
    way = unwrapped(clean, turn) * scale
    steps = np.diff(time)
    usual = float(np.median(steps[steps > 0])) if (steps > 0).any() else np.nan
    with np.errstate(divide="ignore", invalid="ignore"):
        speed = np.where(steps > 0, np.diff(way) / steps, np.nan)
    return WheelSpeed(time[:-1] + steps / 2, speed, _DIFFERENCES * _reading_sd(clean, way, scale) / usual, bad)


def _short(steps: np.ndarray, turn: float) -> np.ndarray:
    """The same steps the short way round."""
    return (steps + turn / 2) % turn - turn / 2


def _reading_sd(angle: np.ndarray, way: np.ndarray, scale: float) -> float:
    """Standard deviation of one reading, in m: the encoder's step / sqrt(12), or what third differences scatter."""
    values = np.unique(angle[np.isfinite(angle)])
    step = float(np.diff(values).min()) * scale if values.size > 1 else 0.0
    return max(step / np.sqrt(12.0), estimate([way]) or 0.0)
