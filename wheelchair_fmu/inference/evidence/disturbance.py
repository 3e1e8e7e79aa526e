"""How much force a model needs that nobody recorded: the strength of a slow random force and moment on the chair.

An uneven floor, a hand on a wheel, a lean of the rider, and whatever a model lacks push a chair slowly and at random. Beside
the noise of sensors, a force F along the heading and a moment M about the vertical, each a Gauss–Markov process, make such a
push part of the noise; the likelihood of the readings says how strong they are, in N and N m, so that models compare by a
figure that a person can read: 145 N of unexplained force, or 11.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from scipy.optimize import minimize

from ...campaign import moving
from ...engine.innovations import ByForces, Disturbance, Whitener
from ..parallel import parallel_map
from .evidence import Evidence, RunEvidence
from .likelihood import MASS, Likelihood
from .noise_model import ASIDE, FORGOTTEN, NoiseModel, disturbance, pushes_of, stroke, strong_and_lasting

SIZES = ("force", "moment", "body", "tremor")
USUAL = np.array([5.0, 1.0, 5.0, 1.0])  # N, N m, N s and N m: a strength's prior falls by e over this
NEAR = 0.02  # m: a CM that is nearer to the axle than that is no lever
LEAST, MOST = 1e-2, 100.0  # times these, that are looked at
LITTLE = 0.03  # times these: what no reading draws up from there is next to nothing
# times these, from where the search may start
START = (
    (LITTLE,) * 4,
    (0.3, LITTLE, LITTLE, LITTLE),
    (LITTLE, 0.3, LITTLE, LITTLE),
    (LITTLE, LITTLE, 0.3, LITTLE),
    (LITTLE, LITTLE, LITTLE, 3.0),
    (0.6,) * 4,
    (0.3, 0.3, 2.0, LITTLE),
    (6.0,) * 4,
)
LASTING = (0.4, 1.3)  # m: a chair feels no slope for less than its own length; what lasts for longer is an effect
SHARES, PARTLY = (0.03, 1.0), 0.7  # of the moment, between which a floor's may be, and from where it is sought
PRECISE = 1e-7  # share by which −2 log posterior may still fall,
NEARBY = 1e-5  # and share of a strength over which its slope is taken: over more, a minimum's slope is not 0
ROUNDS = 5  # in which a path and a strength are found, at most,
CLOSE = 0.1  # of a strength, by which the last one may differ


@dataclass(frozen=True)
class Strength:
    """Standard deviations of the slow force (N), of the moment (N m) and of the momentum of the rider's body (N s) that a model
    needs, by how much −2 log posterior falls with them, the way (m) over which the moment is forgotten, what share of its
    standard deviation is the pull of a floor, the standard deviations of what bumps turn the chair with (N m) and push it along
    (N); and what all was found for: the RMS push (N) of the runs, and the chair's mass (kg) and the lever (m) of its CM."""

    force: float
    moment: float
    body: float
    fall: float
    lasting: float = FORGOTTEN
    share: float = 0.0
    tremor: float = 0.0
    bumps: float = 0.0
    stroke: float = 0.0
    mass: float = 0.0
    lever: float = 1.0

    @property
    def floor(self) -> float:
        """Standard deviation (N) of what a floor pulls along the heading, and to the side at the CM."""
        return self.share * self.moment / self.lever

    @property
    def along(self) -> float:
        """Standard deviation (N) of the force along the heading, slow or a floor's, without bumps."""
        return float(np.hypot(self.force, self.floor))

    @property
    def whole(self) -> tuple[float, float]:
        """Standard deviations of the force along the heading (N) and of the moment (N m), with bumps."""
        return float(np.hypot(self.along, self.bumps)), float(np.hypot(self.moment, self.tremor))

    def put_into(self, noise_model: NoiseModel) -> NoiseModel:
        """Noise with forces of this strength."""
        moment = self.moment * float(np.sqrt(1 - self.share**2))
        turning = replace(noise_model, moment=moment, lasting=self.lasting, tremor=self.tremor)
        along = replace(turning, force=self.force, floor=self.floor, bumps=self.bumps, body=self.body)
        return replace(along, mass=self.mass, lever=self.lever, stroke=self.stroke)


