"""How far off a model is, in which run and channel, and in which regime the excess lies."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ...quantities import Output
from ..evidence.evidence import RunEvidence
from ..evidence.limits import beyond_limits, in_words
from .physical import ChannelError, pooled, run_errors

BINS = 4
DIGITS = 6  # after the point, in SI units, that a regime is told by


@dataclass(frozen=True)
class RunErrors:
    """Errors of one run, e (n, nz), measured less predicted in standard deviations; NaN in gaps. `physical` is what is left of
    each channel in its own unit, `beyond` the limits that the model is beyond, and for what share of the run."""

    name: str
    role: str
    channels: tuple[str, ...]
    e: np.ndarray
    predicted: np.ndarray
    regime: Mapping[str, np.ndarray]  # by name, (n,)
    physical: Mapping[str, ChannelError]
    beyond: Mapping[Output, float]

    def summary(self) -> RunErrors:
        """The same without predictions, which only figures ask for."""
        return replace(self, predicted=np.empty((0, len(self.channels))))

    @property
    def rms(self) -> dict[str, float]:
        return {c: float(np.sqrt(np.nanmean(self.e[:, i] ** 2, dtype=float))) for i, c in enumerate(self.channels)}


@dataclass(frozen=True)
class Comparison:
    """Whitened errors of a campaign: 1.0 is the noise floor."""

    runs: tuple[RunErrors, ...]

    def physical(self, role: str) -> dict[str, dict[str, ChannelError]]:
        """By run and channel, of the runs with this role."""
        return {r.name: dict(r.physical) for r in self.runs if r.role == role}

    def rms(self, role: str | None = None) -> float:
        """Over all channels of all runs, or of those with this role; NaN where there are none."""
        e = [r.e for r in self.runs if role in (None, r.role)]
        count = sum(int(np.isfinite(one).sum()) for one in e)
        return float(np.sqrt(sum(np.nansum(one**2, dtype=float) for one in e) / count)) if count else float("nan")

    def excess_by(self, name: str) -> list[tuple[float, float, float]]:
        """(from, to, share of the excess Σ(e² − 1)) over bins of a regime that hold equally many samples; none where it is the
        same all along, but for rounding."""
        values = np.concatenate([r.regime[name] for r in self.runs])
        excess = np.concatenate([np.nansum(r.e**2 - 1, axis=1, dtype=float) for r in self.runs])
        edges = np.unique(np.round(np.quantile(values, np.linspace(0, 1, BINS + 1)), DIGITS))
        if len(edges) < 2:
            return []
        place = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, len(edges) - 2)
        total = float(excess.sum())
        return [
            (float(a), float(b), float(excess[place == i].sum()) / total if total else 0.0)
            for i, (a, b) in enumerate(pairwise(edges))
        ]

    @property
    def limits(self) -> list[str]:
        """A sentence for each run and each limit of the model's that it is beyond."""
        return [told for r in self.runs for told in in_words(r.name, "as simulated", r.beyond)]

    def worst(self) -> tuple[str, str, float]:
        """(run, channel, whitened RMS) where the error is largest."""
        return max(((r.name, c, v) for r in self.runs for c, v in r.rms.items()), key=lambda row: row[2])


def errors_of(
    evidence: RunEvidence, predicted: Mapping[str, np.ndarray] | None, regimes: Mapping[str, str], outputs: Sequence[Output]
) -> RunErrors:
    """Errors of a run against `predicted` readings by channel, or against the evidence's own simulation, whose results are
    `outputs`."""
    there = evidence.predicted if predicted is None else evidence.on_rows(predicted)
    names = [o.name for o in outputs]
    # Copies: a view would keep all results of the run in memory.
    where = {name: evidence.results[:, names.index(output)].copy() for name, output in regimes.items()}
    pushes = [v for name, v in evidence.run.inputs.items() if name.startswith("push.")]
    if pushes:
        where["push"] = np.sum(pushes, axis=0)
    e = evidence.errors(there)
    physical = run_errors(evidence.channels, evidence.measured, there)
    beyond = beyond_limits(evidence.results, outputs)
    return RunErrors(evidence.run.name, evidence.run.role, evidence.channels, e, there, where, physical, beyond)


def together(name: str, pieces: Sequence[RunErrors]) -> RunErrors:
    """The pieces of a run, one after the other, as that run; in single precision, for there may be millions of samples."""
    if len(pieces) == 1:
        return pieces[0]

    def joined(arrays: Iterable[np.ndarray]) -> np.ndarray:
        return np.concatenate([array.astype(np.float32) for array in arrays])

    regime = {name: joined(piece.regime[name] for piece in pieces) for name in pieces[0].regime}
    return replace(
        pieces[0],
        name=name,
        e=joined(p.e for p in pieces),
        predicted=joined(p.predicted for p in pieces),
        regime=regime,
        physical=pooled(p.physical for p in pieces),
        beyond=_shares(pieces),
    )


def _shares(pieces: Sequence[RunErrors]) -> dict[Output, float]:
    """For what share of a whole run its pieces are beyond each limit."""
    samples = sum(len(p.e) for p in pieces)
    limits = dict.fromkeys(o for p in pieces for o in p.beyond)
    return {o: sum(len(p.e) * p.beyond.get(o, 0.0) for p in pieces) / samples for o in limits}
