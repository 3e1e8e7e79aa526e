"""Pushes that were recorded by another clock than the readings in the same file.

A force record that is late in every run is a property of the instrument, and an effect of its own; nobody here touches it. One
run whose pushes are shifted beside those of all others has been put together wrongly. A rigid body tells: what its mass and its
drag are the other runs say, so that within one run only the shift is left to be found. Two equations do so apart, since what
makes a chair go on and what turns it know nothing of each other, and each has errors of its own that all runs share.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .equation import Equation
from .fine import left
from .lag import Lag, find
from .signals import Device, Signal, devices
from .smoothing import Smooth
from .views import FORWARDS, TURNS, View, equation, motion_known, rigid

WAYS = (FORWARDS, TURNS)
ENOUGH = 3  # runs that must tell a shift before one of them can be odd
ODD = 5.0  # standard errors from the others, and
LEAST = 0.012  # s, below which nobody puts a file together anew
EXPLAINED = 0.5  # share of a run's squared error that its shift may leave: else it is something else that is wrong
PERIODIC = 0.1  # the same, where another shift does as well: that the recorded times are wrong must then be plain
ALIKE = 4.0  # standard errors that the two equations may differ by in one run: a clock shifts both
TIMES = 2.0  # as much, or as little, as pushes of one and the same chair may do in one run beside the others
STILL = 1e-6  # SI; what changes less in all runs (rolling resistance of a chair that never stops) tells nothing
REWEIGHTED = 8  # times
ROUNDS = 2  # of coefficients at the shift that is common, which needs coefficients

Kind = tuple[View, tuple[bool, bool]]  # a view, and whether speed and turning are known: equations alike but for their numbers
Equations = Mapping[Kind, Equation]  # of one run and one way


@dataclass(frozen=True)
class Shift:
    """`seconds` to be added to the time of a run's pushes, so that they make the motion that was read, beside what is to be
    added in all runs; with its standard error, which holds the scatter between runs. `way` says what told it. Where not
    `unique` another shift does nearly as well: strokes that are all alike are the same one stroke later, and `seconds` is told
    but for whole strokes. `left` is the share of the squared error at the common shift that this one leaves."""

    seconds: float
    se: float
    unique: bool
    way: str
    left: float


def odd_ones_out(runs: Mapping[str, Iterable[Signal]]) -> dict[str, Shift]:
    """The runs whose pushes have a clock of their own, from the signals of each run, which are of one file and have its clock.

    One after the other, the oddest first: it spoils what the others are compared with. Empty where less than ENOUGH runs tell
    their shift, and where half of them would be odd.
    """
    if len(runs) < ENOUGH:
        return {}
    ready = _ready(runs)
    odd: list[str] = []
    while True:
        shifts = _relative(ready, [n for n in ready if n not in odd])
        named = {n: s for n, s in shifts.items() if _is_odd(s)}
        new = [n for n in named if n not in odd]
        if not new:
            break
        odd.append(max(new, key=lambda n: abs(named[n].seconds) / named[n].se))
    return named if 2 * len(named) < len(shifts) else {}


def push_shifts(runs: Mapping[str, Iterable[Signal]]) -> dict[str, Shift]:
    """The shift of each run that has pushes and motion enough to tell one, beside all the others."""
    ready = _ready(runs)
    return _relative(ready, list(ready))


def _is_odd(s: Shift) -> bool:
    return s.left < (EXPLAINED if s.unique else PERIODIC) and abs(s.seconds) > max(ODD * s.se, LEAST)


def _ready(runs: Mapping[str, Iterable[Signal]]) -> dict[str, dict[str, Equations]]:
    """Equations by run and way."""
    ready: dict[str, dict[str, Equations]] = {}
    for name, signals in runs.items():
        found = devices(signals)
        if len(found) > 1:
            raise ValueError(f"run {name} has signals of {len(found)} devices; here each run has one, offsets() is for several")
        for device in found.values():
            ready[name] = {way: _equations(device, way) for way in WAYS}
    return ready


def _equations(device: Device, way: str) -> dict[Kind, Equation]:
    return {(v, motion_known(device)): equation(v, device, device) for v in rigid(device, way)}


def _relative(ready: Mapping[str, Mapping[str, Equations]], pool: Sequence[str]) -> dict[str, Shift]:
    """Each run beside the others of the pool, by the way or ways that are unique for it."""
    ways: dict[str, list[Shift]] = {}
    for way in WAYS:
        lags = _lags({n: e[way] for n, e in ready.items() if e[way]}, pool)
        for name, (lag, known) in lags.items():
            others = [o for n, (o, _) in lags.items() if n in pool and n != name and o.unique]
            if len(others) + 1 >= ENOUGH:
                common, se = _common(others)
                share = min(left(e, lag.seconds) / left(e, common) for e in known)
                away = Shift(lag.seconds - common, float(np.hypot(lag.se, se)), lag.unique, way, share)
                ways.setdefault(name, []).append(away)
    return {name: _together(found) for name, found in ways.items()}


def _together(found: Sequence[Shift]) -> Shift:
    """What two equations say of one clock; where they contradict each other it is not the clock."""
    telling = [s for s in found if s.unique]
    if not telling:
        return min(found, key=lambda s: s.se)
    weights = np.array([1 / s.se**2 for s in telling])
    mean = float(weights @ [s.seconds for s in telling] / weights.sum())
    agree = all(abs(s.seconds - mean) < ALIKE * s.se for s in telling)
    return Shift(mean, float(weights.sum() ** -0.5), agree, " and ".join(s.way for s in telling), min(s.left for s in telling))


def _lags(runs: Mapping[str, Equations], pool: Sequence[str]) -> dict[str, tuple[Lag, list[Equation]]]:
    """Each run's lag with the coefficients of the other runs in the pool, by which only an offset of its own is free; and the
    equations with these coefficients."""
    common = 0.0
    lags: dict[str, tuple[Lag, list[Equation]]] = {}
    for _ in range(ROUNDS):
        grams = {n: {v: _gram(e, common) for v, e in of.items()} for n, of in runs.items()}
        lags = {}
        for name, own in runs.items():
            others = [of for n, of in grams.items() if n != name and n in pool]
            coefficients = [_coefficients([of[v] for of in others if v in of]) for v in own]
            known = [_known(e, c) for e, c in zip(own.values(), coefficients, strict=True)]
            lag = find(known)
            if lag is not None and (any(c is None for c in coefficients) or _push_alike(lag)):
                lags[name] = lag, known
        telling = [lag for n, (lag, _) in lags.items() if lag.unique and n in pool]
        before, common = common, _common(telling)[0] if telling else 0.0
        if abs(common - before) < LEAST:
            break
    return lags


def _push_alike(lag: Lag) -> bool:
    """Do pushes that are read so much later do about what the other runs have them do? Where hands push against each other,
    as in a spin, nearly nothing drives the chair on, and some shift makes that the cause of any motion, many times over."""
    return all(1 / TIMES < gain < TIMES for gains in lag.gains for gain in gains)


def _gram(e: Equation, shift: float) -> tuple[np.ndarray, int]:
    """Products (k + 1, k + 1) of what is known, the pushes and the target, less their means, and how many samples they have."""
    rows = np.array([*e.own[1:], *(s.at(e.time - shift)[0] for s in e.seen), e.target])
    rows = rows[:, np.isfinite(rows).all(axis=0)]
    rows = rows - rows.mean(axis=1, keepdims=True) if rows.shape[1] else rows
    return rows @ rows.T, rows.shape[1]


def _coefficients(grams: Sequence[tuple[np.ndarray, int]]) -> np.ndarray | None:
    """Of what is known and of the pushes, by least squares over runs. A run that fits worse than
    most counts less, so that one with a clock of its own spoils little."""
    grams = [(g, n) for g, n in grams if n > len(g)]
    if not grams:
        return None
    weights, found = np.ones(len(grams)), np.zeros(len(grams[0][0]) - 1)
    for _ in range(REWEIGHTED):
        total = sum((w * g for w, (g, _) in zip(weights, grams, strict=True)), np.zeros_like(grams[0][0]))
        size = np.sqrt(np.diag(total)[:-1])
        live = size > STILL * np.sqrt(float(weights @ [n for _, n in grams]))
        normal = total[:-1, :-1][np.ix_(live, live)] / np.outer(size[live], size[live])
        found[live] = np.linalg.lstsq(normal, total[:-1, -1][live] / size[live], rcond=1e-9)[0] / size[live]
        left = np.append(found, -1.0)
        power = np.array([float(left @ g @ left) / n for g, n in grams])
        weights = 1 / np.maximum(power, max(float(np.median(power)), 1e-300))
    return found


def _known(e: Equation, coefficients: np.ndarray | None) -> Equation:
    """The equation with everything but its offset put in; as it is where nobody else knows the coefficients."""
    if coefficients is None:
        return e
    own, pushes = np.split(coefficients, [len(e.own) - 1])
    drag = own @ e.own[1:]
    first = e.seen[0]
    value, slope = (sum(c * getattr(s, part) for c, s in zip(pushes, e.seen, strict=True)) for part in ("value", "slope"))
    force = Smooth(first.start, first.step, value, slope)
    return replace(e, target=e.target - drag, slope=e.slope - np.gradient(drag, first.step), own=e.own[:1], seen=(force,))


def _common(lags: Sequence[Lag]) -> tuple[float, float]:
    return weighted_median([lag.seconds for lag in lags], [lag.se for lag in lags])


def weighted_median(of: Sequence[float], with_se: Sequence[float]) -> tuple[float, float]:
    """Weighted median, and its standard error with the scatter of the runs about it: what one more run may be away."""
    seconds, ses = np.array(of), np.array(with_se)
    order = np.argsort(seconds)
    weights = 1 / ses[order] ** 2
    middle = float(np.interp(0.5 * weights.sum(), np.cumsum(weights) - 0.5 * weights, seconds[order]))
    scatter = 1.4826 * float(np.median(np.abs(seconds - middle)))
    return middle, float(np.hypot(scatter, np.sqrt(np.pi / 2 / weights.sum())))  # of a median: π/2 times a mean's variance
