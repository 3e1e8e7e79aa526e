"""What an effect does in a model that was fitted with it, and whether that is surely large."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy import special

from ..chance import chance_beyond
from ..estimation.inverse import inverse
from ..estimation.left_out import left_out
from ..estimation.marginal import support_of
from ..estimation.problem import Fit
from ..estimation.score import RUNS
from ..estimation.statistics import between_runs, bounded, correlation_time, held_out_gain, sandwich, seen_directions
from ..models.hypothesis import Model
from ..models.models import Models
from .candidate import Candidate, WithoutRun
from .usual import Usual, usual


def judge(models: Models, base: Model, found: Model, effect: str, names: Sequence[str], tests: int) -> Candidate:
    """What an effect, whose parameters are `names`, does in the model `found` beside `base`, which lacks it; so many `tests`
    were made with that of it."""
    w, fit, held = models.factory, found.fit, found.heldout
    at_usual, told, delta = usual(models, found, names), sandwich(fit), w.deltas(names)
    estimate, covariance = np.array([fit.values[n] for n in names]), told[np.ix_(at_usual.own, at_usual.own)]
    lower, upper = (np.array([getattr(w.records[n], side) for n in names]) for side in ("lower", "upper"))
    one_sided, near, without = w.one_sided(names), 1e-6 * delta, w.unfitted(names)
    along, spread = seen_directions((estimate - without) / delta, covariance / np.outer(delta, delta))
    dispersion = float(np.mean(fit.evidence.r**2))
    fall = base.fit.deviance - fit.deviance - _paid(fit, names, at_usual.moved(fit.covariance))
    ratio, correlation = fall / dispersion, correlation_time(fit.evidence)
    p = max(chance_beyond(float(np.sum(along**2 / spread)), len(spread)), chance_beyond(ratio / correlation, len(spread)))
    if len(names) == 1 and one_sided[0]:
        p /= 2
    return Candidate(
        effect=effect,
        fit=replace(fit, evidence=fit.evidence.summary()),
        likelihood_ratio=ratio,
        estimate=estimate,
        without=without,
        covariance=covariance,
        usual=_spread(fit, at_usual, told),
        delta=delta,
        one_sided=one_sided,
        dispersion=dispersion,
        correlation=correlation,
        p=min(1.0, tests * p),
        gain=held_out_gain(base.heldout, held) if held.runs else None,
        heldout=held.summary(),
        lawful=not bool(np.all((estimate <= near) & one_sided)),
        stretched=bool(np.any((estimate >= upper - near) | (estimate <= lower + near) & ~one_sided)),
        without_run=_without(base.fit, fit, at_usual, ratio * dispersion, led=w.leads),
        policy=models.policy,
        bounded=bounded(fit, at_usual.own, at_usual.size, at_usual.moved(told)),
        by_errors=w.leads,
    )


def _without(base: Fit, found: Fit, at_usual: Usual, fall: float, *, led: bool) -> dict[str, WithoutRun]:
    """What a fit beside `base` says of its own sizes by all fitted runs but one, by name of that: see `left_out`. Where forces
    lead the runs, the fall follows from standard errors alone."""
    own, before, after = at_usual.own, left_out(base), left_out(found)
    whole = base.deviance - found.deviance
    return {
        run: WithoutRun(
            at_usual.slopes[own] @ out.moved,
            out.wider[own],
            None if led else fall - whole + before[run].deviance - out.deviance,
        )
        for run, out in after.items()
        if run in before
    }


def _paid(found: Fit, names: Sequence[str], covariance: np.ndarray) -> float:
    """What −2 log likelihood is the less for, as constants of the effects of `names` were adjusted: twice the log of how far
    data narrowed them down, so that a law that can be bent is no likelier for that (Laplace). By the `covariance` (n, n) of a
    fit's values, with such sizes among them as are judged."""
    of = {n.rpartition(".")[0] for n in names}
    own = [i for i, n in enumerate(found.names) if n in names]
    constants = [i for i, n in enumerate(found.names) if n.rpartition(".")[0] in of and n not in names]
    if not constants:
        return 0.0
    both = [*own, *constants]
    told = inverse(covariance[np.ix_(both, both)])[len(own) :, len(own) :]
    sd = 1 / np.diag(found.prior_slopes)[constants]
    return max(0.0, float(np.linalg.slogdet(told * np.outer(sd, sd))[1]))


def surely_large(models: Models, found: Model, effect: str) -> bool:
    """Is an effect of a model with sensitivities surely large, rather than slight or nothing?"""
    w, fit = models.factory, found.fit
    names = w.parameters(effect)
    size, *covariances = _spread(fit, usual(models, found, names), sandwich(fit))
    fall = float(size @ inverse(covariances[0]) @ size)
    support = support_of(effect, size, covariances, w.deltas(names), w.one_sided(names), fall, 0.0, models.policy)
    return float(special.expit(support.large - max(0.0, support.slight))) > models.policy.sure


def _spread(found: Fit, at_usual: Usual, told: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Sizes (k,) by usual laws, their covariance (k, k) by that of all values as `told` (n, n), and by how far runs would have
    them apart, if there are enough of these."""
    between = between_runs(found) if len(found.evidence.runs) >= RUNS else told
    own = np.ix_(at_usual.own, at_usual.own)
    return at_usual.size, at_usual.moved(told)[own], at_usual.moved(between)[own]
