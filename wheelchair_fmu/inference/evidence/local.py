"""What is uncertain of one run only, besides its start: the clock of each device, the baseline of a record of pushes.

Each is a constant with a known standard deviation, about zero. Its slope goes through the run's filter like a parameter's, and
is then taken out of residuals and sensitivities by their joint covariance, so that nobody has to estimate it and everybody
allows for it; where the readings say it is, a run can be simulated again.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ...campaign import Baseline, Clock, Run
from ...engine.innovations import Whitener
from ...errors import SimulationError

STROKE = 0.03  # s, either side: slopes of a recorded push are taken over this, as over a sample they are mostly noise


class Local(Protocol):
    """One uncertain constant of a run."""

    @property
    def name(self) -> str: ...

    @property
    def sd(self) -> float:
        """Its standard deviation in SI units."""

    def felt(self, time: np.ndarray, inputs: Mapping[str, np.ndarray], size: float) -> dict[str, np.ndarray]:
        """Inputs (n,) by FMU name as the chair felt them, where the constant has this `size`."""

    def read(self, time: np.ndarray, channels: Sequence[str], predicted: np.ndarray, size: float) -> np.ndarray:
        """Readings (n, nz) that belong to the samples' own rows, from those predicted there."""


@dataclass(frozen=True)
class ClockError:
    """The samples of one device were taken this much later than its times say."""

    clock: Clock

    @property
    def name(self) -> str:
        return f"clock.{self.clock.device}"

    @property
    def sd(self) -> float:
        return self.clock.sd

    def felt(self, time: np.ndarray, inputs: Mapping[str, np.ndarray], size: float) -> dict[str, np.ndarray]:
        return {n: np.interp(time - size, time, v) if n in self.clock.inputs else v for n, v in inputs.items()}

    def read(self, time: np.ndarray, channels: Sequence[str], predicted: np.ndarray, size: float) -> np.ndarray:
        out = predicted.copy()
        for i in (i for i, c in enumerate(channels) if c in self.clock.channels):
            out[:, i] = np.interp(time + size, time, predicted[:, i])
        return out


@dataclass(frozen=True)
class BaselineError:
    """A record of pushes holds so much of one shape that no hand gave."""

    baseline: Baseline
    column: int

    @property
    def name(self) -> str:
        return f"baseline.{self.baseline.input}.{self.column}"

    @property
    def sd(self) -> float:
        return 1.0

    def felt(self, time: np.ndarray, inputs: Mapping[str, np.ndarray], size: float) -> dict[str, np.ndarray]:
        shape = self.baseline.independent[:, self.column]
        return {n: v - size * shape if n == self.baseline.input else v for n, v in inputs.items()}

    def read(self, time: np.ndarray, channels: Sequence[str], predicted: np.ndarray, size: float) -> np.ndarray:
        return predicted


def locals_of(run: Run) -> tuple[Local, ...]:
    """All uncertain constants of a run."""
    clocks = (ClockError(c) for c in run.clocks if c.sd > 0)
    baselines = (BaselineError(b, i) for b in run.baselines for i in range(b.independent.shape[1]))
    return (*clocks, *baselines)


def felt(run: Run, sizes: Mapping[str, float]) -> dict[str, np.ndarray]:
    """The run's inputs as the chair felt them, given the sizes of its constants by name."""
    inputs = dict(run.inputs)
    for local in locals_of(run):
        if size := sizes.get(local.name, 0.0):
            inputs = local.felt(run.time, inputs, size)
    return inputs


def read(run: Run, channels: Sequence[str], predicted: np.ndarray, sizes: Mapping[str, float]) -> np.ndarray:
    """Readings (n, nz) for the samples of a run, given the sizes of its constants."""
    for local in locals_of(run):
        if size := sizes.get(local.name, 0.0):
            predicted = local.read(run.time, channels, predicted, size)
    return predicted


def rate_of(time: np.ndarray, pushed: np.ndarray) -> np.ndarray:
    """(n, nq) what recorded pushes (n, nq) change by per second; not from sample to sample, where it is mostly their noise."""
    ahead, behind = (np.stack([np.interp(time + side * STROKE, time, p) for p in pushed.T], axis=1) for side in (1, -1))
    return (ahead - behind) / (2 * STROKE)


class Marginal:
    """A run's filter with constants L (n, nz, l), in units of their standard deviations, taken out by their covariance.

    Innovations x have the covariance I + L Lᵀ; they are multiplied by its inverse square root, which is the identity but for
    the l directions of L. Without constants this is the filter itself.
    """

    def __init__(self, whitener: Whitener, slopes: np.ndarray):
        self.whitener, self.L, self.logdet = whitener, slopes, whitener.logdet
        n, nz, constants = slopes.shape
        if not constants:
            return
        signals = np.concatenate((np.zeros((n, nz, 1)), slopes), axis=2)
        none = np.zeros(whitener.noise.start.shape[0])
        self.L = whitener(signals, none, in_place=True)[:, :, 1:]
        flat = self.L.reshape(n * nz, -1)
        if not np.isfinite(flat).all():
            raise SimulationError("what a clock or a baseline would do grows beyond all numbers; try other parameters")
        size, directions = np.linalg.eigh(flat.T @ flat)
        root = np.sqrt(1 + np.maximum(size, 0.0))
        self._less = (directions / (root * (root + 1))) @ directions.T  # (1 − 1/√(1 + κ))/κ, also where κ is 0
        self.logdet += 2 * float(np.log(root).sum())

    @property
    def spread(self) -> np.ndarray:
        """See `Whitener.spread`."""
        return self.whitener.spread

    @property
    def kinks(self) -> np.ndarray:
        """See `Whitener`."""
        return self.whitener.kinks

    def __call__(self, signals: np.ndarray, mean: np.ndarray, *, in_place: bool = False) -> np.ndarray:
        """As a Whitener's; `mean` (nx + l,) is where the true start and the true constants are expected, less the simulated
        ones, the constants in standard deviations."""
        nx = len(mean) - self.L.shape[2]
        out = self.whitener(signals, mean[:nx], in_place=in_place)
        if not self.L.shape[2]:
            return out
        first = out[:, :, 0]
        first -= self.L @ mean[nx:]
        n, nz, m = out.shape
        flat, L = out.reshape(n * nz, m), self.L.reshape(n * nz, -1)
        gaps = np.isnan(flat[:, 0])
        flat[gaps, 0] = 0.0
        flat -= L @ (self._less @ (L.T @ flat))
        flat[gaps, 0] = np.nan
        return out
