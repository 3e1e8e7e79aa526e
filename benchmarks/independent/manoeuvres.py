"""Manoeuvres: pushes of the left and right hand against time, with a little of the user's own variation, drawn by seed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

Push = tuple[np.ndarray, np.ndarray]
Draw = Callable[[np.ndarray, np.random.Generator], Push]


@dataclass(frozen=True)
class Run:
    """One run: `draw` gives (F_rl, F_rr); heavy runs carry `added_mass` at the CM; some are at another tyre pressure."""

    name: str
    manoeuvre: str
    role: str
    u0: float
    duration: float
    draw: Draw
    added_mass: float = 0.0
    other_pressure: bool = False


def _about(rng: np.random.Generator, value: float, spread: float = 0.1) -> float:
    return value * (1 + spread * rng.uniform(-1, 1))


def _levels(t: np.ndarray, start: float, *steps: tuple[float, float], ramp: float = 0.15) -> np.ndarray:
    """`start`, then at each (time, level) a ramp to that level."""
    times, values = [0.0], [start]
    for at, level in steps:
        times += [at, at + ramp]
        values += [values[-1], level]
    return np.interp(t, times, values)


def coast(force: float, seconds: float) -> Draw:
    """A firm push with both hands (a pull if negative), then rolling out."""

    def draw(t: np.ndarray, rng: np.random.Generator) -> Push:
        both = _levels(t, 0, (0.25, _about(rng, force)), (0.25 + seconds, 0))
        return both, both.copy()

    return draw


def strokes(force: float, period: float, left: float = 1.0) -> Draw:
    """Half-sine strokes, each 0.55 s long, the left hand `left` times as strong."""

    def draw(t: np.ndarray, rng: np.random.Generator) -> Push:
        peak = _about(rng, force)
        phase = np.mod(t - 0.28, period)
        wave = np.where((t >= 0.28) & (phase < 0.55), np.sin(np.pi * phase / 0.55), 0.0)
        return left * peak * wave, peak * wave

    return draw


def steady(common: float, difference: float) -> Draw:
    """Straight for one second, then a constant difference of the hands; positive turns right."""

    def draw(t: np.ndarray, rng: np.random.Generator) -> Push:
        mean, half = _about(rng, common, 0.05), _levels(t, 0, (1.0, _about(rng, difference) / 2), ramp=0.5)
        return mean + half, mean - half

    return draw


def slalom(common: float, amplitude: float, period: float) -> Draw:
    """A harmonic difference of the hands after one second."""

    def draw(t: np.ndarray, rng: np.random.Generator) -> Push:
        mean, size, turn = _about(rng, common, 0.05), _about(rng, amplitude), _about(rng, period, 0.03)
        half = size * _levels(t, 0, (1.0, 1.0), ramp=0.3) * np.cos(2 * np.pi * (t - 1.15) / turn)
        return mean + half, mean - half

    return draw


def random_steps(common: float, amplitude: float, hold: float) -> Draw:
    """Random levels of the sum and of the difference, held for about `hold` seconds."""

    def draw(t: np.ndarray, rng: np.random.Generator) -> Push:
        times = np.cumsum(rng.uniform(0.6 * hold, 1.4 * hold, int(t[-1] / (0.6 * hold)) + 2))
        mean, half = rng.uniform(0.6, 1.4, len(times) + 1) * common, rng.uniform(-1, 1, len(times) + 1) * amplitude
        mean_t = _levels(t, mean[0], *zip(times, mean[1:], strict=True), ramp=0.12)
        half_t = _levels(t, half[0], *zip(times, half[1:], strict=True), ramp=0.12)
        return mean_t + half_t, mean_t - half_t

    return draw


def program(left: Iterable[tuple[float, float]], right: Iterable[tuple[float, float]], start: float = 0.0) -> Draw:
    """Levels for each hand."""
    left, right = tuple(left), tuple(right)

    def draw(t: np.ndarray, rng: np.random.Generator) -> Push:
        size = _about(rng, 1.0, 0.06)
        return size * _levels(t, start, *left), size * _levels(t, start, *right)

    return draw


def spin(first: float, second: float) -> Draw:
    """Two spins on the spot, first > 0 to the right, second likewise."""
    plan = [(1.0, first), (3.5, 0.0), (6.0, second), (8.0, 0.0)]
    return program(plan, [(at, -force) for at, force in plan])


def one_hand(left: float, right: float, period: float = 3.2) -> Draw:
    """From rest, push after push of one hand: the chair turns about the wheel that nobody pushes, and stops before the next."""

    def draw(t: np.ndarray, rng: np.random.Generator) -> Push:
        size = _about(rng, 1.0)
        phase = np.mod(t - 1.0, period)
        wave = np.where((t >= 1.0) & (phase < 1.2), np.sin(np.pi * phase / 1.2), 0.0)
        return size * left * wave, size * right * wave

    return draw


def start_stop(left: float, right: float) -> Draw:
    """Forward from rest, roll, pull back into reverse, then forward again."""
    rest = [(2.1, 0.0), (4.2, -26.0), (5.2, 0.0)]
    return program([(1.0, left), *rest, (6.7, right), (8.2, 0.0)], [(1.0, right), *rest, (6.7, left), (8.2, 0.0)])


def turns(one: float, other: float) -> Draw:
    """Up to a slow speed, a turn, straight, a turn the other way, roll out."""
    left = [(1.5, one), (4.5, 6.0), (6.5, other), (9.5, 6.0), (11.5, 0.0)]
    right = [(1.5, other), (4.5, 6.0), (6.5, one), (9.5, 6.0), (11.5, 0.0)]
    return program(left, right, start=20.0)


EVERYDAY = (
    Run("coast-down", "coast-down", "fit", 0.3, 11.0, coast(55, 1.2)),
    Run("straight-strokes", "straight", "fit", 0.6, 12.0, strokes(37, 1.1)),
    Run("steady-right", "steady turn", "fit", 1.0, 12.0, steady(9.4, 14)),
    Run("steady-left", "steady turn", "fit", 1.1, 12.0, steady(9.0, -16)),
    Run("slalom-slow", "slalom", "fit", 0.9, 14.0, slalom(10.2, 10.5, 4.0)),
    Run("slalom-quick", "slalom", "fit", 1.1, 12.0, slalom(11.0, 23, 2.0)),
    Run("random-steps", "random", "fit", 0.9, 15.0, random_steps(12, 17, 0.9)),
    Run("holdout-slalom", "slalom", "holdout", 1.0, 14.0, slalom(10.4, 17, 2.6)),
    Run("holdout-random", "random", "holdout", 1.0, 15.0, random_steps(12, 17, 0.7)),
    Run("holdout-strokes", "strokes", "holdout", 0.6, 12.0, strokes(31, 1.2, left=1.38)),
)
SLOW = (
    Run("coast-down", "coast-down", "fit", 0.2, 9.0, coast(44, 1.15)),
    Run("start-stop", "start-stop", "fit", 0.05, 11.0, start_stop(30, 28)),
    Run("spin-right", "spin", "fit", 0.05, 10.0, spin(14, 10)),
    Run("spin-left", "spin", "fit", 0.05, 10.0, spin(-13, -11.5)),
    Run("slow-turns", "turns", "fit", 0.3, 13.0, turns(18, 3)),
    Run("holdout-start-stop", "start-stop", "holdout", 0.05, 8.0, start_stop(32, 35)),
    Run("holdout-spin", "spin", "holdout", 0.05, 9.0, spin(12.5, -11.5)),
    Run("holdout-slow-turns", "turns", "holdout", 0.3, 11.0, turns(3, 19)),
)
STRAIGHT = (
    Run("coast-down", "coast-down", "fit", 0.3, 11.0, coast(53, 1.2)),
    Run("straight-strokes", "straight", "fit", 0.6, 12.0, strokes(39, 1.1)),
    Run("holdout-coast", "coast-down", "holdout", 0.2, 10.0, coast(45, 1.4)),
)
BACKWARD = Run("coast-back", "coast-back", "fit", 0.0, 8.0, coast(-40, 1.0))
CIRCLE = Run("circle", "steady turn", "fit", 0.8, 14.0, steady(9.5, 30))
HARD = (
    Run("coast-down", "coast-down", "fit", 0.3, 11.0, coast(55, 1.2)),
    Run("hard-right", "steady turn", "fit", 1.8, 10.0, steady(12, 85)),
    Run("hard-left", "steady turn", "fit", 1.8, 10.0, steady(12, -85)),
    Run("hard-slalom", "slalom", "fit", 1.8, 12.0, slalom(13, 50, 2.4)),
    Run("hard-random", "random", "fit", 1.8, 12.0, random_steps(13, 45, 0.8)),
    Run("holdout-hard-slalom", "slalom", "holdout", 1.8, 12.0, slalom(13, 42, 3.0)),
    Run("holdout-hard-random", "random", "holdout", 1.8, 12.0, random_steps(13, 42, 1.0)),
)
FIERCE = (
    Run("coast-down", "coast-down", "fit", 0.3, 11.0, coast(55, 1.2)),
    Run("fierce-right", "steady turn", "fit", 1.8, 8.0, steady(18, 230)),
    Run("fierce-left", "steady turn", "fit", 1.8, 8.0, steady(18, -230)),
    Run("fierce-slalom", "slalom", "fit", 1.8, 8.0, slalom(18, 110, 2.4)),
    Run("holdout-fierce-slalom", "slalom", "holdout", 1.8, 8.0, slalom(18, 100, 3.0)),
)
_NAMES = {"coast-down", "steady-right", "slalom-quick", "random-steps", "holdout-slalom"}
_PICKED = tuple(r for r in EVERYDAY if r.name in _NAMES)
MASS = _PICKED + tuple(replace(r, name=f"{r.name}-heavy", added_mass=30.0) for r in _PICKED)
PRESSURE = _PICKED + tuple(replace(r, name=f"{r.name}-pressure", other_pressure=True) for r in _PICKED)
ONE_HANDED = (
    *_PICKED,
    Run("left-hand", "one hand", "fit", 0.0, 14.0, one_hand(24, 0)),
    Run("right-hand", "one hand", "fit", 0.0, 14.0, one_hand(0, 26)),
    Run("holdout-left-hand", "one hand", "holdout", 0.0, 11.0, one_hand(27, 0)),
)
STRONG = (
    Run("coast-down", "coast-down", "fit", 0.3, 11.0, coast(55, 1.2)),
    Run("strong-strokes", "straight", "fit", 0.5, 9.0, strokes(92, 1.7)),
    Run(
        "strong-stop",
        "start-stop",
        "fit",
        0.0,
        9.0,
        program([(1, 85.0), (1.8, 0), (4, -80), (4.8, 0)], [(1, 85.0), (1.8, 0), (4, -80), (4.8, 0)]),
    ),
    Run("strong-right", "strokes", "fit", 0.6, 8.0, strokes(68, 1.6, left=1.3)),
    Run("steady-right", "steady turn", "fit", 1.0, 12.0, steady(9.4, 14)),
    Run("slalom-quick", "slalom", "fit", 1.1, 12.0, slalom(11.0, 23, 2.0)),
    Run("holdout-slalom", "slalom", "holdout", 1.0, 14.0, slalom(10.4, 17, 2.6)),
    Run("holdout-strong", "strokes", "holdout", 0.5, 8.0, strokes(80, 1.6, left=1.15)),
)
BOTH_WAYS = (*EVERYDAY, BACKWARD, CIRCLE)

SETS: dict[str, tuple[Run, ...]] = {
    "everyday": EVERYDAY,
    "slow": SLOW,
    "straight": STRAIGHT,
    "mass": MASS,
    "pressure": PRESSURE,
    "both-ways": BOTH_WAYS,
    "one-handed": ONE_HANDED,
    "hard": HARD,
    "strong": STRONG,
    "fierce": FIERCE,
}


def pick(what: str | Iterable[str | Run]) -> tuple[Run, ...]:
    """The runs of a set, or of a list of sets, run names (the first of that name) and runs."""
    if isinstance(what, str):
        what = [what]
    named = {r.name: r for runs in reversed(SETS.values()) for r in reversed(runs)}
    chosen: list[Run] = []
    for item in what:
        if isinstance(item, Run):
            chosen.append(item)
        elif item in SETS:
            chosen.extend(SETS[item])
        elif item in named:
            chosen.append(named[item])
        else:
            raise KeyError(f"no set or run {item!r}; sets are {', '.join(SETS)}, runs {', '.join(named)}")
    names = [r.name for r in chosen]
    if len(set(names)) != len(names):
        raise ValueError("two runs of one name")
    return tuple(chosen)
