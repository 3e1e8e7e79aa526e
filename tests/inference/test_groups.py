"""Effects that show only together: found as one, judged as an effect of several parameters, parted where one does all."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace as Some

import casadi as cs
import numpy as np
import pytest

from benchmarks.independent.campaigns import make
from wheelchair_fmu.campaign import read
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.evidence.evidence import Evidence
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.models.factory import ModelFactory, groups_of
from wheelchair_fmu.inference.models.hypothesis import Model
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.search import joint
from wheelchair_fmu.inference.search.beginning import begin
from wheelchair_fmu.inference.search.joint import parted
from wheelchair_fmu.inference.search.judge import judge
from wheelchair_fmu.inference.search.screen import _secants, screen_groups
from wheelchair_fmu.inference.search.search import searched
from wheelchair_fmu.inference.search.selection import Selection
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.stage import Effect, adds
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.quantities import N_S_M, RAD, Parameter

ANGLE = Parameter("angle", RAD, "how far both lean", off=0.0, smallest_interesting=0.02, lower=0.0, upper=0.5, source="chosen")
DRAG = Parameter(
    "k", N_S_M, "drag for each radian", off=0.0, smallest_interesting=20.0, lower=0.0, upper=2000.0, source="chosen"
)
LEAN = Effect("lean", "wheels that lean", (ANGLE,), (adds("phi", lambda angle: cs.vertcat(angle, angle)),))
RUBS = Effect(
    "rubs", "a lean that drags", (DRAG,), (adds("F_x", lambda k, phi, u: -k * cs.sum1(phi) * u / 2),), through=("lean",)
)
OTHERS = ("gyro_bias", "floor_cross_slope")
TOGETHER = "lean+rubs"
ANGLE_NAME, DRAG_NAME = "effect.lean.angle", "effect.rubs.k"
SIZES = {ANGLE_NAME: 0.04, DRAG_NAME: 40.0}


def chair(rubs: Effect = RUBS) -> Variant:
    return Variant(catalogue={"lean": LEAN, rubs.id: rubs, **{e: bundled()[e] for e in OTHERS}})


def measured(sample, values, rubs: Effect = RUBS):
    """Five runs of the sample campaign, as a chair with these sizes would have gone, read with its noise. A lean by itself
    hardly turns it, as its tyres take little camber thrust."""
    rng, runs = np.random.default_rng(4), []
    given = replace(sample, known={**sample.known, "tyre.C_phi": 20.0, "tyre.C_m_phi": 0.0})
    likelihood = Likelihood(given, chair(rubs).with_effects(["lean", rubs.id]))
    for run in (*given.fit[:4], given.holdout[0]):
        channels, _, true = likelihood.readings(run, values, likelihood.begins[run.name].start)
        read = {c: v + rng.normal(0, given.noise[c], len(v)) for c, v in zip(channels, true.T, strict=True)}
        runs.append(replace(run, channels=read))
    return replace(given, runs=tuple(runs))


@pytest.fixture(scope="module")
def leaning(sample):
    return measured(sample, SIZES)


@pytest.fixture(scope="module")
def begun(leaning):
    return begin(Models.of(ModelFactory(leaning, chair())))


@pytest.fixture(scope="module")
def first(begun):
    return searched(begun.models, begun.calibrated)


def test_groups_are_what_records_say():
    assert groups_of(bundled()) == {
        "caster_trail+caster_friction": ("caster_trail", "caster_friction"),
        "caster_trail+caster_inertia": ("caster_trail", "caster_inertia"),
    }
    assert not groups_of({"caster_friction": bundled()["caster_friction"]}), "through nothing that is there"


def test_every_effect_that_one_acts_through_is_in_the_catalogue():
    assert {other for effect in bundled().values() for other in effect.through} <= set(bundled())


def test_a_member_is_tried_beside_those_that_it_acts_through():
    """Of what two sizes do only as a product each is nothing alone; one by one the second does all."""
    w = np.array([1.0, -2.0, 0.5])
    factory = Some(
        members=lambda e: ("lean", "rubs") if e == TOGETHER else (e,),
        parameters=lambda e: tuple(n for n in SIZES if e in (TOGETHER, n.split(".")[1])),
        linear=lambda e: e != TOGETHER,
        records={p.name: p for effect in (LEAN, RUBS) for p in effect.owned},
        unfitted=lambda names: np.zeros(len(names)),
    )
    product = Some(resimulated=lambda known, at, whole: Some(r=-at.get(ANGLE_NAME, 0.0) * at.get(DRAG_NAME, 0.0) * w))
    known = Some(r=0 * w)
    (S,) = _secants(factory, product, known, {}, TOGETHER)
    np.testing.assert_allclose(S, np.stack([0 * w, ANGLE.smallest_interesting * w], axis=1))
    (alone,) = _secants(factory, product, known, {}, "rubs")
    np.testing.assert_allclose(alone, 0)


@pytest.mark.nightly
def test_a_group_has_the_parameters_of_its_members(begun):
    assert begun.models.factory.parameters(TOGETHER) == tuple(SIZES)
    assert set(SIZES) <= set(begun.models.likelihood([TOGETHER]).records)


@pytest.mark.nightly
def test_a_group_promises_what_no_member_does(begun, first):
    alone, joined = screen_groups(begun.models, first.model)
    promised = {s.score.effect: s.score.likelihood_ratio for s in (*alone, *joined)}
    assert [s.score.effect for s in joined] == [TOGETHER]
    assert promised["rubs"] < 1e-6 and promised[TOGETHER] > 5 * promised["lean"]
    again, none = screen_groups(begun.models, replace(first.model, effects=("lean",)))
    assert not none and "rubs" in {s.score.effect for s in again}, "beside one of them the other is an effect like any"


@pytest.mark.nightly
def test_a_group_is_found_as_an_effect_of_several_parameters(first):
    (group,) = first.groups
    assert first.winner is group
    assert group.matters and group.p < 1e-6 and len(group.estimate) == 2
    assert np.all(np.abs(group.estimate - list(SIZES.values())) < 3 * group.se)
    assert not any(c.matters and c.effect in ("lean", "rubs") for c in first.candidates)


@pytest.mark.nightly
def test_its_members_are_put_in_one_by_one_and_named(leaning):
    found = diagnose(leaning, chair())
    assert found.verdict == "missing" and set(found.effects) == {"lean", "rubs"}
    assert [s.name for s in found.ladder[:2]] == ["nominal", "calibrated"]
    assert [s.name for s in found.ladder[2:]] == ["+lean", "+rubs"], "alone, the other does nothing"
    assert found.ladder[-1].left < 1.05
    assert all(found.beliefs[e].large > 0.9 for e in found.effects)


@pytest.mark.nightly
def test_a_group_of_which_one_does_all_comes_to_that_one(sample):
    """A drag that needs no lean, found with one."""
    alone = replace(RUBS, id="rubs_alone", contributions=(adds("F_x", lambda k, u: -k * u / 50),))
    size = "effect.rubs_alone.k"
    begun = begin(Models.of(ModelFactory(measured(sample, {size: 40.0}, alone), chair(alone))))
    models, base = begun.models, begun.calibrated
    now = searched(models, base)
    group = "lean+rubs_alone"
    whole = Model(("lean", "rubs_alone"), models.refit(("lean", "rubs_alone"), base.fit.values), base.heldout)
    judged = judge(models, base, whole, group, models.factory.parameters(group), 1)
    (r,) = parted(models, replace(now, candidates=()), judged)
    assert r.effects == () and [c.effect for c in r.candidates] == ["rubs_alone"]
    assert r.candidates[0].estimate[0] == pytest.approx(40.0, abs=3 * r.candidates[0].se[0])


def test_a_start_whose_slopes_are_beyond_all_numbers_leads_nowhere(tmp_path, monkeypatch):
    """Casters with a sharp friction, no trail and an inertia flip by chance, each time another way for any change."""
    campaign = read(make(tmp_path / "slow", {}, manoeuvres="slow", seed=3))
    models, base, *_ = Models.of(ModelFactory(campaign, Variant())).calibrated()
    group = ("caster_friction", "caster_inertia", "caster_trail")
    sizes = {"caster_friction.M": 0.2, "caster_friction.rate": 0.002, "caster_inertia.I": 0.005, "caster_trail.c": 0.0}
    values = base.fit.values | {f"effect.{name}": size for name, size in sizes.items()}
    start = Some(theta=[values[n] for n in models.names(group)])
    monkeypatch.setattr(joint, "most_promising", lambda *_: [start])
    with np.errstate(all="ignore"):
        assert joint._fitted(models, base, group, group) is None


def test_a_step_of_a_group_is_judged_as_by_whoever_simulates_it():
    """And not along the starts and pushes that other models were fitted from, by which one model had two numbers."""
    asked = []

    def evidence(runs, values, tune_start):
        asked.append((runs, values, tune_start))
        return Evidence((), ())

    models = Some(campaign=Some(fit=1, holdout=2), likelihood=lambda effects: Some(evidence=evidence))
    models.fitted = lambda effects, start: Some(values={"x": 3.0})
    selection = Selection(models, Some(effects=()), (), 0.0, lambda ladder: None)
    step = selection._passed(Some(effects=("caster_inertia", "caster_trail"), fit=Some(values={})), 1)
    assert step.name == "+caster_inertia" and step.values == {"x": 3.0}
    assert asked == [(1, {"x": 3.0}, 2), (2, {"x": 3.0}, 2)]


def test_effects_of_one_law_are_tried_with_its_constants_as_records_have_them(sample):
    """A bearing whose friction sets in within no swivel rate at all is a switch, which takes a thousand steps a sample."""
    w = ModelFactory(sample, Variant())
    rate = "effect.caster_friction.rate"
    (casters,) = joint.kin(w)
    tried = joint.tries(w, casters, 125)
    assert {one[rate] for one in tried} == {w.records[rate].default}
    assert {one["effect.caster_friction.M"] for one in tried} >= {0.0, w.records["effect.caster_friction.M"].delta}


def test_a_group_that_no_record_names_has_its_members_all_the_same(sample):
    w = ModelFactory(sample, Variant())
    several = ("caster_friction", "caster_inertia", "caster_trail")
    group = "+".join(several)
    assert group not in w.groups and w.members(group) == several and not w.linear(group)
    assert set(w.estimated(group)) == {n for e in several for n in w.estimated(e)}
