"""The model that a diagnosis ends with, as a table of estimates needs it: all that was fitted together, with its covariance."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ...campaign import Run
from ...quantities import Parameter
from ..estimation.calibration import at_bound
from ..estimation.interval import interval_by_errors
from ..estimation.own_constant import own_constant
from ..estimation.problem import Fit
from ..estimation.statistics import finite, sandwich
from ..evidence.evidence import Evidence, RunEvidence
from ..evidence.likelihood import Likelihood
from .diagnosis import Diagnosis

BY_PROFILE, BY_ERRORS = "profile", "errors"  # how an interval was found


def final(d: Diagnosis, more: Mapping[str, Parameter]) -> dict[str, Any]:
    """The key `final` of a diagnosis, in SI units.

    `step` is its place on the staircase and `laws` what the model is made of; `parameters` has a record for each of the k
    values that were fitted together, `covariance` (k, k) their robust covariance in the same order; `fixed` are values that
    nobody estimated because the user set them, by name; `runs` says which readings were used (see `_run`). `more` are the
    records of generic terms, by name, one of which the model may have in it.
    """
    found, likelihood = d.top, d.models.likelihood(d.included)
    records, covariance = {**more, **likelihood.records}, sandwich(found)
    errors = np.sqrt(np.maximum(np.diag(covariance), 0))
    priors = _priors(d, found, records)
    choice, allowed = likelihood.variant.choice, [d.allowance.get(n, 0.0) for n in found.names]
    return {
        "step": d.ladder[-1].name,
        "laws": {"tyre": choice.tyre, "caster": choice.caster, "wheel": choice.wheel, "equations": choice.equations},
        "parameters": [
            _parameter(
                records[name],
                found.values[name],
                (float(se), allowed[i]),
                *priors[name],
                _reach(found, records[name], i),
                _interval(d, found, records[name], i),
            )
            for i, (name, se) in enumerate(zip(found.names, errors, strict=True))
        ],
        "covariance": ((covariance + covariance.T) / 2).tolist(),  # symmetric to the last digit
        "fixed": {n: d.models.factory.variant.values.get(n) for n in sorted(d.models.factory.fixed)},
        "runs": {r.name: _run(r, found.evidence, likelihood) for r in d.models.factory.campaign.runs},
    }


def _priors(d: Diagnosis, found: Fit, records: Mapping[str, Parameter]) -> dict[str, tuple[float, float]]:
    """Mean and standard deviation (inf: nothing was known) of each parameter before the fit."""
    known = {**d.models.factory.variant.values, **d.models.factory.campaign.known}
    given = {c.record.name: c.prior for c in d.calibration}
    slopes = abs(np.diag(found.prior_slopes))
    return {
        name: (given.get(name, known.get(name, records[name].default)), 1 / slope if slope > 0 else np.inf)
        for name, slope in zip(found.names, map(float, slopes), strict=True)
    }


def _reach(found: Fit, record: Parameter, at: int) -> tuple[float, float]:
    """How far the fit might go."""
    if found.lower is None or found.upper is None:
        return record.lower, record.upper
    return float(found.lower[at]), float(found.upper[at])


def _interval(d: Diagnosis, found: Fit, record: Parameter, at: int) -> tuple[tuple[float, float], str]:
    """That of an effect that was found, or one by standard errors alone; and which of the two it is."""
    name = found.names[at]
    if name in d.intervals:
        return d.intervals[name], BY_ERRORS if d.models.factory.leads else BY_PROFILE
    return interval_by_errors(found, at, d.allowance.get(name, 0.0), record), BY_ERRORS


def _parameter(
    record: Parameter,
    value: float,
    errors: tuple[float, float],
    prior: float,
    prior_sd: float,
    reach: tuple[float, float],
    interval: tuple[tuple[float, float], str],
) -> dict[str, Any]:
    """`errors` are the standard error and what effects that nobody named add to it. Standard errors say nothing of a value that
    a bound stopped, which has no `interval` by these."""
    ends, by = interval
    stopped = at_bound(record, value, prior, prior_sd, reach)
    told = by == BY_PROFILE or (not stopped and bool(np.isfinite(ends).all()))
    return {
        "name": record.name,
        "unit": record.unit.name,
        "meaning": record.meaning,
        "estimate": value,
        "se": finite(errors[0]),
        "unnamed": finite(errors[1]),
        "interval": list(ends) if told else None,
        "interval_by": by if told else None,
        "prior": prior if np.isfinite(prior_sd) else None,
        "prior_sd": finite(prior_sd),
        "smallest_interesting": record.smallest_interesting,
        "at_bound": stopped,
    }


def _start(e: RunEvidence, likelihood: Likelihood) -> dict[str, dict[str, Any]]:
    """By parameter, where a run began: its `value` given all readings, its `se` and its `unit`."""
    expected, began = likelihood.expected_start(e.run), {}
    for name in e.started:
        off, se = own_constant(e, name)
        began[name] = {"value": expected[name] + off, "se": se, "unit": likelihood.records[name].unit.name}
    return began


def _run(run: Run, evidence: Evidence, likelihood: Likelihood) -> dict[str, Any]:
    """`role`, the times `from` and `to` (s), by channel how many `readings` there were and, of a fitted run, how many of them
    the fit `used`: none tells anything of a chair about the moment it comes to rest; and where a fitted run began (`start`)."""
    fitted = next((e for e in evidence.runs if e.run.name == run.name), None)
    counts = {c: int(np.isfinite(series).sum()) for c, series in run.channels.items()}
    used = {} if fitted is None else {c: int(np.isfinite(fitted.r[:, i]).sum()) for i, c in enumerate(fitted.channels)}
    return {
        "role": run.role,
        "from": float(run.time[0]),
        "to": float(run.time[-1]),
        "start": _start(fitted, likelihood) if fitted else None,
        "channels": {c: {"readings": n, "used": used.get(c)} for c, n in counts.items()},
    }
