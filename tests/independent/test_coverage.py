"""A short piece of `make bench-diagnosis`: intervals of what was found hold what was hidden."""

from __future__ import annotations

import pytest

from benchmarks.diagnosis.cases import Case
from benchmarks.diagnosis.table import by_size, calibration, covered_by, false_alarm, first, named, probabilities
from benchmarks.diagnosis.trial import trial
from benchmarks.independent.chair import Chair
from benchmarks.independent.hidden import EFFECTS


@pytest.mark.nightly
@pytest.mark.parametrize(("noise", "seed"), [("white", 1), ("ar1", 2)])
def test_a_patch_that_is_held_where_its_wheel_stands_is_named(noise, seed):
    """A brush that slides where its bristles are twisted too far, in pushes of one hand; casters are named beside."""
    found = trial(Case("effect", ("pivot_torque",), 3.0, noise, "one-handed", seed=seed), with_baselines=False)
    assert "pivot_torque" in named(found) and found["verdict"] in ("missing", "tie")
    nothing = trial(Case("null", (), 0.0, noise, "one-handed", seed=seed), with_baselines=False)
    assert "pivot_torque" not in named(nothing)


@pytest.mark.nightly
@pytest.mark.parametrize("effect", ["gyro_bias", "wheel_radius_error"])
def test_intervals_hold_what_was_hidden(effect):
    """Profile likelihood and block bootstrap, where both simulators mean the same by a parameter; seed 1 of the benchmark."""
    found = trial(Case("effect", (effect,), 3.0, seed=1), with_baselines=False)

    assert named(found) == {effect}
    for kind in ("profile", "bootstrap"):
        inside = covered_by(found, kind)
        assert inside and all(inside)
        for name in found["true"][effect]:
            low, high = found["intervals"][kind][f"effect.{effect}.{name}"]
            assert high - low < EFFECTS[effect].parameters[name].delta  # and say something


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("effect", "only"), [("turn_slip", ""), ("stroke_motion", ""), ("trunk_motion", "swing"), ("marker_offset", "")]
)
def test_what_real_chairs_do_is_named_at_three_times_what_is_of_interest(effect, only):
    found = trial(Case("effect", (effect,), 3.0, manoeuvres=EFFECTS[effect].sees, seed=21, only=only), with_baselines=False)
    assert effect in named(found) and found["verdict"] in ("missing", "tie")
    tied = {e for group in found["ties"] if effect in group for e in group}
    assert named(found) <= {effect, *tied, *found["own"]}


@pytest.mark.nightly
def test_what_bends_a_given_value_is_looked_for_though_the_error_is_noise():
    case = Case("effect", ("inflation_pressure",), 3.0, manoeuvres="pressure", seed=733)
    found = trial(case, with_baselines=False)
    assert (found["verdict"], found["found"]) == ("missing", ["inflation_pressure"])
    assert not any("where the search stops" in note for note in found["notes"])


def test_what_every_chair_has_is_part_of_the_truth():
    trail = Case("effect", ("caster_trail",), 3.0, manoeuvres="slow")
    assert trail.true == {"caster_trail": {"c": pytest.approx(Chair().trail + 3 * 0.03)}}
    assert Case("effect", ("caster_inertia",), 3.0, manoeuvres="slow").true == {"caster_inertia": {"I": pytest.approx(0.015)}}
    said = {"verdict": "missing", "found": ["caster_trail"], "ties": [], "order": ["caster_trail", "caster_inertia"]}
    trial = {**said, "effects": ["caster_inertia"], "own": trail.own}
    assert first(trial) and not false_alarm(trial)
    assert false_alarm({**trial, "own": ()}) and false_alarm({**trial, "found": ["caster_trail", "gyro_bias"]})


def test_trials_are_told_by_size_and_noise_each_once():
    trials = [{"times": times, "noise": noise} for times in (1.0, 3.0, 1.0) for noise in ("ar1", "white")]
    told = by_size(trials)
    assert [size for size, _ in told] == [f"{times} δ, {noise} noise" for times in (3, 1) for noise in ("white", "ar1")]
    assert [len(some) for _, some in told] == [1, 1, 2, 2]


def test_probabilities_are_tallied_against_what_was_hidden():
    """Every chair's casters have a trail, whatever was hidden. At δ itself an effect is neither larger nor smaller."""
    hidden = {"kind": "effect", "effects": ["gyro_bias"], "times": 3.0}
    said = {"gyro_bias": 0.96, "gyro_scale": 0.04, "caster_trail": 0.99, "turn_slip": None}
    quarter = {**hidden, "times": 0.25, "probabilities": {"gyro_bias": 0.02}}
    others = [{**hidden, "times": 1.0, "probabilities": said}, {**hidden, "kind": "left-out", "probabilities": said}]
    told = probabilities([{**hidden, "probabilities": said}, quarter, *others])
    assert told == [(0.96, True), (0.04, False), (0.02, False)]
    assert calibration(told) == [
        ("  larger than δ with 0.01 to 0.1", "0 of 2 (0.0%)", "3.0% said"),
        ("  larger than δ with 0.95 to 1", "1 of 1 (100.0%)", "96.0% said"),
    ]
