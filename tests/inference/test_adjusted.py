"""Constants of effects in which chairs differ: adjusted with the effect, by a prior, and paid for."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import quad

from benchmarks.independent.campaigns import make
from wheelchair_fmu.campaign import read
from wheelchair_fmu.errors import SimulationError
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.estimation.problem import prior_of
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.search.judge import _paid, judge
from wheelchair_fmu.inference.search.usual import usual
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.generic import library
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies.measured import PREDICTS

SWING, FREQUENCY, DAMPING = (f"effect.trunk_motion.{name}" for name in ("swing", "frequency", "damping"))
BODY = {SWING: 0.02, FREQUENCY: 1.0, DAMPING: 0.15}
CATALOGUE = {"trunk_motion": bundled()["trunk_motion"]}


@pytest.fixture(scope="module")
def swinging(sample):
    """Two runs of the chair with a rider whose body swings as BODY says."""
    likelihood = Likelihood(sample, Variant().with_effects(["trunk_motion"]))
    return simulated(likelihood, sample, (sample.fit[0], sample.fit[2]), BODY)


def simulated(likelihood, sample, runs, values):
    """The campaign with these runs alone, as a chair with such values would have been recorded on them."""
    chance, recorded = np.random.default_rng(4), []
    names = [o.name for o in likelihood.variant.model().outputs]
    for run in runs:
        (e,) = likelihood.evidence([run], values).runs
        read_off = {c: e.results[:, names.index(PREDICTS[c])] for c in run.channels}
        channels = {c: v + chance.normal(0, sample.noise[c], len(v)) for c, v in read_off.items()}
        recorded.append(replace(run, channels=channels))
    return replace(sample, runs=tuple(recorded))


def test_a_fit_finds_the_frequency_at_which_a_rider_swings(swinging):
    models = Models.of(ModelFactory(swinging, Variant(catalogue=CATALOGUE)))
    assert FREQUENCY not in models.factory.parameters("trunk_motion")  # which says nothing of how large the effect is
    assert FREQUENCY not in models.names(()) and FREQUENCY in models.names(("trunk_motion",))
    found = models.fitted(("trunk_motion",), {SWING: 0.005})
    errors = dict(zip(found.names, np.sqrt(np.diag(found.covariance)), strict=True))
    for name, true in BODY.items():
        assert found.values[name] == pytest.approx(true, abs=3.5 * errors[name]), name
    assert errors[FREQUENCY] < 0.05
    assert found.evidence.rms == pytest.approx(1, abs=0.05)


def test_a_constant_that_a_variant_gives_is_what_is_known_of_it(swinging):
    own = Variant(catalogue=CATALOGUE).with_effects(["trunk_motion"]).with_values({FREQUENCY: 2.5, SWING: 0.01})
    factory = ModelFactory(swinging, own)
    assert factory.given == {SWING: 0.01} and factory.variant.values[FREQUENCY] == 2.5
    fixed = ModelFactory(swinging, own, fixed=[FREQUENCY])
    assert FREQUENCY not in fixed.estimated("trunk_motion")


def test_an_inertia_that_nobody_gave_is_known_as_well_as_chairs_are_alike(sample):
    def sd(campaign, chair):
        return prior_of(Likelihood(campaign, chair, columns=()), ["chair.I_z"]).sd[0]

    unknown = replace(sample, known={n: v for n, v in sample.known.items() if n != "chair.I_z"})
    assert sd(sample, Variant()) == pytest.approx(0.3 * sample.known["chair.I_z"])
    assert sd(unknown, Variant().with_values({"chair.I_z": 5.0})) == pytest.approx(0.3 * 5.0)
    assert sd(unknown, Variant()) == 3.0
    assert sd(replace(unknown, priors={"chair.I_z": 0.2}), Variant()) == 0.2


@pytest.mark.parametrize("told", [0.0, 3.0, 400.0])
def test_what_is_paid_for_a_constant_is_its_integral(told):
    """∫ N(κ; 0, s²) e^(−½ a (κ − κ̂)²) dκ beside the integrand's greatest value, where the size is known."""
    s, best = 0.3, 0.2
    information = np.array([[50.0, 0.4 * np.sqrt(50 * told)], [0.4 * np.sqrt(50 * told), told]])
    information[1, 1] += s**-2
    fit = SimpleNamespace(
        names=("effect.a.size", "effect.a.constant"), covariance=np.linalg.inv(information), prior_slopes=np.diag([0.0, 1 / s])
    )

    def likely(k):
        return np.exp(-0.5 * told * (k - best) ** 2 - 0.5 * (k / s) ** 2)

    mode = told * best / (told + s**-2)
    integral = quad(likely, -4 * s, 4 * s, epsabs=1e-12, points=[mode])[0] / (s * np.sqrt(2 * np.pi))
    assert np.exp(-0.5 * _paid(fit, ["effect.a.size"], fit.covariance)) == pytest.approx(integral / likely(mode), rel=1e-3)


