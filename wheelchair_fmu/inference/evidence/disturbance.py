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

from ...campaign import moving
from ...engine.innovations import Whitener
from ..parallel import parallel_map
from .evidence import Evidence, RunEvidence
from .likelihood import Likelihood
from .noise_model import FORGOTTEN, NoiseModel, disturbance

USUAL = np.array([5.0, 1.0, 5.0])  # N, N m and N s: a strength's prior falls by e over this
LEAST, MOST = 1e-2, 100.0  # times these, that are looked at
# times these, from where the search may start
START = ((0.03,) * 3, (0.3, 0.03, 0.03), (0.03, 0.3, 0.03), (0.03, 0.03, 0.3), (0.6,) * 3, (0.3, 0.3, 2.0), (6.0,) * 3)
# s: a chair feels no slope for less than its own length, 0.4 m, at the 1.3 m/s of a walk; what lasts longer is an effect
LASTING = (0.3, 1.0)
PRECISE = 1e-7  # share by which −2 log posterior may still fall,
NEARBY = 1e-3  # and share of a strength over which its slope is taken
ROUNDS = 5  # in which a path and a strength are found, at most,
CLOSE = 0.1  # of a strength, by which the last one may differ


@dataclass(frozen=True)
class Strength:
    """Standard deviations of the force (N), of the moment (N m) and of the momentum of the rider's body (N s) that a model
    needs, by how much −2 log posterior falls with them, and the time (s) over which the moment is forgotten."""

    force: float
    moment: float
    body: float
    fall: float
    lasting: float = FORGOTTEN

    def put_into(self, noise_model: NoiseModel, mass: float = 0.0) -> NoiseModel:
        """Noise with forces of this strength, found for a chair of this mass (kg)."""
        return replace(noise_model, force=self.force, moment=self.moment, body=self.body, lasting=self.lasting, mass=mass)


def strength(evidence: Evidence, t_r: float) -> Strength:
    """The most likely strength, given evidence of one model with its filters; zero where the readings ask for none.

    `t_r` is the distance (m) between the wheels. Uncertain clocks and baselines of runs are taken as they are.
    """

    def misfit(logs: np.ndarray) -> float:
        *ratios, lasting = np.exp(logs)
        force, moment, body = ratios * USUAL
        noise_model = NoiseModel({}, force=force, moment=moment, body=body, lasting=lasting)
        return _misfit(evidence, noise_model, t_r) + 2 * float(np.sum(ratios))

    without = _misfit(evidence, NoiseModel({}), t_r)
    begin = (np.log([*at, FORGOTTEN]) for at in START)
    least, begun = min(((misfit(at), at) for at in begin), key=lambda tried: tried[0])
    if least > without:
        return Strength(0.0, 0.0, 0.0, 0.0)
    found = minimize(
        misfit,
        begun,
        method="L-BFGS-B",
        bounds=[*[(np.log(LEAST), np.log(MOST))] * 3, tuple(np.log(LASTING))],
        options={"ftol": PRECISE, "eps": NEARBY},
    )
    *ratios, lasting = np.exp(found.x)
    force, moment, body = (float(r * usual) if r > 2 * LEAST else 0.0 for r, usual in zip(ratios, USUAL, strict=True))
    return Strength(force, moment, body, without - float(found.fun), float(lasting))


def acting(likelihood: Likelihood, values: Mapping[str, float], t_r: float) -> tuple[Strength, Evidence]:
    """How strong the forces are that a model needs at these values, and evidence of the fitted runs, where the chair rolls,
    about the path that these forces lead to.

    A model that lacks much goes another way than the chair did, and slopes along that say little of how a force would bring it
    back. So forces are estimated, the model is led by them, and the strength is estimated anew from there.
    """
    likelihood = likelihood.led(moving(likelihood.campaign))
    force, moment, body = USUAL
    found = Strength(force, moment, body, 0.0)
    likelihood.noise_model = found.put_into(likelihood.noise_model)
    for _ in range(ROUNDS):
        evidence = likelihood.evidence(likelihood.campaign.fit, values, tune_start=1)
        before, found = found, strength(evidence, t_r)
        if not found.fall or _alike(before, found):
            break
        likelihood.noise_model = found.put_into(likelihood.noise_model)
    return found, evidence


def _alike(one: Strength, other: Strength) -> bool:
    pairs = ((one.force, other.force), (one.moment, other.moment), (one.body, other.body))
    return all(abs(a - b) <= CLOSE * max(a, b) for a, b in pairs)


def disturbed(e: RunEvidence, noise_model: NoiseModel, t_r: float) -> tuple[Whitener, np.ndarray]:
    """The filter of a run with forces as strong as `noise_model` has them, and where (nx,) it expects the true start, less the
    simulated one."""
    filter_ = e.filter.whitener
    filter_ = filter_.disturbed(disturbance(noise_model, len(filter_.noise.pushes), t_r))
    return filter_, e.offset[: filter_.size[0]]


def _misfit(evidence: Evidence, noise_model: NoiseModel, t_r: float) -> float:
    """−2 log likelihood with forces as strong as `noise_model` has them, but for a constant."""

    def one(e: RunEvidence) -> float:
        filter_ = e.filter.whitener
        forces = disturbance(noise_model, len(filter_.noise.pushes), t_r)
        return filter_.misfit(forces, e.measured - e.foretold, e.offset[: filter_.size[0]])

    return float(sum(parallel_map(one, evidence.runs)))
