"""What a model leaves of runs that were held out, beside what it leaves of those it was fitted on."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..estimation.foretelling import unforetold
from ..estimation.statistics import correlation_time
from ..evidence.evidence import Evidence
from ..evidence.initial_state import TUNING
from ..models.hypothesis import Model
from ..models.models import Models
from ..policy import DEFAULT, SearchPolicy
from ..residual.staircase import Step

NAMED = 3  # values that are said to explain an error, at most
MUCH = 0.5  # of what the one that explains most does


@dataclass(frozen=True)
class Ahead:
    """Innovations of held-out runs with all values as these want them, within what the fitted runs leave open, by how much
    (RMS) each value `moved` them: what is still left no value explains. Where something was found, `before` is the error that
    calibration left of these runs."""

    left: Evidence = Evidence((), ())
    moved: Mapping[str, float] = field(default_factory=dict)
    before: float | None = None

    @property
    def rms(self) -> float:
        """Over all runs and channels; 1.0 is the noise floor."""
        return float(np.sqrt(np.mean(self.left.r**2))) if len(self.left.r) else 1.0

    @property
    def worst(self) -> tuple[float, str, str]:
        """The largest of one channel in one run, with the run and the channel."""
        runs = ((e.run.name, c, e.r[:, i]) for e in self.left.runs for i, c in enumerate(e.channels))
        seen = ((float(np.sqrt(np.nanmean(r**2))), run, c) for run, c, r in runs if np.isfinite(r).any())
        return max(seen, default=(1.0, "", ""))

    def unexplained(self, policy: SearchPolicy) -> bool:
        """Is more left than noise accounts for, or than laws that are not exact, and does it last?"""
        if correlation_time(self.left) <= policy.lasting:
            return False
        if self.before is None:
            return policy.is_structured(self.rms, self.worst[0])
        return policy.is_rest(self.rms, self.before)


def ahead(models: Models, top: Model, ladder: Sequence[Step], found: bool) -> Ahead:
    """Of the last model of a search, in which something was `found` or not. Nothing is asked where the error on held-out runs
    is the noise; where forces lead the runs, what lasts is theirs, as long as no adequate model leaves more."""
    policy = models.policy
    if not ladder[-1].heldout > (policy.unexplained if models.factory.leads else policy.a_little):
        return Ahead()
    likelihood, fit = models.likelihood(top.effects), top.fit
    held = likelihood.evidence(models.campaign.holdout, fit.values, fit.names, tune_start=TUNING)
    return Ahead(*unforetold(fit, held, models.unknown(likelihood, fit)), ladder[1].heldout if found else None)


def run_to_fit(ladder: Sequence[Step], told: Ahead, policy: SearchPolicy = DEFAULT) -> str | None:
    """The held-out run to fit as well, where only such runs show an error."""
    last = ladder[-1]
    if not told.left.runs or not last.fit <= policy.unexplained < last.heldout:
        return None
    return told.worst[1] if told.unexplained(policy) else _furthest(told)


def which_to_fit(ladder: Sequence[Step], told: Ahead, policy: SearchPolicy = DEFAULT) -> tuple[str, ...]:
    """A sentence on that run, and on what its error rests."""
    run = run_to_fit(ladder, told, policy)
    if run is None:
        return ()
    if told.unexplained(policy):
        size, _, channel = told.worst
        return (
            f"{run}: runs that were held out show what the fitted ones do not, {channel} most, with {size:.1f} times the "
            f'noise, and no value of the chair explains it; give {run} role = "fit", and diagnose again',
        )
    most = max(told.moved.values(), default=0.0)
    names = sorted((n for n, by in told.moved.items() if by >= MUCH * most), key=lambda n: -told.moved[n])
    return (
        f"{run}: runs that were held out are off by {ladder[-1].heldout:.1f} times the noise, as the fitted ones leave "
        f'uncertain what these depend on ({", ".join(names[:NAMED])}); give {run} role = "fit", and diagnose again',
    )


def _furthest(told: Ahead) -> str:
    """The held-out run that the model is furthest off in."""
    errors = {e.run.name: float(np.sqrt(np.nanmean(e.e**2))) for e in told.left.runs}
    return max(errors, key=lambda run: errors[run])
