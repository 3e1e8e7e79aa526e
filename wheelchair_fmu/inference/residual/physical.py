"""Errors in the units that a person reads, beside how much there was to predict."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import nan, sqrt
from typing import Any

import numpy as np

from ...campaign import BY_NAME
from ...quantities import DisplayUnit
from ..estimation.statistics import finite
from ..evidence.evidence import Evidence

READ_IN = {"rad": "deg", "rad/s": "deg/s"}  # units that people do not read, and those that they do


@dataclass(frozen=True)
class ChannelError:
    """What a model leaves of one channel, over `count` readings (SI): sums of squared errors, of readings, of their squares,
    and of their squares about the mean of each run. Two of them add up to that of all their readings."""

    channel: str
    count: int = 0
    squares: float = 0.0
    total: float = 0.0
    powers: float = 0.0
    about: float = 0.0

    @classmethod
    def of(cls, channel: str, measured: np.ndarray, predicted: np.ndarray) -> ChannelError:
        """Of one run, measured and predicted (n,), NaN in gaps."""
        good = np.isfinite(measured) & np.isfinite(predicted)
        m, left = measured[good], (measured - predicted)[good]
        about = float(np.sum((m - m.mean()) ** 2)) if len(m) else 0.0
        return cls(channel, len(m), float(left @ left), float(m.sum()), float(m @ m), about)

    def __add__(self, other: ChannelError) -> ChannelError:
        mine, theirs = ([e.count, e.squares, e.total, e.powers, e.about] for e in (self, other))
        count, *sums = (a + b for a, b in zip(mine, theirs, strict=True))
        return ChannelError(self.channel, int(count), *sums)

    @property
    def _factor(self) -> DisplayUnit:
        unit = BY_NAME[self.channel].unit
        return next((d for d in unit.display if d.name == READ_IN.get(unit.name)), DisplayUnit(unit.name, 1.0))

    @property
    def unit(self) -> str:
        """In which the errors below are."""
        return self._factor.name

    def _root(self, squares: float) -> float:
        return self._factor.factor * sqrt(max(0.0, squares) / self.count) if self.count else nan

    @property
    def rms(self) -> float:
        """RMS of measured less simulated."""
        return self._root(self.squares)

    @property
    def sd(self) -> float:
        """Standard deviation of the readings about the mean of all."""
        return self._root(self.powers - self.total**2 / self.count) if self.count else nan

    @property
    def constant(self) -> float:
        """RMS that the best constant for each run would leave."""
        return self._root(self.about)

    @property
    def share(self) -> float:
        """The error as a share of the standard deviation: 1 predicts no better than one constant for all."""
        return self.rms / self.sd if self.sd else nan


Errors = Mapping[str, Mapping[str, ChannelError]]  # by run and channel


def channel_errors(evidence: Evidence) -> Errors:
    """Of the simulations in this evidence."""
    return {e.run.name: run_errors(e.channels, e.measured, e.predicted) for e in evidence.runs}


def run_errors(channels: Sequence[str], measured: np.ndarray, predicted: np.ndarray) -> dict[str, ChannelError]:
    """By channel, of one run, measured and predicted (n, nz)."""
    return {c: ChannelError.of(c, measured[:, i], predicted[:, i]) for i, c in enumerate(channels)}


def pooled(errors: Iterable[Mapping[str, ChannelError]]) -> dict[str, ChannelError]:
    """By channel, over several runs."""
    found: dict[str, ChannelError] = {}
    for run in errors:
        for channel, error in run.items():
            found[channel] = found[channel] + error if channel in found else error
    return found


def as_json(fitted: Errors, heldout: Errors) -> dict[str, dict[str, Any]]:
    """The key `physical`: by channel, what is left on held-out runs and on fitted ones, with `unit`, beside what the readings
    vary by and what a constant would leave. Where no run was held out, share and constant are of the fitted runs."""
    fit, held = pooled(fitted.values()), pooled(heldout.values())
    runs = {**fitted, **heldout}

    def one(channel: str) -> dict[str, Any]:
        told = held.get(channel, fit.get(channel))
        assert told is not None
        return {
            "heldout_rms": finite(held[channel].rms) if channel in held else None,
            "fit_rms": finite(fit[channel].rms) if channel in fit else None,
            "unit": told.unit,
            "share_of_sd": finite(told.share),
            "constant_rms": finite(told.constant),
            "runs": {run: finite(row[channel].rms) for run, row in runs.items() if channel in row},
        }

    return {channel: one(channel) for channel in BY_NAME if channel in {*fit, *held}}