def strength(
    evidence: Evidence, chair: Mapping[str, float], noise_model: NoiseModel, about: Strength | None = None
) -> Strength:
    """The most likely strength, given evidence of one model with its filters, whose noise is `noise_model` but for forces; zero
    where the readings ask for none.

    What turns a `chair` says how uneven a floor is: a slope to the side pulls at the CM, before the axle. Along the heading a
    body pushes as well, and readings hardly tell the two apart. So the moment is found without a floor, and what there is
    along the heading beside a floor that is as steep along the way, and as bumpy: what pushes one rear wheel turns the chair
    by half the distance between the two, and what pushes the other as well. What turns it is all the floor's, unless an
    accelerometer tells how much is, from the first: it feels what else turns a chair to the side, and no gravity, and would
    deny a floor. The search begins `about` a strength, where one is known that is nearly it. Uncertain clocks and baselines
    of runs are taken as they are.
    """
    t_r, mass, lever = chair["chair.t_r"], chair["chair.m"], max(chair["chair.b"], NEAR)
    pushed = stroke(*(e.run for e in evidence.runs))
    none = Strength(0.0, 0.0, 0.0, 0.0, stroke=pushed, mass=mass, lever=lever)
    by_forces = parallel_map(lambda e: _by_forces(e, none, noise_model, t_r), evidence.runs)

    def deviances(strengths: Sequence[Strength]) -> np.ndarray:
        ratios = np.array([[getattr(s, name) for name in SIZES] for s in strengths]) / USUAL
        told = parallel_map(lambda asked: asked[1](asked[0]), product(strengths, by_forces))
        return np.sum(np.reshape(told, (len(strengths), -1)), axis=1) + 2 * np.sum(ratios, axis=1)

    starts = [*_starts(none, about)]
    without, *tried = deviances([none, *starts])
    if min(tried) > without:
        return none
    told = any(ASIDE in e.channels for e in evidence.runs)
    begun = replace(starts[int(np.argmin(tried))], share=PARTLY if told else 0.0)
    found, least = _likeliest(deviances, begun, (*SIZES, "lasting", *(("share",) if told else ())))
    uneven = _felt(found)
    if uneven.moment or uneven.tremor:
        begun = replace(found, share=found.share if told else 1.0, bumps=uneven.tremor / (t_r / 2))
        found, least = _likeliest(deviances, begun, ("force", "body", *(("moment", "lasting", "share") if told else ())))
    return replace(_felt(found), fall=float(without - least))


def _felt(found: Strength) -> Strength:
    """The same without what is next to nothing."""
    sizes = {name: float(getattr(found, name)) for name in SIZES}
    felt = {n: sizes[n] if sizes[n] > LITTLE * usual else 0.0 for n, usual in zip(SIZES, USUAL, strict=True)}
    return replace(found, **felt)


def _starts(none: Strength, about: Strength | None) -> Iterator[Strength]:
    """From where a search may begin: what is known already, none of it so small that nothing draws it up, or else anywhere."""
    if about:
        known = [getattr(about, name) for name in SIZES]
        at: Sequence[np.ndarray] = [np.maximum(known, LITTLE * USUAL)]
        none = replace(none, lasting=about.lasting)
    else:
        at = [sizes * USUAL for sizes in np.array(START)]
    for sizes in at:
        yield replace(none, **dict(zip(SIZES, map(float, sizes), strict=True)))


