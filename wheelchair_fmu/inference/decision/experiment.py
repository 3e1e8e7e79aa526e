"""The next experiment: the run that best tells tied models apart, or shows what could not be seen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from ...campaign import CHANNELS, Run, moving
from ...errors import SimulationError
from ..estimation.inverse import inverse
from ..estimation.problem import Fit, Problem, prior_of
from ..estimation.statistics import decisive
from ..evidence.evidence import Begin
from ..evidence.likelihood import Likelihood
from ..evidence.noise_model import NoiseModel
from ..models.models import Models
from ..policy import DEFAULT

MOST_REPEATS = 20
DRAWN = 240  # moments of a run that are kept to draw it


class Experiment(Protocol):
    """What the loop needs to know of a run that could be made."""

    words: str
    time: np.ndarray
    inputs: Any
    speed: float
    heading: float
    set: Any
    more: Any
    sensors: Any


def separate(
    models: Models, one: Fit, other: Fit, effects: tuple[str, str], among: Sequence[Experiment], beside: Sequence[str] = ()
) -> dict[str, Any] | None:
    """The experiment that separates two fitted models, of these effects, with the fewest repeats, or None where none does.
    `beside` are the effects that both models have.

    The first model says what would be read; what the second cannot imitate, within what the campaign already says of
    its parameters, is −2 log of the odds that one run gives. `shows` is what there is to see of that.
    """
    likelihood = models.likelihood([e for e in (*beside, *effects) if e in models.factory.catalogue])
    needed = decisive(one.evidence)  # as the verdict on a tie has it
    odds = []
    for experiment in among:
        try:
            there, runs = _imagined(likelihood, experiment, one)
            evidence = there.evidence(runs, other.values, other.names)
        except SimulationError:
            continue
        r, S = evidence.r, evidence.S
        g = S.T @ r
        towards = inverse(S.T @ S + inverse(other.covariance)) @ g  # as near as the second may come
        odds.append((float(r @ r - g @ towards), experiment, there, runs, towards))
    if not odds:
        return None
    gain, best, there, runs, towards = max(odds, key=lambda o: o[0])
    repeats = int(np.ceil(needed / max(gain, 1e-9)))
    if repeats > MOST_REPEATS:
        return None
    return {
        "manoeuvre": best.words,
        "separates": list(effects),
        "repeats": repeats,
        "why": f"one such run would favour the right one of the two by {gain:.0f} in −2 log likelihood; {needed:.0f} decide",
        "shows": _shows(there, runs, other, towards, effects),
    }


def _shows(
    there: Likelihood, runs: Sequence[Run], other: Fit, towards: np.ndarray, effects: tuple[str, str]
) -> dict[str, Any] | None:
    """What to look at: the channel in which the run's readings, by the first model, part most from what the second would have
    once it has been fitted to them, and both, in SI units, with the noise of one reading. None where that cannot be run."""
    problem = Problem(there, other.names)
    moved = {n: other.values[n] + float(d) for n, d in zip(other.names, towards, strict=True)}
    values = {**other.values, **problem.values(problem.inside(moved))}
    try:
        seen = max(there.evidence(runs, values).runs, key=lambda e: float(np.nansum(e.r**2)))
    except SimulationError:
        return None
    run = seen.run
    channel = seen.channels[int(np.argmax(np.nansum(seen.r**2, axis=0)))]
    some = np.unique(np.linspace(0, len(run.time) - 1, DRAWN).astype(int))
    readings = (run.channels[channel], seen.predicted[:, seen.channels.index(channel)])
    return {
        "channel": channel,
        "time": run.time[some].tolist(),
        "readings": {e: series[some].tolist() for e, series in zip(effects, readings, strict=True)},
        "noise": there.noise_model.of(channel, run),
    }


def reveal(models: Models, base: Fit, hidden: Sequence[str], among: Sequence[Experiment]) -> dict[str, Any] | None:
    """The experiment that would show most of the effects that this campaign could not have shown."""
    likelihood = models.wide()
    effects = [e for e in hidden if e in models.factory.light]
    names = [n for e in effects for n in models.factory.parameters(e)]
    best: tuple[int, Any, list[str], float] | None = None
    for experiment in among:
        try:
            there, runs = _imagined(likelihood, experiment, base)
            e = there.evidence(runs, base.values, [*base.names, *names])
        except SimulationError:
            continue
        shown, weakest = _shown(models, e.S, base, prior_of(likelihood, base.names).slopes, effects, names)
        if shown and (best is None or len(shown) > best[0]):
            best = (len(shown), experiment, shown, weakest)
    if best is None:
        return None
    repeats = int(np.ceil(DEFAULT.tied / best[3]))
    return {
        "manoeuvre": best[1].words,
        "separates": best[2],
        "repeats": max(1, min(repeats, MOST_REPEATS)),
        "why": f"it would show {best[0]} effects of interesting size that these runs could not",
    }


def _shown(
    models: Models, S: np.ndarray, base: Fit, prior: np.ndarray, effects: Sequence[str], names: Sequence[str]
) -> tuple[list[str], float]:
    """Effects that one run would show at δ, and the information of the weakest of them."""
    k = len(base.names)
    Z, known = S[:, :k], inverse(base.covariance) + prior**2
    unsure = inverse(Z.T @ Z + known)
    shown, weakest = [], np.inf
    for effect in effects:
        own = models.factory.parameters(effect)
        X = S[:, [k + names.index(n) for n in own]] * [models.factory.records[n].smallest_interesting for n in own]
        information = X.T @ X - X.T @ Z @ unsure @ Z.T @ X
        size = float(np.linalg.eigvalsh(information)[-1])
        if size > DEFAULT.tied:
            shown.append(effect)
            weakest = min(weakest, size)
    return shown, weakest


def _imagined(likelihood: Likelihood, experiment: Experiment, model: Fit) -> tuple[Likelihood, Sequence[Run]]:
    """The likelihood with an experiment's sensors, and the run as a fitted model would have it read, without noise. Forces
    that nobody recorded, where they lead the runs, would act there as well; that run, too, is cut to where the chair rolls."""
    known = {**likelihood.variant.values, **likelihood.campaign.known}
    given = {**experiment.set, **{n: known.get(n, 0.0) + extra for n, extra in experiment.more.items()}}
    measured = {c for r in likelihood.campaign.runs for c in r.channels} | set(experiment.sensors)
    blank = Run(
        experiment.words,
        Path(experiment.words),
        experiment.words,
        "fit",
        experiment.speed,
        given,
        experiment.time,
        dict(experiment.inputs),
        {},
    )
    start = {
        "start.x": 0.0,
        "start.y": 0.0,
        "start.psi": experiment.heading,
        "start.u": experiment.speed,
        "start.v": 0.0,
        "start.psi_dot": 0.0,
    }
    w = likelihood.inputs(blank)
    p = likelihood.variant.vector({**known, **model.values, **given, **start})
    simulated = likelihood.sensitivities.run(experiment.time, w, p)
    places = {c.name: likelihood.sensitivities.sensors.index(c.fmu) for c in CHANNELS if c.name in measured}
    offsets = {c: model.values.get(name, 0.0) for name, c in likelihood.offsets.items()}  # of sensors that would be there again
    run = replace(blank, channels={c: simulated.readings[:, i] + offsets.get(c, 0.0) for c, i in places.items()})
    sd, ar = {**experiment.sensors, **likelihood.noise_model.sd}, likelihood.noise_model.ar
    if not likelihood.leads:
        return likelihood.with_noise_model(NoiseModel(sd, ar)).begun({run.name: Begin(start)}), [run]
    there = likelihood.with_noise_model(replace(likelihood.noise_model, sd=sd, shown={}))  # readings without noise show none
    pieces = moving(replace(likelihood.campaign, runs=(run,))).runs
    return there.begun({piece.name: Begin(there.expected_start(piece)) for piece in pieces}), pieces
