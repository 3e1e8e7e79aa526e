"""Given values that are wrong: calibrated where that is believable, and said where it is not."""

from __future__ import annotations

from dataclasses import replace
from math import inf

import pytest

from benchmarks.independent.campaigns import make, truth
from wheelchair_fmu.campaign import read
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.estimation.calibration import at_bound, calibration, doubts
from wheelchair_fmu.inference.estimation.problem import Problem
from wheelchair_fmu.inference.explain.story import story
from wheelchair_fmu.inference.models.factory import MEASURED, ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.quantities import M, Parameter


def fitted(campaign):
    shop = ModelFactory(campaign, Variant())
    _, found, *_ = Models.of(shop).calibrated()
    return {c.record.name: c for c in calibration(shop.likelihood(), found.fit)}


def test_values_as_given_raise_no_doubts(sample):
    found = fitted(sample)
    assert set(MEASURED) < set(found)
    assert not any(c.beyond for c in found.values())
    assert found["chair.m"].value == pytest.approx(80, abs=1) and found["chair.m"].prior_sd == pytest.approx(2)


@pytest.mark.parametrize(
    ("value", "sd", "reach", "stopped"),
    [
        (0.29, 0.01, (0.21, 0.29), True),  # as far as a prior lets it go
        (0.289, 0.01, (0.21, 0.29), False),
        (1.0, inf, (0.0, 1.0), True),  # its own bound
        (0.9, 0.01, (0.0, 1.0), False),  # of an effect, whose prior is no reason to stop
        (0.25, 0.01, (0.25, 1.0), False),  # as it was given
    ],
)
def test_a_fit_stops_at_the_ends_of_what_it_may_reach(value, sd, reach, stopped):
    assert at_bound(Parameter("chair.a", M, default=0.25), value, 0.25, sd, reach) is stopped


def given(chair, **more):
    """A campaign that says how large effects are, with the likelihood of a chair that has them."""
    campaign, effects = replace(chair, **more), ("caster_trail", "floor_slope")
    return ModelFactory(campaign, Variant().with_effects(effects)).likelihood(effects)


def test_a_size_that_was_measured_is_known_as_a_lab_measures_it(sample):
    """A caster's trail to 5 mm, by its record; what has no record of that, or was not measured, is free."""
    trail, slope = "effect.caster_trail.c", "effect.floor_slope.x"
    free = Problem(given(sample), [trail, slope])
    assert [*free.prior.sd] == [inf, inf] and free.upper[0] == 0.3
    known = {**sample.known, trail: 0.05, slope: 0.002}
    found = Problem(given(sample, known=known), [trail, slope])
    assert [*found.prior.sd] == [0.005, inf] and [*found.prior.mean] == [0.05, 0.002]
    assert (found.lower[0], found.upper[0]) == pytest.approx((0.03, 0.07))
    said = Problem(given(sample, known=known, priors={trail: 0.001, slope: 0.0005}), [trail, slope])
    assert [*said.prior.sd] == [0.001, 0.0005] and said.upper[1] == pytest.approx(0.004)


def test_a_mass_that_nobody_weighed_is_said(sample):
    found = fitted(replace(sample, known={**sample.known, "chair.m": 60.0}))
    mass = found["chair.m"]
    assert mass.beyond and mass.at_bound
    assert mass.value == pytest.approx(66, rel=1e-6) and mass.upper == 66 and mass.lower == 54
    said = [words for words in doubts(list(found.values())) if words.startswith("chair.m comes out at")]
    assert len(said) == 1 and "standard deviations from the 60 ± 1.5 kg given" in said[0]


def test_errors_of_scales_and_tape_are_no_effect(tmp_path):
    """The chair is as heavy and as wide as a lab measures it: some per cent and some millimetres off."""
    campaign = read(make(tmp_path / "c", {}, seed=31, measured=1.5))
    true = truth({}, seed=31, measured=1.5).chair
    assert abs(true.a - 0.25) > 0.03 and abs(true.m - 80) > 1.5  # by what was an effect once
    found = diagnose(campaign)
    assert found.verdict in ("adequate", "cannot_see")
    values = {c.record.name: c for c in found.calibration}
    assert values["chair.m"].value == pytest.approx(true.m, rel=0.005)
    assert values["chair.t_r"].value == pytest.approx(true.t_r, abs=0.004)


