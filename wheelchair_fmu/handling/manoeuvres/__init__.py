"""The manoeuvres: the paper's steady turn and slalom (section 6), a coast-down, a start-stop and a spin.

The paper holds the forward speed and gives only the difference of the two forces on the rear wheels,
F_rl − F_rr = 2ΔF; here F_rl = +ΔF and F_rr = −ΔF, positive to the right, and the total push that holds
the speed is a result. The other manoeuvres go at free speed, by whole forces on each wheel.

A file here, or in the folder `manoeuvres` of a user's configuration, is one more: a function `MANOEUVRE` of its options.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from inspect import signature
from math import isfinite
from types import FunctionType

import numpy as np
from scipy.interpolate import PchipInterpolator

from ...configuration import MANOEUVRES as OWN
from ...configuration import places
from ...errors import UsageError, unknown
from ...model.chassis import PUSH_LIMIT
from ...model.lawful import names, records

INTERVAL = 0.01  # s between samples
MOST_SAMPLES = 1_000_000
TOP_SPEED = 20.0  # m/s, the model's bound for speed.u and start.u
STROKE = 0.5  # s that a hand is on the rim in one push
BEAT = 1.0  # s from one push to the next
PUSH = 40.0  # N at each wheel, the peak of a push in start-stop


@dataclass(frozen=True, eq=False)
class Manoeuvre:
    """What a chair is put through: parameter values and inputs by FMI name, SI units.

    `time` is (n,), evenly spaced; `inputs` are (n,) each, linear between samples. `watch` names the
    result to look at besides path and slip.
    """

    name: str
    title: str
    values: Mapping[str, float | str]
    time: np.ndarray
    inputs: Mapping[str, np.ndarray]
    watch: str


def steady_turn(speed: float = 1.0, delta_force: float = 10.0, time: float = 10.0) -> Manoeuvre:
    """A turn at the prescribed `speed` [m/s] under a constant F_rl − F_rr = 2 `delta_force` [N].

    Figs. 12, 15 and 18. The paper's text gives the speed, 1 m/s; ΔF = 10 N is chosen here.
    """
    positive("--speed", speed, "m/s", TOP_SPEED)
    t = samples(time)
    title = f"steady turn at {speed:g} m/s, ΔF = {delta_force:g} N"
    return Manoeuvre("steady-turn", title, held(speed), t, pair(delta_force + 0 * t), "push.total_needed")


def slalom(speed: float = 1.0, delta_force: float = 10.0, period: float = 4.0, time: float = 12.0) -> Manoeuvre:
    """A slalom at the prescribed `speed` [m/s] under F_rl − F_rr = 2 `delta_force` cos(2πt / `period`).

    Figs. 13, 14, 16, 17 and 19. Neither ΔF nor T stands in the paper's text: ΔF = 10 N and T = 4 s are chosen here.
    """
    positive("--speed", speed, "m/s", TOP_SPEED)
    positive("--period", period, "s")
    if period < 10 * INTERVAL:
        raise UsageError(
            f"--period {period:g} s is shorter than ten samples of {INTERVAL:g} s; give at least {10 * INTERVAL:g} s"
        )
    t = samples(time)
    title = f"slalom at {speed:g} m/s, ΔF = {delta_force:g} N, T = {period:g} s"
    wave = delta_force * np.cos(2 * np.pi * t / period)
    return Manoeuvre("slalom", title, held(speed), t, pair(wave), "push.total_needed")


def coast_down(speed: float = 1.0, time: float = 10.0) -> Manoeuvre:
    """Hands off from `speed` [m/s], forward or backward: rolling resistance brings the chair to rest."""
    if not isfinite(speed) or not 0 < abs(speed) <= TOP_SPEED:
        raise UsageError(
            f"--speed {speed:g} m/s: a coast-down starts in motion; give a speed of at most {TOP_SPEED:g} m/s, not zero"
        )
    t = samples(time)
    return Manoeuvre("coast-down", f"coast-down from {speed:g} m/s", free(speed), t, pair(0 * t), "chair.u")


def start_stop(time: float = 14.0) -> Manoeuvre:
    """From rest: three pushes, coasting, pulls back until the chair reverses, a push against it, and the brakes."""
    t = samples(time)
    pushes = sum(_stroke(t, k * BEAT) for k in range(3))
    pulls = sum(_stroke(t, 5.0 + k * BEAT) for k in range(4))
    force = PUSH * (pushes - pulls + 0.6 * _stroke(t, 10.0))
    brake = np.interp(t, (11.0, 11.5), (0.0, 1.0))
    phase = PchipInterpolator(BEAT * np.arange(-1, 5), [0.0, 0.0, 1.0, 2.0, 3.0, 3.0], extrapolate=False)
    inside = np.minimum(t, 4 * BEAT)
    strokes = {"stroke.phase": phase(inside), "stroke.rate": phase(inside, 1)}
    inputs = {"push.F_rl": force, "push.F_rr": force, "brake.rl": brake, "brake.rr": brake, **strokes}
    return Manoeuvre("start-stop", "start, coast, reverse and stop", free(0.0), t, inputs, "chair.u")


def spin(delta_force: float = 12.0, time: float = 10.0) -> Manoeuvre:
    """From rest on the spot: ±`delta_force` [N] on the wheels to the right, then to the left, then hands off.

    Not in the paper; ΔF = 12 N is chosen. Much more and the chair leaves the spot: its CM lies before the axle and is thrown
    outward against no more than the rolling resistance.
    """
    t = samples(time)
    turns = np.interp(t, (0.0, 0.2, 2.8, 3.2, 7.8, 8.2), (0.0, 1.0, 1.0, -1.0, -1.0, 0.0))
    return Manoeuvre(
        "spin", f"spin on the spot, ΔF = {delta_force:g} N", free(0.0), t, pair(delta_force * turns), "chair.psi_dot"
    )


MANOEUVRES: dict[str, Callable[..., Manoeuvre]] = {
    "steady-turn": steady_turn,
    "slalom": slalom,
    "coast-down": coast_down,
    "start-stop": start_stop,
    "spin": spin,
}  # and at the end of this file those of files


def manoeuvre(name: str, **options: float | None) -> Manoeuvre:
    """A manoeuvre by name; options that are None keep their defaults.

    Raises UsageError for an unknown name, an option that the manoeuvre does not have, or an impossible value.
    """
    given = {key: value for key, value in options.items() if value is not None}
    refuse_unknown(name, given)
    if not abs(given.get("delta_force", 0.0)) <= PUSH_LIMIT:  # written so that NaN is refused too
        raise UsageError(f"--delta-force {given['delta_force']:g} N is outside ±{PUSH_LIMIT:g} N; give a force between them")
    return MANOEUVRES[name](**given)


def refuse_unknown(name: str, options: Iterable[str]) -> None:
    """Raises UsageError for an unknown manoeuvre, or for an option that its function does not have."""
    if name not in MANOEUVRES:
        raise unknown("manoeuvre", name, MANOEUVRES)
    known = signature(MANOEUVRES[name]).parameters
    for key in options:
        if key not in known:
            raise UsageError(f"{name} has no {_option(key)}; it takes {', '.join(map(_option, known))}")


def _option(key: str) -> str:
    return "--" + key.replace("_", "-")


def positive(option: str, value: float, unit: str, most: float = 1e6) -> None:
    """Raises UsageError for a value that is not above 0, or above `most`."""
    if not 0 < value <= most:
        raise UsageError(f"{option} {value:g} {unit} is impossible here; give a number above 0, at most {most:g} {unit}")


def samples(time: float) -> np.ndarray:
    """0 to `time` in steps of INTERVAL; a rest shorter than that is left out."""
    positive("--time", time, "s", MOST_SAMPLES * INTERVAL)
    n = int(time / INTERVAL + 1e-9)
    if n < 2:
        raise UsageError(f"--time {time:g} s is shorter than two samples of {INTERVAL:g} s; give at least {2 * INTERVAL:g} s")
    return np.arange(n + 1) * INTERVAL


def held(speed: float) -> dict[str, float | str]:
    """The values of a manoeuvre at this speed [m/s], prescribed."""
    return {"speed.mode": "prescribed", "speed.u": speed, "start.u": speed}


def free(speed: float) -> dict[str, float | str]:
    """The values of a manoeuvre that starts with this speed [m/s]."""
    return {"speed.mode": "free", "start.u": speed}


def pair(delta: np.ndarray) -> dict[str, np.ndarray]:
    """F_rl = +ΔF and F_rr = −ΔF turn the chair to the right."""
    return {"push.F_rl": delta, "push.F_rr": -delta}


def _stroke(t: np.ndarray, start: float) -> np.ndarray:
    """Half a sine from `start`, of height 1: one push."""
    phase = (t - start) / STROKE
    return np.where((phase > 0) & (phase < 1), np.sin(np.pi * phase), 0.0)


__path__ += places(OWN)
_FILES = records(__name__, names(__path__), "MANOEUVRE", FunctionType, "{}")
MANOEUVRES.update({name.replace("_", "-"): make for name, make in _FILES.items()})
