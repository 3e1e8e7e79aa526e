"""One run simulated again, before and after the search: what each model leaves of its readings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...campaign import moving
from ...errors import Failure, SimulationError
from ...inference.evidence.evidence import Evidence
from ...inference.evidence.initial_state import TUNING
from ...inference.evidence.likelihood import Likelihood
from ...inference.models.factory import ModelFactory
from ...inference.models.setting import Setting
from ...model.generic import library
from ..content import in_time, noise_told, used
from .case import Case

NEAR = 0.02  # share by which an error may differ from what the diagnosis has


@dataclass(frozen=True)
class Replay:
    """Residuals of a run at `time` (n,) in s: measured less simulated by channel (n,), SI, NaN in gaps, as calibrated and with
    the last model. `sd` is the noise of each channel."""

    run: str
    role: str
    time: np.ndarray
    before: Mapping[str, np.ndarray]
    after: Mapping[str, np.ndarray]
    sd: Mapping[str, float]


def replay(case: Case) -> Replay:
    """The run that the last model foretells least, of those held out, or of the fitted ones where there are none.

    Raises Failure where what is simulated is not what the diagnosis says, as with another chair, and where nothing can be.
    """
    likelihood = _likelihood(case)
    runs = likelihood.campaign.holdout or likelihood.campaign.fit
    try:
        before, after = (
            likelihood.evidence(runs, _values(case, step["step"]), (), tune_start=TUNING) for step in (case.begins, case.top)
        )
    except SimulationError as error:
        raise Failure(f"the last model cannot be simulated again ({error}); diagnose the campaign again") from error
    _same(case, after)
    at = max(range(len(runs)), key=lambda i: float(np.nanmean(after.runs[i].e ** 2)))
    sd = {c: likelihood.noise_model.of(c, runs[at]) for c in after.runs[at].channels}
    one, other = (_residuals(e, at) for e in (before, after))
    return Replay(runs[at].name, runs[at].role, runs[at].time, one, other, sd)


def _residuals(evidence: Evidence, at: int) -> dict[str, np.ndarray]:
    e = evidence.runs[at]
    return {c: e.measured[:, i] - e.predicted[:, i] for i, c in enumerate(e.channels)}


def _likelihood(case: Case) -> Likelihood:
    """Of the runs as the diagnosis had them: pushes in time, without the channels that it left out."""
    whole = replace(case.campaign, runs=tuple(in_time(r, case.told["sync"]) for r in case.campaign.runs))
    campaign = used(moving(whole) if case.with_forces else whole, case.told)
    terms = {name: term for name, term in library().items() if name in case.effects}
    chair = replace(case.chair, catalogue={**terms, **case.chair.catalogue})
    factory = ModelFactory(campaign, chair, case.fixed, leads=case.with_forces)
    return factory.likelihood(case.effects, Setting(noise_told(case.told)))


def _values(case: Case, step: str) -> dict[str, float]:
    models: Sequence[Mapping[str, dict[str, float]]] = case.told["models"]
    return next((dict(m["values"]) for m in models if m["step"] == step), {})


def _same(case: Case, found: Evidence) -> None:
    """Is the error what the diagnosis says it is?"""
    told = float(case.top[case.key])
    if not abs(found.rms / told - 1) < NEAR:
        raise Failure(
            f"the last model of the diagnosis leaves {told:.2f} times the noise, and {found.rms:.2f} times simulated again; "
            "give the --variant, --set and --effects that it was made with, or diagnose again"
        )