@pytest.mark.nightly
def test_a_gyro_is_told_from_a_tread_that_is_a_little_off(tmp_path):
    """3 % of a gyro's scale is 16 mm of tread, which no tape excludes; but how wheel speeds and slips go together is not."""
    found = diagnose(read(make(tmp_path / "c", {"gyro_scale": {"k": 0.03}}, seed=1)))
    assert found.verdict == "missing" and found.effects == ("gyro_scale",)
    values = {c.record.name: c for c in found.calibration}
    assert abs(found.rounds[0].fit.values["chair.t_r"] - 0.55) > 0.01 > abs(values["chair.t_r"].value - 0.55)


def test_a_tread_that_is_a_little_off_is_no_gyro(tmp_path):
    """15 mm of tread, which is 2.7 % of a gyro's scale: the tread itself says so, and nothing is missing."""
    campaign = read(make(tmp_path / "c", {}, seed=1))
    found = diagnose(replace(campaign, known={**campaign.known, "chair.t_r": 0.565}))
    assert found.verdict in ("adequate", "cannot_see", "small") and "gyro_scale" not in found.effects
    values = {c.record.name: c for c in found.calibration}
    assert values["chair.t_r"].value == pytest.approx(0.55, abs=0.004)


GIVEN_WRONG = {
    "the centre of mass 15 mm to the rear": {"chair.a": +0.015, "chair.b": -0.015},
    "the centre of mass 15 mm ahead": {"chair.a": -0.015, "chair.b": +0.015},
    "5 % too heavy": {"chair.m": +4.0},
    "5 % too light": {"chair.m": -4.0},
}


@pytest.mark.parametrize("off", GIVEN_WRONG.values(), ids=GIVEN_WRONG)
def test_given_values_that_are_a_little_off_are_no_effect(tmp_path, off):
    """What a tape and a scale err by is nobody's effect; the axle and the mass, of which these runs tell, come back."""
    campaign = read(make(tmp_path / "c", {}, seed=1))
    given = {name: campaign.known[name] + error for name, error in off.items()}
    found = diagnose(replace(campaign, known={**campaign.known, **given}))
    assert found.verdict in ("adequate", "cannot_see") and not found.effects
    values = {c.record.name: c.value for c in found.calibration}
    for name in {"chair.b", "chair.m"}.intersection(off):
        assert abs(values[name] - campaign.known[name]) < 0.6 * abs(off[name])


@pytest.mark.nightly
def test_turn_slip_that_geometry_hides_is_never_adequate(tmp_path):
    """In everyday turns another place of the CM does as well as patches that resist being turned. No tape is so far off, and
    what lets it back is named with its size."""
    found = diagnose(read(make(tmp_path / "c", {"turn_slip": {"M": 1.5, "M_f": 0.15}}, seed=1)))
    if found.verdict == "outside":
        assert "chair.a" in next(c.record.name for c in found.calibration if c.beyond)
        assert [note for note in found.notes if note.startswith("with turn_slip chair.a comes out at 0.2")]
        assert story(found)["calibration"]["chair.a"]["beyond"]
    else:
        assert "turn_slip" in found.effects


def test_no_model_is_adequate_that_probably_lacks_something(tmp_path):
    """Patches whose torque everyday turns leave unsure by a half: too little to name them, and too much to say that nothing is
    missing."""
    names = ("turn_slip", "gyro_bias", "wheel_radius_error", "floor_slope", "push_force_delay")
    campaign = read(make(tmp_path / "c", {"turn_slip": {"M": 1.2}}, seed=5))
    found = diagnose(campaign, Variant(catalogue={e: bundled()[e] for e in names}))
    probability = found.beliefs["turn_slip"].large
    assert found.verdict == "cannot_see" and found.effects == () and found.seen > found.models.policy.library
    said = f"turn_slip is probably missing, with a size of interest ({probability:.2f}), but not surely enough to be named"
    assert probability > 0.5 and f"{said}; further runs would tell" in found.notes