def test_the_fall_of_an_effect_is_less_by_what_is_paid_for_its_constants(swinging):
    models = Models.of(ModelFactory(swinging, Variant(catalogue=CATALOGUE)))
    base, found = models.model((), {}), models.model(("trunk_motion",), {SWING: 0.01})
    names = models.factory.parameters("trunk_motion")
    paid = _paid(found.fit, names, usual(models, found, names).moved(found.fit.covariance))
    judged = judge(models, base, found, "trunk_motion", names, 1)
    assert paid > 2
    assert judged.likelihood_ratio * judged.dispersion == pytest.approx(base.fit.deviance - found.fit.deviance - paid)


TORQUE, LENGTH = "effect.turn_slip.M", "effect.turn_slip.L"


@pytest.fixture(scope="module")
def patches(sample):
    """Runs of the chair on patches of twice the usual length that resist being turned."""
    catalogue = {"turn_slip": bundled()["turn_slip"]}
    likelihood = Likelihood(sample, Variant(catalogue=catalogue).with_effects(["turn_slip"]))
    return catalogue, simulated(likelihood, sample, sample.fit[2:6], {TORQUE: 2.5, LENGTH: 1.2})


def test_a_size_counts_as_by_the_usual_law_it_would_have_to_be_to_do_as_much(patches):
    """A fit that may not adjust the length has that size, and knows it as well: what runs show is what a patch does."""
    catalogue, campaign = patches
    free, fixed = (Models.of(ModelFactory(campaign, Variant(catalogue=catalogue), fixed)) for fixed in ((), {LENGTH}))
    own, plain = (models.model(("turn_slip",), {TORQUE: 1.0}) for models in (free, fixed))
    names, covariance = free.factory.parameters("turn_slip"), own.fit.covariance
    at_usual, as_is = usual(free, own, names), usual(fixed, plain, names)
    assert as_is.size[0] == plain.fit.values[TORQUE] and np.array_equal(as_is.slopes, np.eye(len(plain.fit.names)))
    assert own.fit.values[LENGTH] > 0.9 and own.fit.values[TORQUE] < 0.8 * plain.fit.values[TORQUE]
    assert at_usual.size[0] == pytest.approx(plain.fit.values[TORQUE], rel=0.05)
    errors = [
        float(np.sqrt(u.moved(m.fit.covariance)[at, at]))
        for u, m in ((at_usual, own), (as_is, plain))
        for at in [m.fit.names.index(TORQUE)]
    ]
    assert errors[0] == pytest.approx(errors[1], rel=0.2)
    # At one such size hardly anything tells the length.
    assert _paid(own.fit, names, at_usual.moved(covariance)) < _paid(own.fit, names, covariance) - 0.1
    assert errors[0] < 0.9 * np.sqrt(np.diag(covariance)[own.fit.names.index(TORQUE)])


def test_what_the_lack_of_an_effect_costs_is_no_less_for_a_constant_that_trades_with_its_size(patches):
    """Where other values may go no further, whether the length is fitted or known."""
    catalogue, campaign = patches
    costs = []
    for fixed in ((), {LENGTH}):
        models = Models.of(ModelFactory(campaign, Variant(catalogue=catalogue), fixed))
        base, found = models.model((), {}), models.model(("turn_slip",), {TORQUE: 1.0})
        costs.append(judge(models, base, found, "turn_slip", models.factory.parameters("turn_slip"), 1).bounded)
    assert costs[0] == pytest.approx(costs[1], rel=0.3)


def test_a_size_of_none_and_one_of_a_model_that_cannot_run_by_the_usual_law_are_as_they_are(patches, monkeypatch):
    catalogue, campaign = patches
    models = Models.of(ModelFactory(campaign, Variant(catalogue=catalogue)))
    found, names = models.model(("turn_slip",), {TORQUE: 1.0}), models.factory.parameters("turn_slip")
    none = replace(found, fit=replace(found.fit, values={**found.fit.values, **dict.fromkeys(names, 0.0)}))
    assert not usual(models, none, names).size.any()

    def fails(*words, **options):
        raise SimulationError

    monkeypatch.setattr(Likelihood, "evidence", fails)
    assert usual(models, found, names).size[0] == found.fit.values[TORQUE]


@pytest.mark.nightly
@pytest.mark.parametrize(
    "hidden",
    [
        {"trunk_motion": {"swing": 0.015}},
        {"trunk_motion": {"amplitude": 0.03}},
        {"caster_friction": {"M": 0.15}, "floor_cross_slope": {"theta": 0.003}},
    ],
    ids=[
        "a body that swings",
        "a body that leans, and has no swing to tell the constants of",
        "bearings that stick, on a cross-slope",
    ],
)
def test_what_another_chair_does_in_its_own_way_is_named(hidden, tmp_path):
    """The other simulator's rider swings at 1.09 Hz, and its bearings' friction builds up over 0.05 rad/s."""
    found = diagnose(read(make(tmp_path / "campaign", hidden, seed=41, redraw=41000)), generic=library())
    assert found.verdict == "missing" and set(hidden) <= set(found.effects) <= {*hidden, "caster_trail"}
    assert max(found.ladder[-1].fit, found.ladder[-1].heldout) < 1.05
    assert not [c.record.name for c in found.calibration if c.beyond]
