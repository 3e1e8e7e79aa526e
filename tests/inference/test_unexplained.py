"""What orders a force that nobody recorded: what does is told, and where nothing does, nothing is."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.api.lacking import missing
from wheelchair_fmu.campaign.strokes import begun, phase
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.estimation.problem import Fit
from wheelchair_fmu.inference.evidence.disturbance import Strength, strength
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.evidence.noise_model import NoiseModel
from wheelchair_fmu.inference.residual.panel import against
from wheelchair_fmu.inference.residual.unexplained import CONSTANT, Missing, Order, Unexplained, _lone, unexplained
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant

from .forces import CHAIR, ridden, wandering


def left_of(campaign):
    """What the chair of the sample lacks on a campaign, as it is given."""
    likelihood = Likelihood(campaign, Variant())
    evidence = likelihood.evidence(campaign.fit, {}, ())
    needed = strength(evidence, CHAIR, NoiseModel({}))
    return unexplained(likelihood, Fit((), {}, np.zeros((0, 0)), evidence, 0.0, np.zeros((0, 0))), needed, needed, evidence)


def spring(run, without):
    return 0 * run.time, -2.0 * (without["caster.fl"] + without["caster.fr"]) / 2


def lumpy(run, without):
    """A flat spot: the drag goes up once a turn of the left wheel."""
    angle = np.cumsum(without["sensor.wheel_speed_l"] * np.gradient(run.time)) / 0.31
    return 4 * np.cos(angle), 0 * run.time


def swung(run, without):
    """A body swings once in each stroke, also while no hand pushes."""
    pushed = run.inputs["push.F_rl"] + run.inputs["push.F_rr"]
    return 6 * np.nan_to_num(np.sin(2 * np.pi * phase(run.time, pushed) + 1.0)), 0 * run.time


def to_one_side(run, without):
    return 0 * run.time, 0.4 + 0 * run.time


@pytest.mark.parametrize(
    ("forces", "of", "by"),
    [(spring, "moment", "caster angle"), (lumpy, "force", "left wheel's angle"), (to_one_side, "moment", "constant")],
)
def test_what_a_force_goes_with_is_told(sample, forces, of, by):
    found = left_of(ridden(sample, np.random.default_rng(1), forces))
    assert found.orders and (found.orders[0].of, found.orders[0].by) == (of, by)
    assert found.orders[0].share > 0.5
    assert any(w.startswith(f"The missing {of} ") for w in found.words)


def test_the_course_of_what_is_ordered_is_the_law_that_was_hidden(sample):
    """Shrunk to nothing by no more than a third, as each moment's readings tell it."""
    found = left_of(ridden(sample, np.random.default_rng(1), spring)).orders[0].panel
    assert (found.variable, found.unit) == ("mean caster angle", "rad")
    slope, level = np.polyfit(found.knots, found.estimate, 1, w=1 / found.se)
    assert -2.1 < slope < -1.3 and abs(level) < 0.1
    assert np.all(np.abs(found.estimate - np.polyval((slope, level), found.knots)) < 4 * found.se + 0.05)


def test_a_course_has_standard_errors_by_how_far_runs_have_it_apart():
    rng, runs = np.random.default_rng(2), 400
    by, apart = [rng.uniform(-1, 1, 60) for _ in range(runs)], rng.normal(0, 0.5, runs)
    found = against("speed", "m/s", by, [3 * x + a for x, a in zip(by, apart, strict=True)])
    assert found.estimate == pytest.approx(3 * found.knots, abs=0.1)
    assert found.se == pytest.approx(0.5 / np.sqrt(runs), rel=0.2)
    alone = against("speed", "m/s", by[:1], [np.where(by[0] > 0, 3 * by[0], np.nan)])
    assert np.isnan(alone.se).all() and (alone.knots > 0).all() and np.isfinite(alone.estimate).all()


def test_what_swings_once_in_each_stroke_is_the_riders_body(sample):
    found = left_of(ridden(sample, np.random.default_rng(1), swung))
    assert found.after.body > 0.2 and found.after.along < 0.2 and found.orders == ()
    assert "a swing of the rider's body of " in found.words[0]


def test_what_orders_a_force_is_what_a_diagnosis_has_missing(sample):
    """For figures, also on the page: no term of any kind comes back with every turn of a wheel."""
    few = {effect: bundled()[effect] for effect in ("rolling_resistance_asymmetry", "aerodynamic_drag")}
    found = diagnose(ridden(sample, np.random.default_rng(1), lumpy), Variant(catalogue=few))
    told = missing(found)
    assert found.verdict == "outside" and told["words"] == "force along the chair" and told["unit"] == "N" and told["ordered"]
    course = told["panels"][0]
    assert course["variable"] == "left wheel's angle" and min(course["knots"]) > 0 and max(course["knots"]) < 2 * np.pi
    # Counted from a run's first row, less what has turned by its second.
    np.testing.assert_allclose(course["estimate"], 4 * np.cos(course["knots"]), atol=1.2)


