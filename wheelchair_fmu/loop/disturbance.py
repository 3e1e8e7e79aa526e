"""How much force a model needs that nobody recorded: the strength of a slow random force and moment on the chair.

An uneven floor, a hand on a wheel, a lean of the rider, and whatever a model lacks push a chair slowly and at random. Beside
the noise of sensors, a force F along the heading and a moment M about the vertical, each a Gauss–Markov process, make such a
push part of the noise; the likelihood of the readings says how strong they are, in N and N m, so that models compare by a
figure that a person can read: 145 N of unexplained force, or 11.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize

from ..campaign import moving
from ..engine.innovations import Whitener
from .likelihood import Evidence, Likelihood, NoiseModel, RunEvidence, disturbance
from .parallel import parallel_map

USUAL_FORCE, USUAL_MOMENT = 5.0, 1.0  # N and N m: a strength's prior falls by e over this
LEAST, MOST = 1e-2, 100.0  # times these, that are looked at
START = ((0.03, 0.03), (0.3, 0.03), (0.03, 0.3), (0.6, 0.6), (6.0, 6.0))  # times these, from where the search may start
ROUNDS = 5  # in which a path and a strength are found, at most,
CLOSE = 0.1  # of a strength, by which the last one may differ


@dataclass(frozen=True)
class Strength:
    """Standard deviations of the force (N) and of the moment (N m) that a model needs, and by how much −2 log posterior falls
    with them."""

    force: float
    moment: float
    fall: float

    def put_into(self, noise_model: NoiseModel) -> NoiseModel:
        return replace(noise_model, force=self.force, moment=self.moment)


def strength(evidence: Evidence, t_r: float) -> Strength:
    """The most likely strength, given evidence of one model with its filters; zero where the readings ask for none.

    `t_r` is the distance (m) between the wheels. Uncertain clocks and baselines of runs are taken as they are.
    """

    def misfit(log_ratio: np.ndarray) -> float:
        ratios = np.exp(log_ratio)
        force, moment = ratios * (USUAL_FORCE, USUAL_MOMENT)
        return _misfit(evidence, NoiseModel({}, force=force, moment=moment), t_r) + 2 * float(ratios.sum())

    without = _misfit(evidence, NoiseModel({}), t_r)
    least, begun = min(((misfit(at), at) for at in np.log(START)), key=lambda tried: tried[0])
    if least > without:
        return Strength(0.0, 0.0, 0.0)
    found = minimize(
        misfit,
        begun,
        method="Nelder-Mead",
        bounds=[(np.log(LEAST), np.log(MOST))] * 2,
        options={"xatol": 0.05, "fatol": 0.5, "initial_simplex": begun + np.array([[0.0, 0.0], [0.7, 0.0], [0.0, 0.7]])},
    )
    ratios = np.exp(found.x)
    force, moment = (
        float(r * usual) if r > 2 * LEAST else 0.0 for r, usual in zip(ratios, (USUAL_FORCE, USUAL_MOMENT), strict=True)
    )
    return Strength(force, moment, without - float(found.fun))


def acting(likelihood: Likelihood, values: Mapping[str, float], t_r: float) -> tuple[Strength, Evidence]:
    """How strong the forces are that a model needs at these values, and evidence of the fitted runs, where the chair rolls,
    about the path that these forces lead to.

    A model that lacks much goes another way than the chair did, and slopes along that say little of how a force would bring it
    back. So forces are estimated, the model is led by them, and the strength is estimated anew from there.
    """
    likelihood = likelihood.led(moving(likelihood.campaign))
    likelihood.noise_model = replace(likelihood.noise_model, force=USUAL_FORCE, moment=USUAL_MOMENT)
    found = Strength(0.0, 0.0, 0.0)
    for _ in range(ROUNDS):
        evidence = likelihood.evidence(likelihood.campaign.fit, values, tune_start=1)
        before, found = found, strength(evidence, t_r)
        if not found.fall or _alike(before, found):
            break
        likelihood.noise_model = found.put_into(likelihood.noise_model)
    return found, evidence


def _alike(one: Strength, other: Strength) -> bool:
    pairs = ((one.force, other.force), (one.moment, other.moment))
    return all(abs(a - b) <= CLOSE * max(a, b) for a, b in pairs)


def disturbed(e: RunEvidence, noise_model: NoiseModel, t_r: float) -> tuple[Whitener, np.ndarray]:
    """The filter of a run with forces as strong as `noise_model` has them, and where (nx,) it expects the true start, less the
    simulated one."""
    filter_ = e.whitener.whitener
    filter_ = filter_.disturbed(disturbance(noise_model, len(filter_.noise.pushes), t_r))
    return filter_, e.offset[: filter_.size[0]]


def _misfit(evidence: Evidence, noise_model: NoiseModel, t_r: float) -> float:
    """−2 log likelihood with forces as strong as `noise_model` has them, but for a constant."""

    def one(e: RunEvidence) -> float:
        filter_, start = disturbed(e, noise_model, t_r)
        r = filter_((e.measured - e.foretold)[:, :, None], start)
        return float(np.nansum(r**2)) + filter_.logdet

    return float(sum(parallel_map(one, evidence.runs)))
