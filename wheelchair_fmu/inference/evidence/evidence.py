"""Evidence: whitened residuals and sensitivities of runs, and what is read off them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ...campaign import BY_NAME, Run, pace
from ..parallel import parallel_map
from .initial_state import starts_of, uncertain
from .local import Marginal, read
from .noise_model import effort

BLOCK = 2.0  # s of data that a bootstrap resamples together


@dataclass(frozen=True)
class Begin:
    """Where the next model of a run begins: from this start, if one is known, and linearised about this path of forces (n, nd),
    or about these errors of the pushes (n, nq). Readings that tell one model nothing, as the chair comes to rest (`kinks`
    (n, nz)), are not asked by the next one either: only likelihoods of the same readings can be compared."""

    start: Mapping[str, float] = field(default_factory=dict)
    path: np.ndarray | None = None
    kinks: np.ndarray | None = None


@dataclass(frozen=True)
class FilterSummary:
    """What is kept of a `Whitener` that whitens no more."""

    logdet: float
    spread: np.ndarray


@dataclass(frozen=True)
class RunEvidence:
    """One run: innovations r (n, nz) with NaN in gaps, their sensitivities S (n, nz, k) by parameters and start_S
    (n, nz, m + l) by the start and by what else is uncertain of this run only, and the filter that they went through."""

    run: Run
    channels: tuple[str, ...]
    r: np.ndarray
    S: np.ndarray
    start_S: np.ndarray
    start: Mapping[str, float]
    results: np.ndarray  # (n, ny) all outputs of the simulation
    predicted: np.ndarray  # (n, nz) simulated readings
    measured: np.ndarray  # (n, nz), less offsets
    whitener: Marginal | FilterSummary
    offset: np.ndarray  # (nx + l,) where the true start and constants are expected, less the simulated ones
    path: np.ndarray | None = None  # (n, nd) forces that nobody recorded (see `disturbance`), about which all is linearised
    added: np.ndarray | float = 0.0  # (n, nz) what these add to the readings
    driven: np.ndarray | None = None  # (n, nz) readings simulated with them
    pushed: np.ndarray | None = None  # (n, nq) errors of the recorded pushes, in the place of such forces
    foretelling: np.ndarray | None = None  # (m,) of a run that was held out, −2 log of how likely each block of it was
    begins: Begin = Begin()
    beyond: np.ndarray | None = None  # (k,) what the filter's own change tells of each parameter: see `pull`

    @cached_property
    def finite(self) -> np.ndarray:
        """Which innovations (n, nz) there are."""
        return np.isfinite(self.r)

    @cached_property
    def smoothed(self) -> np.ndarray:
        """The forces (n, nd) that nobody recorded, as all readings have them, once for all values nearby."""
        return followed(self)

    @cached_property
    def pull(self) -> np.ndarray:
        """−½ the slope of the deviance (k,) by each parameter: Sᵀ r, and what is `beyond`, where somebody has asked for it."""
        found = self.S[self.finite].T @ self.r[self.finite]
        return found if self.beyond is None else found + self.beyond

    @property
    def uncertain(self) -> dict[str, float]:
        """Standard deviations of what is estimated of the run for itself."""
        return uncertain(self.run, starts_of(self.start))

    @property
    def started(self) -> dict[str, float]:
        """Where the simulation started, by parameters of the model."""
        return {n: self.start[n] for n in starts_of(self.start)}

    def summary(self) -> RunEvidence:
        """The same without sensitivities, filter and results, which are most of its memory: for a model that is only judged."""
        return replace(self._bare(), whitener=FilterSummary(self.whitener.logdet, self.whitener.spread))

    def error_scale(self) -> RunEvidence:
        """What `errors` of another model's predictions needs, and no more: the filter only where a channel drifts."""
        return self._bare() if self._drift else self.summary()

    def _bare(self) -> RunEvidence:
        none = np.empty((*self.r.shape, 0))
        brief = replace(self, S=none, start_S=none, results=np.empty((0, 0)), begins=Begin(), beyond=None)
        return brief if self.driven is None else replace(brief, predicted=self.foretold, path=None, added=0.0, driven=None)

    @cached_property
    def pace(self) -> np.ndarray:
        """Speed (n,) at which the chair rolls: `campaign.pace`, once for all strengths of forces that are tried."""
        return pace(self.run)

    @cached_property
    def effort(self) -> np.ndarray:
        """How hard (n,) in N hands push about each moment: `noise_model.effort`, once for all strengths as well."""
        return effort(self.run)

    @property
    def deviance(self) -> float:
        """−2 log likelihood, but for a constant."""
        return float(np.nansum(self.r**2)) + self.whitener.logdet

    @property
    def filter(self) -> Marginal:
        """The filter, of evidence that still has it (see `summary`)."""
        assert isinstance(self.whitener, Marginal)
        return self.whitener

    @property
    def foretold(self) -> np.ndarray:
        """(n, nz) readings without forces that nobody recorded, by slopes about where these lead."""
        return self.predicted if self.driven is None else self.driven - self.added

    @property
    def followed(self) -> np.ndarray:
        """(n, nz) simulated readings, with the forces that nobody recorded where the run is led by them."""
        return self.predicted if self.driven is None else self.driven

    @cached_property
    def e(self) -> np.ndarray:
        """(n, nz) the simulation's own `errors`; by slopes, where such forces are among the noise."""
        return self.errors(self.foretold)

    def on_rows(self, simulated: Mapping[str, np.ndarray]) -> np.ndarray:
        """Simulated channels (n,) by name as readings (n, nz), each for when its device's samples were taken."""
        return read(self.run, self.channels, np.stack([simulated[c] for c in self.channels], axis=1), self.start)

    def errors(self, predicted: np.ndarray) -> np.ndarray:
        """(n, nz) whitened: measured less `predicted`, in standard deviations; NaN in gaps.

        A reading varies with its sensor's noise and with that of the pushes, added up. Where that adds up without end, in
        position and heading, a run has one error rather than as many as samples; these are judged by what each reading says
        that was not known from those before it.
        """
        errors = (self.measured - predicted) * self.whitener.spread
        if self._drift:
            errors[:, self._drift] = self._innovations(predicted)[:, self._drift]
        return errors

    @property
    def _drift(self) -> list[int]:
        return [i for i, c in enumerate(self.channels) if BY_NAME[c].drifts]

    def _innovations(self, predicted: np.ndarray) -> np.ndarray:
        if predicted is self.predicted and self.driven is None:
            return self.r
        return self.filter((self.measured - predicted)[:, :, None], self.offset)[:, :, 0]

    @cached_property
    def rms(self) -> dict[str, float]:
        """Whitened RMS error of each channel: 1.0 is the noise floor."""
        return {c: float(np.sqrt(np.nanmean(self.e[:, i] ** 2))) for i, c in enumerate(self.channels)}


