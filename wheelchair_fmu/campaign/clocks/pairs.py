"""Two devices, or two signals, set beside each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..channels import INTEGRALS
from .equation import Equation
from .lag import CRYSTAL, Lag, find
from .signals import Device, Signal, band, rate
from .views import BODY_LAG, PUSHES, equation, views


@dataclass(frozen=True, eq=False)
class Pair:
    """What devices `a` and `b` say of their clocks: `lag` is by how much (s) the clock of `a` is ahead of that of `b` at time
    0, so that offset of b − offset of a = lag, with its standard error; `drift` the same of their rates, s/s.

    `kind` says whether motion, pushes or a part of the motion was compared, `how` what with what. `gains` (each view's, by
    feature) are 1, the track, 1/mass, or show a sign or a unit that is wrong. `rival` is the next best lag, and `ahead` the
    log likelihood by which it is worse; `unique` where that is enough.
    """

    a: str
    b: str
    kind: str
    how: str
    lag: float
    se: float
    drift: float
    drift_se: float
    gains: tuple[tuple[float, ...], ...]
    correlation: float
    unique: bool
    ahead: float
    rival: float | None

    @property
    def words(self) -> str:
        return f"{self.a} and {self.b} ({self.how})"


@dataclass(frozen=True)
class Match:
    """One signal against another: values of a(t) ≈ gain · values of b(t − lag) + a constant, both at the level of speeds or of
    accelerations. `correlation` has the gain's sign."""

    lag: float
    se: float
    gain: float
    correlation: float
    unique: bool


def pair(a: Device, b: Device, kind: str) -> Pair | None:
    """The better of the two ways to set devices beside each other by one kind of view; None where they share nothing."""
    found = [p for first, second in ((a, b), (b, a)) if (p := _one_way(first, second, kind)) is not None]
    return min(found, key=lambda p: (not p.unique, p.se), default=None)


def _one_way(a: Device, b: Device, kind: str) -> Pair | None:
    chosen = views(a, b, kind)
    lag = find([equation(v, a, b) for v in chosen]) if chosen else None
    if lag is None:
        return None
    seconds, se = lag.at_zero()
    se = float(np.hypot(se, BODY_LAG if kind == PUSHES else 0.0))
    gains = tuple(tuple(float(g) for g in of) for of in lag.gains)
    return Pair(
        a.name,
        b.name,
        kind,
        chosen[0].words,
        seconds,
        se,
        *_drift(lag),
        gains,
        lag.correlation,
        lag.unique,
        lag.ahead,
        lag.rival,
    )


def _drift(lag: Lag) -> tuple[float, float]:
    """Where it is not known, clocks differ as crystals do."""
    return (lag.drift, lag.drift_se) if lag.drift else (0.0, CRYSTAL)


def alike(a: Signal, b: Signal, width: float | None = None) -> Match | None:
    """Whether, and with what lag and gain, one signal is the other: for guessing what a column is. Positions are differentiated
    to speeds, and speeds to accelerations where the other signal is an acceleration or a push. None where the records share
    too little."""
    level = min(INTEGRALS.get(s.quantity, 0) for s in (a, b))
    series = []
    for s in (a, b):
        time, values = np.asarray(s.time, float), np.asarray(s.values, float)
        for _ in range(max(INTEGRALS.get(s.quantity, 0) - min(level, 1), 0)):
            time, values = rate(time, values)
        series.append((time, values))
    slowest = max(float(np.median(np.diff(time))) for time, _ in series)
    first, second = (Device(s.device, {s.quantity: of}, width or band(slowest)) for s, of in zip((a, b), series, strict=True))
    target = first.smooth(a.quantity)
    constant = np.ones((1, len(target.value)))
    lag = find([Equation(target.time, target.value, target.slope, constant, (second.smooth(b.quantity),))])
    if lag is None:
        return None
    gain = float(lag.gains[0][0])
    return Match(*lag.at_zero(), gain, float(np.copysign(lag.correlation, gain)), lag.unique)
