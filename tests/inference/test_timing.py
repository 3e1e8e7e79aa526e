"""A run whose pushes were recorded early or late is found, named and read in time; one that is right is not, and none is left
out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.independent.campaigns import make
from benchmarks.shifts import NIGHT, Case, less, shifted, with_shift
from tests.inference.conftest import among
from wheelchair_fmu.api.comparing import compared
from wheelchair_fmu.campaign import covered, read
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.evidence.evidence import Evidence
from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.preflight.timing import Late, by_model, by_signals, clocks, retimed, unlike_the_others
from wheelchair_fmu.inference.search.beginning import begin, late_by_slopes
from wheelchair_fmu.model.variant import Variant


@pytest.mark.parametrize(
    ("name", "seconds"),
    [
        pytest.param("random-steps", 1.3, marks=pytest.mark.nightly),
        ("coast-down", -0.05),
        ("slalom-quick", 0.1),
        ("holdout-random", 0.3),
    ],
)
def test_a_shifted_run_is_read_in_time(sample, name, seconds):
    begun = begin(Models.of(ModelFactory(with_shift(sample, Case(name, seconds)), Variant())))
    found = clocks(begun.calibrated.fit.evidence, begun.calibrated.heldout)
    assert set(found) == {name}
    late = found[name]["pushes"]
    assert late.seconds == pytest.approx(seconds, abs=0.01)
    side = "early" if seconds > 0 else "late"
    assert [n for n in begun.heard(found) if n.startswith(f"{name}: ") and f"too {side}" in n]
    assert [r.name for r in begun.models.campaign.runs] == [r.name for r in sample.runs]


@pytest.mark.nightly
def test_who_compares_reads_a_shifted_run_in_time(sample):
    as_it_is, shifted = (compared(c, Variant(), (), lambda words: None) for c in (sample, with_shift(sample, Case(*NIGHT[0]))))
    assert any(note.startswith(f"{NIGHT[0][0]}: its pushes were recorded") for note in shifted.notes)
    assert shifted.errors.rms() == pytest.approx(as_it_is.errors.rms(), rel=0.02)


def test_hands_that_push_against_each_other_tell_no_clock_by_what_their_sum_does(tmp_path):
    """In a spin the sum is noise: read 6.4 s earlier, and 22 times as large, it would do what long casters do to the chair."""
    assert by_signals(read(make(tmp_path / "spins", {"caster_trail": {"c": 0.09}}, manoeuvres="slow", seed=61))) == {}


def test_a_missing_effect_is_not_taken_for_a_shift(sample):
    likelihood = ModelFactory(sample, Variant()).likelihood()
    evidence = likelihood.evidence(sample.runs, {}, ())
    assert max(e.rms["yaw_rate"] for e in evidence.runs) > 3  # there is something to explain
    assert by_model(likelihood, evidence, {}) == {} and by_signals(sample) == {}


@pytest.mark.parametrize("late", [Late(1.2, 0.1), Late(-1.2, 0.1), Late(0.02, 0.03)])
def test_no_sample_is_used_whose_push_was_not_recorded(sample, late):
    for run in sample.runs:
        used = retimed(run, late)
        for off in (-late.sd, late.sd):
            recorded = used.time - late.seconds - off
            assert recorded[0] > run.time[0] - 1e-6 and recorded[-1] < run.time[-1] + 1e-6
        assert used.time[-1] - used.time[0] > run.time[-1] - run.time[0] - abs(late.seconds) - 2 * late.sd - 0.02


def test_one_run_that_is_unlike_all_others_is_named(sample):
    evidence = ModelFactory(sample, Variant()).likelihood().evidence(sample.runs, {}, ())
    quiet = [replace(e, r=e.r / np.sqrt(np.nanmean(e.r**2))) for e in evidence.runs]
    assert unlike_the_others(Evidence(tuple(quiet), ())) == ()
    odd = [replace(e, r=2.5 * e.r) if e.run.name == "slalom-slow" else e for e in quiet]
    (said,) = unlike_the_others(Evidence(tuple(odd[:4]), ()), Evidence(tuple(odd[4:]), ()))
    assert said.startswith(
        "slalom-slow: of this run the last model leaves 2.5 times the noise, and of no other one more than 1.00"
    )
    assert unlike_the_others(Evidence(tuple(replace(e, r=2 * e.r) for e in odd), ())) == (), "of others much is left as well"


def test_where_nobody_is_to_estimate_a_delay_none_is_looked_for(sample):
    """`--fix effect.push_force_delay.tau`."""
    models, base, *_ = Models.of(ModelFactory(sample, Variant(), fixed=["effect.push_force_delay.tau"])).calibrated()
    assert late_by_slopes(models, (), (), base.fit) == {}


def test_a_delay_that_all_runs_share_is_no_clock(sample):
    """It is the effect `push_force_delay`."""
    assert by_signals(replace(sample, runs=tuple(shifted(r, 0.05) for r in sample.runs))) == {}


def same_verdict(sample, name, seconds, chair=None):
    """The shift that `diagnose` says, None if none; the verdict is as without it."""
    found = diagnose(with_shift(sample, Case(name, seconds)), chair)
    assert found.verdict == "missing" and found.effects == ("rolling_resistance_asymmetry",)
    assert set(found.clocks) <= {name}
    return found.clocks[name]["pushes"].seconds if found.clocks else None


@pytest.mark.nightly
@pytest.mark.parametrize(("name", "seconds"), NIGHT)
def test_the_verdict_is_the_same_and_the_shift_is_told(sample, name, seconds):
    """Of 60 cases, which `python -m benchmarks.shifts` makes."""
    told = same_verdict(sample, name, seconds)
    assert told == pytest.approx(seconds, abs=0.01) or (told is None and abs(seconds) < 0.05)


@pytest.mark.nightly
def test_a_shift_leaves_the_verdict_that_the_same_run_leaves_without_it_whose_clock_is_as_unsure(sample):
    """This slalom less 1.3 s of its pushes, with a clock that is not known exactly: shifted, and as it is."""
    case = Case("slalom-slow", -1.3)
    found = diagnose(with_shift(sample, case))
    assert found.clocks[case.run]["pushes"].seconds == pytest.approx(case.seconds, abs=0.01)
    control = diagnose(less(sample, case, found.retimed[case.run].sd))
    assert (
        (found.verdict, found.effects) == (control.verdict, control.effects) == ("missing", ("rolling_resistance_asymmetry",))
    )
    assert found.final.values == pytest.approx(control.final.values, rel=0.01)


@pytest.mark.nightly
def test_where_the_push_that_tells_a_shift_was_not_recorded_the_run_is_named(sample):
    """This turn begins at 1 s. With pushes that begin at 1.3 s they are the same all along, at whatever time they are read:
    what is left of the run where all of them could have been tells as much as without a shift."""
    case = Case("steady-right", 1.3)
    found = diagnose(with_shift(sample, case))
    assert found.clocks == {} and found.effects[:1] == ("rolling_resistance_asymmetry",)
    assert found.verdict == "outside" and any(
        "is in steady-right from 0.0 to 2.0 s" in words for words in found.unexplained.words
    )
    control = with_shift(sample, case)
    settled = [covered(run, 1.6) if run.name == case.run else run for run in control.runs]
    assert same_verdict(replace(control, runs=tuple(settled)), "coast-down", 0.0) is None


@among("rolling_resistance_asymmetry", "push_force_delay", "gyro_bias", "camber_misalignment")
@pytest.mark.parametrize(
    ("name", "seconds"),
    [
        ("straight-strokes", 0.3),
        *(pytest.param(*case, marks=pytest.mark.nightly) for case in (("slalom-quick", 0.02), ("steady-right", 0.1))),
    ],
)
def test_what_only_the_final_model_tells_of_a_shift(sample, name, seconds, chair):
    """Strokes that are all alike, a slalom whose shift bends C_λ, and a turn that hides its shift behind the missing effect."""
    assert same_verdict(sample, name, seconds, chair) == pytest.approx(seconds, abs=0.01)


@pytest.mark.nightly
@among("stroke_motion", "push_force_delay", "rolling_resistance_asymmetry")
def test_a_body_that_moves_with_each_stroke_is_no_clock(tmp_path, chair, request):
    """It is ahead of the hands, as pushes are that were recorded early; the runs without strokes have no share in it."""
    if "whole" in request.node.callspec.id:
        reason = "its law leaves twice the noise, and among forces trunk_motion and push_force_delay are named beside it"
        request.applymarker(pytest.mark.xfail(strict=True, reason=reason))
    campaign = read(make(tmp_path / "reaching", {"stroke_motion": {"reach": 0.03}}, seed=5))
    assert [n for n in campaign.runs[1].inputs if n.startswith("stroke.")] and campaign.runs[1].name == "straight-strokes"
    found = diagnose(campaign, chair)
    assert found.effects == ("stroke_motion",) and found.clocks == {}
    assert found.ladder[-1].heldout < 0.5 * found.ladder[1].heldout


@pytest.mark.nightly
def test_a_body_that_is_ahead_of_the_push_is_found_in_the_whole_catalogue(tmp_path):
    """By a simulator whose body has a will of its own, and inertia; no law that the push drives foretells it."""
    found = diagnose(read(make(tmp_path / "reaching", {"stroke_motion": {"reach": 0.03}}, seed=5)))
    assert found.verdict in ("missing", "tie") and "stroke_motion" in found.effects and found.clocks == {}
    assert found.ladder[-1].heldout < 1.1 and found.ladder[1].heldout > 4
