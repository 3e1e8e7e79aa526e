"""A campaign as the rest of the program sees it: SI units, SAE J670 axes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from ..faults import Fault
from .series import began


@dataclass(frozen=True)
class Clock:
    """The clock of one device in one run: whose `channels` (by name) and `inputs` (by FMU name) it stamps, the standard
    deviation, in s, of what may be left of its offset, and the offset that its times have been given. The others' are beside
    that of the `reference`. A run tells how far off a clock is on average: `at_zero` is the standard deviation, in s, of how
    much further off it is at the device's own time 0, for a rate that nobody knows."""

    device: str
    channels: frozenset[str]
    inputs: frozenset[str]
    sd: float
    offset: float = 0.0
    reference: bool = False
    at_zero: float = 0.0


@dataclass(frozen=True, eq=False)
class Baseline:
    """What a record of pushes may still hold that no hand gave: `shapes` (n, m) at the run's times, and the covariance (m, m)
    of how much of each there is, in the input's unit. `input` is its FMU name."""

    input: str
    shapes: np.ndarray
    covariance: np.ndarray

    @cached_property
    def independent(self) -> np.ndarray:
        """(n, m) combinations of the shapes whose sizes are independent, each with a standard deviation of 1."""
        size, directions = np.linalg.eigh(self.covariance)
        return np.asarray(self.shapes @ (directions * np.sqrt(np.maximum(size, 0.0))))


@dataclass(frozen=True, eq=False)
class Run:
    """One recording, or a cut of one.

    `time` is (n,), in s, strictly rising, with the file's own values. `inputs` are (n,) without gaps, by the name
    of the FMU input; `channels` are (n,) with NaN in gaps, by the names of `CHANNELS`. `u0` is the speed at the
    first sample in m/s, from the file or else from the first wheel speeds, None where neither tells; `u0_sd` how sure that is
    (standard deviation), where it is less so than usual.
    `set` holds dotted parameters that differ from the campaign's in this run; where it says how the run starts
    (`start.psi`, ...), that is not estimated.

    Where several devices recorded the run, `time` has the times of all their samples, and a channel is NaN at those of the
    others; inputs are straight lines between their own samples. `clocks` and `baselines` are what is uncertain of it;
    `steps` are the times between the own samples of an input or a channel, in s, where they are not those of `time`, and
    `colours` the AR(1) coefficients of an input's noise, where means of its samples stand here. `noise_shares` say what such a
    mean has of a channel's standard deviation. `devices` is how many recorded it. `way` is how far, in m, the chair has rolled
    by its first sample since it last stood; None where nobody knows.
    """

    name: str
    file: Path
    manoeuvre: str
    role: str
    u0: float | None
    set: dict[str, float]
    time: np.ndarray
    inputs: dict[str, np.ndarray]
    channels: dict[str, np.ndarray]
    clocks: tuple[Clock, ...] = ()
    baselines: tuple[Baseline, ...] = ()
    steps: Mapping[str, float] = field(default_factory=dict)
    colours: Mapping[str, float] = field(default_factory=dict)
    devices: int = 1
    noise_shares: Mapping[str, float] = field(default_factory=dict)
    way: float | None = None
    u0_sd: float | None = None

    @cached_property
    def first(self) -> dict[str, float]:
        """What each channel began with, by its first samples; those that have none are left out."""
        found = {name: began(self.time, series) for name, series in self.channels.items()}
        return {name: value for name, value in found.items() if value is not None}

    def noise_share(self, channel: str) -> float:
        """What the samples of a channel have of its standard deviation: 1 where they are readings, and no means of several."""
        return self.noise_shares.get(channel, 1.0)


@dataclass(frozen=True, eq=False)
class Campaign:
    """Runs with what is known about the chair and the sensors.

    `known` and `priors` (standard deviations) go by dotted FMI names. `noise` is one standard deviation per
    channel that was measured and per input in `F_rl`, `F_rr`, `M_rl`, `M_rr` that was logged (0 for an input
    known exactly because no run logged it); `noise_estimated` says for which it was not given. `nuisance` names
    channels with an unknown offset, `nuisance_sd` its prior where one is given. `warnings` are what `check` found
    that is no error; `thinned` says what a search looks at of a larger campaign. `rims` are, by run and push,
    the `offset` and the `ripple` (N m) that were taken out of what instrumented wheels recorded, and the offset's `se`.
    """

    name: str
    path: Path
    axes: str
    known: dict[str, float]
    priors: dict[str, float]
    noise: dict[str, float]
    noise_estimated: frozenset[str]
    nuisance: tuple[str, ...]
    nuisance_sd: dict[str, float]
    runs: tuple[Run, ...]
    fingerprint: str
    warnings: tuple[Fault, ...] = ()
    thinned: str = ""
    rims: Mapping[str, Mapping[str, Mapping[str, float]]] = field(default_factory=dict)

    @property
    def effects(self) -> tuple[str, ...]:
        """Ids of the effects that the file gives a size, in all runs or in one."""
        given = [*self.known.items(), *(item for run in self.runs for item in run.set.items())]
        return tuple(dict.fromkeys(name.split(".")[1] for name, size in given if size and name.startswith("effect.")))

    @property
    def fit(self) -> tuple[Run, ...]:
        return tuple(run for run in self.runs if run.role == "fit")

    @property
    def holdout(self) -> tuple[Run, ...]:
        return tuple(run for run in self.runs if run.role == "holdout")