def _likeliest(
    deviances: Callable[[Sequence[Strength]], np.ndarray], begun: Strength, by: Sequence[str]
) -> tuple[Strength, float]:
    """The strength with the least deviance, as those of its figures change that are named, and that deviance."""
    sizes = {name: (LEAST * usual, MOST * usual) for name, usual in zip(SIZES, USUAL, strict=True)}
    limits = {**sizes, "lasting": LASTING, "share": SHARES}

    def at(logs: np.ndarray) -> Strength:
        return replace(begun, **dict(zip(by, map(float, np.exp(logs)), strict=True)))

    bounds = np.log([limits[name] for name in by])

    def with_slopes(logs: np.ndarray) -> tuple[float, np.ndarray]:
        """The deviance, and its slopes, away from bounds, all of which are found side by side."""
        beside = np.where(logs + NEARBY < bounds[:, 1], NEARBY, -NEARBY)
        here, *there = deviances([at(logs), *(at(one) for one in logs + np.diag(beside))])
        return float(here), (np.array(there) - here) / beside

    begun_at = [np.log(getattr(begun, name)) for name in by]
    found = minimize(with_slopes, begun_at, jac=True, method="L-BFGS-B", bounds=bounds, options={"ftol": PRECISE})
    return at(found.x), float(found.fun)


def acting(likelihood: Likelihood, values: Mapping[str, float]) -> tuple[Strength, Evidence]:
    """How strong the forces are that a model needs at these values, and evidence of the fitted runs, where the chair rolls,
    about the path that these forces lead to.

    A model that lacks much goes another way than the chair did, and slopes along that say little of how a force would bring it
    back. So forces are estimated, the model is led by them, and the strength is estimated anew from there.
    """
    likelihood, chair = likelihood.led(moving(likelihood.campaign)), likelihood.chair(values)
    force, moment, body, tremor = USUAL
    found = Strength(force, moment, body, 0.0, tremor=tremor, mass=chair[MASS])
    likelihood = likelihood.with_noise_model(found.put_into(likelihood.noise_model))
    for _ in range(ROUNDS):
        evidence = likelihood.evidence(likelihood.campaign.fit, values, tune_start=1)
        known = found if found.fall else None
        before, found = found, strength(evidence, chair, likelihood.noise_model, known)
        if not found.fall or _alike(before, found):
            break
        likelihood = likelihood.continued(evidence).with_noise_model(found.put_into(likelihood.noise_model))
    return found, evidence


def _alike(one: Strength, other: Strength) -> bool:
    pairs = [(getattr(one, name), getattr(other, name)) for name in (*SIZES, "floor")]
    return all(abs(a - b) <= CLOSE * max(a, b) for a, b in pairs)


def disturbed(e: RunEvidence, noise_model: NoiseModel, t_r: float) -> tuple[Whitener, np.ndarray]:
    """The filter of a run with forces as strong as `noise_model` has them, and where (nx,) it expects the true start, less the
    simulated one."""
    filter_ = e.filter.whitener.disturbed(_forces(e, noise_model, t_r))
    return filter_, e.offset[: filter_.size[0]]


def _forces(e: RunEvidence, noise_model: NoiseModel, t_r: float) -> Disturbance:
    """Forces as changes of the inputs that the filter of a run has noise for."""
    alone = pushes_of(e.run)
    inputs = alone if len(alone) == e.filter.whitener.recorded else pushes_of(e.run, led=True)
    swinging = noise_model.swung(e.effort)
    return disturbance(noise_model, inputs, t_r, swinging=swinging, speed=e.pace, readings=e.channels)


def _by_forces(e: RunEvidence, none: Strength, noise_model: NoiseModel, t_r: float) -> Callable[[Strength], float]:
    """−2 log likelihood of a run, but for a constant, by how strong forces are, of which there are `none` of a chair."""
    every, filter_ = replace(none, body=1.0), e.filter.whitener
    forces = _forces(e, every.put_into(noise_model), t_r)
    deviance = ByForces(filter_, forces, e.measured - e.foretold, e.offset[: filter_.size[0]])

    def of(strength: Strength) -> float:
        among = strength.put_into(noise_model)
        return deviance(*strong_and_lasting(among, among.swung(e.effort), e.pace))

    return of