@dataclass(frozen=True)
class Evidence:
    """Some runs together: r (N,), S (N, k) of the finite innovations, and the parameters that S is by."""

    runs: tuple[RunEvidence, ...]
    by: tuple[str, ...]

    @cached_property
    def r(self) -> np.ndarray:
        return np.concatenate([e.r[e.finite] for e in self.runs] or [np.empty(0)])

    @cached_property
    def S(self) -> np.ndarray:
        return np.concatenate([e.S[e.finite] for e in self.runs] or [np.empty((0, len(self.by)))])

    @property
    def pull(self) -> np.ndarray:
        """−½ the slope of the deviance (k,) by each parameter."""
        return np.sum([e.pull for e in self.runs], axis=0) if self.runs else np.zeros(len(self.by))

    @cached_property
    def deviance(self) -> float:
        """−2 log likelihood, but for a constant."""
        return float(self.r @ self.r + sum(e.whitener.logdet for e in self.runs))

    @cached_property
    def rms(self) -> float:
        """Whitened RMS error over all runs and channels: 1.0 is the noise floor."""
        errors = parallel_map(lambda e: e.e, self.runs)
        e = np.concatenate([e[np.isfinite(e)] for e in errors] or [np.empty(0)])
        return float(np.sqrt(e @ e / len(e))) if len(e) else float("nan")

    def channel_rms(self) -> dict[str, float]:
        """Whitened RMS error of each channel over all runs that have it; NaN where none has a reading."""
        found: dict[str, list[np.ndarray]] = {}
        for e in self.runs:
            for i, channel in enumerate(e.channels):
                found.setdefault(channel, []).append(e.e[np.isfinite(e.e[:, i]), i])
        errors = {channel: np.concatenate(pieces) for channel, pieces in found.items()}
        return {c: float(np.sqrt(e @ e / len(e))) if len(e) else float("nan") for c, e in errors.items()}

    def parts(self) -> Iterator[tuple[RunEvidence, np.ndarray, slice]]:
        """Each run, which of its innovations (n, nz) are finite, and where these stand in `r` and `S`."""
        at = 0
        for e in self.runs:
            yield e, e.finite, slice(at, at := at + int(e.finite.sum()))

    def table(self) -> dict[str, dict[str, float]]:
        """Whitened RMS by run and channel."""
        return {e.run.name: e.rms for e in self.runs}

    @property
    def worst(self) -> tuple[float, str, str]:
        """The largest whitened RMS of one channel in one run, with the run and the channel."""
        every = ((rms, run, channel) for run, row in self.table().items() for channel, rms in row.items())
        return max(every, default=(0.0, "", ""))

    def summary(self) -> Evidence:
        """See `RunEvidence.summary`."""
        return Evidence(tuple(e.summary() for e in self.runs), ())

    def without(self, run: str) -> Evidence:
        """The same without one run."""
        return Evidence(tuple(e for e in self.runs if e.run.name != run), self.by)

    def only(self, names: Sequence[str]) -> Evidence:
        """The same evidence with sensitivities by some of its parameters."""
        at = [self.by.index(n) for n in names]
        some = (replace(e, S=e.S[:, :, at], beyond=None if e.beyond is None else e.beyond[at]) for e in self.runs)
        return Evidence(tuple(some), tuple(names))

    def led_from(self, other: Evidence) -> Evidence:
        """The same on paths as far from those of another evidence of these runs as smoothed forces are from its own."""
        pairs = zip(self.runs, other.runs, strict=True)
        moved = parallel_map(lambda pair: _led_from(*pair), pairs)
        return replace(self, runs=tuple(moved))

    def knowing(self, beyond: np.ndarray) -> Evidence:
        """The same with what filters' own change tells (m, k) in each run."""
        return replace(self, runs=tuple(replace(e, beyond=row) for e, row in zip(self.runs, beyond, strict=True)))


def followed(e: RunEvidence) -> np.ndarray:
    """The forces (n, nd) that nobody recorded, as all readings of a run have them."""
    assert isinstance(e.whitener, Marginal)
    filter_ = e.whitener.whitener
    return filter_.smoothed(filter_((e.measured - e.foretold)[:, :, None], e.offset[: filter_.size[0]])[:, :, 0])


def _led_from(e: RunEvidence, other: RunEvidence) -> RunEvidence:
    assert other.path is not None
    return replace(e, path=other.path + e.smoothed - other.smoothed)


def blocks_of(run: Run) -> list[slice]:
    """Where each block of a run is; the last is what is left."""
    length = max(1, round(BLOCK / float(np.median(np.diff(run.time)))))
    return [slice(i, i + length) for i in range(0, len(run.time), length)]


def begins_of(*found: Evidence) -> dict[str, Begin]:
    """By run, where evidence has found that it begins."""
    return {e.run.name: e.begins for evidence in found for e in evidence.runs}
