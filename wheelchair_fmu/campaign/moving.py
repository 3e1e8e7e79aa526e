"""The parts of a campaign's runs in which the chair rolls.

About rest a chair holds on to the floor as long as it can and then lets go, so that a force too small to move it does nothing
and one a little larger much: no slope tells what a force does that nobody recorded. Where such forces are asked for, runs begin
when the chair rolls and end when it stands.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from .records import Campaign, Run
from .series import integral
from .windows import between, part

ROLLS, STANDS = 0.2, 0.1  # m/s: a chair rolls from the former on until it is slower than the latter
STILL = 0.05  # m/s: one that is slower stands, but for its sensors' noise
WALK = 1.0  # m/s
SMOOTH = 0.1  # s over which a speed is taken
APART = 0.5  # s between places that tell one: a marker's 2 mm are then 6 mm/s
LEAST = 2.0  # s: what rolls for less is left out
SPEEDS = ("wheel_speed_l", "wheel_speed_r", "u")


def moving(campaign: Campaign) -> Campaign:
    """The campaign with each run cut to where its chair rolls, in several where it stood in between; a run that tells no speed,
    or that never rolls for long, stays whole."""
    return replace(campaign, runs=tuple(part for run in campaign.runs for part in _parts(run)))


def pace(run: Run) -> np.ndarray:
    """Speed (n,) in m/s at which a run's chair rolls, by its wheels or else by its places, at least as fast as one that is
    about to stand; of one that tells neither, a usual walk's."""
    speed = _speed(run)
    if speed is None:
        speed = _between_places(run)
    return np.full(len(run.time), WALK) if speed is None else np.maximum(speed, STANDS)


def smooth(run: Run, channel: str) -> np.ndarray | None:
    """A channel at all times of a run (n,), as means over SMOOTH; None where it has no two readings."""
    readings = run.channels.get(channel, np.empty(0))
    good = np.isfinite(readings)
    return _means(run.time, run.time[good], readings[good]) if good.sum() > 1 else None


def sets_off(campaign: Campaign) -> bool:
    """Does some run have the chair stand, and roll after that?"""
    return any(_sets_off(speed) for speed in map(_speed, campaign.runs) if speed is not None)


def _sets_off(speed: np.ndarray) -> bool:
    still = np.flatnonzero(speed < STILL)
    return bool(still.size and speed[still[0] :].max() > ROLLS)


def _parts(run: Run) -> list[Run]:
    speed = _speed(run)
    if speed is None:
        return [run]
    whole = [(a, b) for a, b in _stretches(run.time, speed) if b - a >= LEAST]
    if not whole or whole == [(run.time[0], run.time[-1])]:
        return [run]
    found = [between(run, *whole[0])] if len(whole) == 1 else [part(run, *ends) for ends in whole]
    return [replace(piece, way=_way(run.time, speed, piece.time[0])) for piece in found]


def _way(time: np.ndarray, speed: np.ndarray, until: float) -> float | None:
    """How far (m) the chair has rolled since it last stood; None where it did not stand before."""
    before = int(np.searchsorted(time, until)) + 1
    still = np.flatnonzero(speed[:before] < STILL)
    return float(np.trapezoid(speed[still[-1] : before], time[still[-1] : before])) if still.size else None


def _speed(run: Run) -> np.ndarray | None:
    """That of the faster wheel (n,), or of the chair, at all times."""
    found = [np.abs(read) for name in SPEEDS if (read := smooth(run, name)) is not None]
    return np.max(found, axis=0) if found else None


def _between_places(run: Run) -> np.ndarray | None:
    """The chair's speed (n,) by how far apart it is a moment before and after each time."""
    if not {"x", "y"} <= set(run.channels):
        return None
    x, y = run.channels["x"], run.channels["y"]
    good = np.isfinite(x) & np.isfinite(y)
    if good.sum() < 2:
        return None
    time = run.time[good]
    ends = [np.clip(run.time + side * APART / 2, time[0], time[-1]) for side in (-1, 1)]
    took, *way = (np.subtract(*(_means(end, time, c) for end in reversed(ends))) for c in (time, x[good], y[good]))
    return np.divide(np.hypot(*way), took, out=np.zeros_like(took), where=took > 0)


def _means(at: np.ndarray, time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Means (n,) over SMOOTH about each time of a series of its own times."""
    ends = [np.clip(at + side * SMOOTH / 2, time[0], time[-1]) for side in (-1, 1)]
    wide = ends[1] - ends[0]
    first, last = (integral(time, values, end) for end in ends)
    return np.where(wide > 0, (last - first) / np.where(wide > 0, wide, 1.0), np.interp(at, time, values))


def _stretches(time: np.ndarray, speed: np.ndarray) -> Iterator[tuple[float, float]]:
    """From when to when the chair rolls."""
    begun: float | None = None
    for t, v in zip(time, speed, strict=True):
        if begun is None and v > ROLLS:
            begun = float(t)
        elif begun is not None and v < STANDS:
            yield begun, float(t)
            begun = None
    if begun is not None:
        yield begun, float(time[-1])
