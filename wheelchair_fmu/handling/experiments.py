"""Runs that a person could make next, to tell apart what a campaign could not."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

INTERVAL = 0.01  # s
HOLDING = 6.0  # N at each wheel, about what keeps a chair going
TRACKING = {"x": 0.003, "y": 0.003, "yaw": 0.004}  # standard deviations of a camera system, SI units
Push = Callable[[np.ndarray], np.ndarray | float]  # N at these times


@dataclass(frozen=True, eq=False)
class Experiment:
    """One run: `words` for the person; inputs (n,) by FMI name, start speed and heading, what is set, extra sensors."""

    words: str
    time: np.ndarray
    inputs: Mapping[str, np.ndarray]
    speed: float
    heading: float = 0.0
    set: Mapping[str, float] = field(default_factory=dict)
    more: Mapping[str, float] = field(default_factory=dict)  # extra on top of what is known, e.g. chair.m + 20 kg
    sensors: Mapping[str, float] = field(default_factory=dict)


def _run(words: str, left: Push, right: Push, seconds: float = 15.0, speed: float = 1.0, **other: Any) -> Experiment:
    t = np.arange(0.0, seconds + INTERVAL / 2, INTERVAL)
    pushes = {"push.F_rl": left(t) + 0 * t, "push.F_rr": right(t) + 0 * t}
    return Experiment(words, t, pushes, speed, **other)


def _wave(size: float, period: float, sign: float) -> Push:
    return lambda t: HOLDING + sign * size * np.sin(2 * np.pi * t / period)


def _strokes(t: np.ndarray) -> np.ndarray:
    return 45.0 * np.maximum(np.sin(2 * np.pi * t / 1.1), 0) ** 2


def _sprint(t: np.ndarray) -> np.ndarray:
    return np.where(t < 6.0, _strokes(t), 0.0)


def _none(t: np.ndarray) -> np.ndarray:
    return 0 * t


def experiments() -> tuple[Experiment, ...]:
    """What can be run with a chair, its instruments and an empty hall, the simplest first."""
    slalom = (_wave(8.0, 4.0, 1), _wave(8.0, 4.0, -1))
    return (
        _run("a coast-down from 1 m/s", _none, _none, speed=1.0),
        _run("a coast-down from 2.5 m/s", _none, _none, 20.0, speed=2.5),
        _run("a coast-down from 1 m/s the other way along the hall", _none, _none, speed=1.0, heading=np.pi),
        _run("hard strokes straight ahead to about 3 m/s, then hands off", _sprint, _sprint, 20.0, speed=0.5),
        _run("strokes straight ahead", _strokes, _strokes, 12.0, speed=0.5),
        _run("a circle to the right at about 1 m/s", lambda t: HOLDING + 8, lambda t: HOLDING - 8),
        _run("a circle to the left at about 1 m/s", lambda t: HOLDING - 8, lambda t: HOLDING + 8),
        _run("a slalom with a period of 4 s", *slalom),
        _run("a quick slalom with a period of 1.5 s", _wave(12.0, 1.5, 1), _wave(12.0, 1.5, -1), speed=1.2),
        _run("a spin on the spot, right then left", _wave(18.0, 10.0, 1), _wave(18.0, 10.0, -1), 10.0, speed=0.05),
        _run("a slalom with 20 kg added at the seat", *slalom, more={"chair.m": 20.0}),
        _run("a coast-down from 1 m/s with 20 kg added at the seat", _none, _none, speed=1.0, more={"chair.m": 20.0}),
        _run("a slalom with the tyres at 2 bar", *slalom, set={"tyre.pressure": 2.0}),
        _run("a slalom tracked by cameras", *slalom, sensors=TRACKING),
        _run("a coast-down from 1 m/s tracked by cameras", _none, _none, speed=1.0, sensors=TRACKING),
    )