def test_a_hand_on_the_rim_is_told_by_run_and_time(sample):
    def hand(run, without):
        held = (run.time > 3.4) & (run.time < 4.2) & (run.name == "slalom-slow")
        return -12.0 * held, 1.5 * held

    found = left_of(ridden(sample, np.random.default_rng(2), hand))
    assert {o.by for o in found.orders} == {"run"}
    assert all("is in slalom-slow from 2." in o.words or "is in slalom-slow from 3." in o.words for o in found.orders)
    for o, size in ((o, {"force": -12.0, "moment": 1.5}[o.of]) for o in found.orders):
        assert o.panel.variable == "time in slalom-slow" and len(o.panel.knots) <= 60
        held = (o.panel.knots > 3.6) & (o.panel.knots < 4.0)
        assert np.mean(o.panel.estimate[held]) == pytest.approx(size, rel=0.35)
        assert np.abs(o.panel.estimate[o.panel.knots > 5.5]).max() < 0.35 * abs(size)


def test_a_force_that_is_known_for_moments_only_is_not_said_to_be_in_one_run():
    """Where readings hardly tell it, it is not asked for; all of the little that is known lies in some part of some run."""
    time, rng = np.arange(0.0, 12.0, 0.02), np.random.default_rng(3)
    found = [Missing(name, time, {"force": wandering(rng, time, 2.0)}, {"force": 0 * time}) for name in "abcd"]
    whole = [m.values["force"] for m in found]
    hit = [v + 20.0 * ((time > 5) & (time < 6)) * (i == 1) for i, v in enumerate(whole)]
    glimpsed = [np.where((time > 5) & (time < 7) & (i == 1), v, np.nan) for i, v in enumerate(whole)]
    assert _lone("force", found, whole) is None and _lone("force", found, glimpsed) is None
    told = _lone("force", found, hit)
    assert told is not None and "is in b from 4." in told.words


@pytest.mark.parametrize("seed", [3, 4])
def test_a_floor_is_ordered_by_nothing(sample, seed):
    rng = np.random.default_rng(seed)
    found = left_of(ridden(sample, rng, lambda run, without: (wandering(rng, run.time, 2.5), wandering(rng, run.time, 0.4))))
    assert found.orders == () and found.like_a_floor
    assert "no effect is behind them" in found.words[1]
    shallow = [f"{size:.2g} {unit}" for size, unit in zip(found.after.whole, ("N", "N m"), strict=True)]
    assert all(figure in found.words[0] for figure in shallow)


def strokes(time, beginnings):
    return sum(60 * np.clip(np.sin(np.pi * (time - t) / 0.4), 0, None) * ((time >= t) & (time < t + 0.4)) for t in beginnings)


def test_strokes_begin_where_hands_begin_to_push_and_end_with_the_last():
    time, beginnings = np.arange(0, 8, 1 / 240), np.array([1.0, 2.1, 3.0, 4.2])
    noisy = strokes(time, beginnings) + np.random.default_rng(5).normal(0, 1.0, len(time))
    np.testing.assert_allclose(begun(time, noisy), beginnings, atol=0.1)
    found = phase(time, noisy)
    assert np.isnan(found[time < 0.9]).all() and np.isnan(found[time > 5.5]).all()
    pushing = (time > 1.2) & (time < 5.1)
    assert np.isfinite(found[pushing]).all() and found[pushing].min() >= 0 and found[pushing].max() <= 1


def test_a_coast_has_no_strokes():
    time = np.arange(0, 4, 0.01)
    assert begun(time, 0 * time).size == 0 and np.isnan(phase(time, 0 * time)).all()


def test_a_body_that_swings_is_told_in_newton_seconds_and_orders_nothing():
    forces, orders = (object(),), (Order("force", "stroke", 0.6, "the missing force is locked to the stroke"),)
    swings = Unexplained(Strength(20.0, 1.0, 9.0, 100.0), Strength(2.0, 0.3, 4.2, 50.0), orders, forces, 800.0, 0.2)
    assert swings.ordered == () and swings.like_a_floor
    assert "2 N, 0.3 N m and a swing of the rider's body of 4.2 N s" in swings.words[0]
    assert swings.words[1].startswith("These forces follow nothing else that was recorded")
    assert swings.as_json()["body"] == 4.2 and swings.as_json()["calibrated"]["body"] == 9.0


@pytest.mark.parametrize(("force", "counts"), [(2.0, False), (20.0, True)])
def test_what_stays_the_same_is_a_floors_where_that_is_flat(force, counts):
    same = (Order("force", CONSTANT, 0.6, "the missing force stays the same throughout"),)
    left = Unexplained(Strength(force, 0.1, 0.0, 9.0), Strength(force, 0.1, 0.0, 9.0), same, (object(),), 800.0, 0.2)
    assert (left.ordered == same) == counts


def test_the_largest_force_that_is_looked_at_may_be_larger():
    beyond, some = Strength(500.0, 100.0, 500.0, 1.0), Strength(146.0, 0.523, 0.0, 1.0)
    assert Unexplained(beyond, some, ()).words == [
        "As calibrated, the model needs at least 500 N, at least 100 N m and a swing of the rider's body of at least 500 N s "
        "that nobody recorded; in the end, 150 N and 0.52 N m."
    ]


def test_a_force_that_is_none_is_said_once():
    none, along = Strength(0.0, 0.0, 0.0, 0.0), Strength(0.4, 0.0, 0.0, 9.0)
    assert Unexplained(none, none, ()).words == ["The model needs no force and no moment that nobody recorded."]
    assert Unexplained(along, none, ()).words == [
        "As calibrated, the model needs 0.4 N that nobody recorded; in the end, no force and no moment."
    ]
