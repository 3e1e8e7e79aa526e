"""Wheel angles as encoders give them, wrapped at each turn, and the wheel's speed from them."""

from __future__ import annotations

import numpy as np

from .series import scatter, third_differences

SPAN = 0.05  # s over which a wheel's speed is taken from its angle: shorter is noise, longer loses the yaw motion
TURN = 2 * np.pi
_FAR = 0.02  # turns by which a reading must be off both neighbours to be a glitch,
_TIMES = 4.0  # and times what these differ from each other


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


def cleaned(angle: np.ndarray, turn: float = TURN) -> tuple[np.ndarray, np.ndarray]:
    """An angle (n,) unwrapped and without its glitches, and the places of these."""
    bad = glitches(angle, turn)
    rest = np.array(angle, dtype=float)
    rest[bad] = np.nan
    return unwrapped(rest, turn), bad


def wheel_speed(time: np.ndarray, angle: np.ndarray, radius: float) -> tuple[np.ndarray, float]:
    """Speed (n,) of a wheel's rim of contact from its unwrapped angle (n,), NaN between the spans it is taken over, and the
    standard deviation of its noise.

    Over a span it is the mean speed, and stands at the middle. Spans do not overlap, so that the noise of one hardly tells that
    of another. `radius` in m; the sign is the angle's.
    """
    speed = np.full(len(time), np.nan)
    if len(time) < 3:
        return speed, 0.0
    step = float(np.median(np.diff(time)))
    half = max(1, round(SPAN / (2 * step)))
    middle = np.arange(half, len(time) - half, 2 * half)
    span = time[middle + half] - time[middle - half]
    speed[middle] = radius * (angle[middle + half] - angle[middle - half]) / span
    noise = scatter(third_differences(angle))
    return speed, radius * np.sqrt(2) * (noise or 0.0) / (2 * half * step)


def _short(steps: np.ndarray, turn: float) -> np.ndarray:
    """The same steps the short way round."""
    return (steps + turn / 2) % turn - turn / 2
