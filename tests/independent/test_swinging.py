"""Casters with a tyre, inertia and friction against the independent chair's: turned at the start, spinning, backing up."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.independent.campaigns import make, truth
from benchmarks.independent.chair import Chair, Start, simulate
from benchmarks.independent.manoeuvres import Run, strokes
from wheelchair_fmu.campaign import read
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.inference.decision.final import final
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.evidence.initial_state import CASTERS
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.models.factory import CALIBRATED, ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import Choice

# The independent chair's casters; the laws of side force differ where it is near its limit, which it never is here.
OWN = {
    "caster.trail": Chair().trail,
    "caster.I": Chair().I_swivel,
    "caster.M": Chair().swivel_dry,
    "caster.d": Chair().swivel_viscous,
    "caster.C_lambda": Chair().C_caster,
    "caster.sigma": Chair().sigma_caster,
    "caster.mu": 1.0,
    "regularisation.swivel_rate": 0.05,
    "regularisation.drag_speed": 0.002,
}
AT_PATCHES = {"patch_load": 1.0}  # where the model has the front axle's load
CHAIR = Variant(Choice(caster="slipping")).with_values(OWN)
TIME = np.arange(601) * 0.01


def bump(force: float, seconds: float) -> np.ndarray:
    return np.where(seconds > TIME, force * np.sin(np.pi * TIME / seconds), 0.0)


def swing(left: float, right: float) -> tuple[np.ndarray, np.ndarray]:
    """Forward, then back."""
    wave = np.where(TIME < 4, np.sin(np.pi * TIME / 2), 0.0)
    return left * wave, right * wave


PUSHES = {"backing up": (bump(-12, 2), bump(-11, 2)), "spinning": (bump(16, 3), bump(-16, 3)), "there and back": swing(14, 12)}


@pytest.mark.parametrize("turned", [(0.0, 0.0), (0.4, -0.3)])
@pytest.mark.parametrize("pushes", PUSHES.values(), ids=PUSHES)
def test_casters_swing_round_and_kick_as_the_independent_chairs_do(pushes, turned):
    """A second implementation: explicit Runge-Kutta, accelerations of the swivel, another tyre law."""
    left, right = turned
    chair = Simulator(CHAIR.with_values({"start.u": 0.0, "start.caster_l": left, "start.caster_r": right}))
    inputs = chair.inputs(len(TIME), dict(zip(("push.F_rl", "push.F_rr"), pushes, strict=True)))
    ours = chair.run(TIME, inputs, tolerance=1e-7)
    its = simulate(Chair(**AT_PATCHES), *pushes, Start(swivel_l=left, swivel_r=right))
    for name, other in (("caster.fl", "swivel_l"), ("caster.fr", "swivel_r")):
        assert np.ptp(its[other]) > 0.5
        np.testing.assert_allclose(ours[name], its[other], atol=0.1)
    for name, other in (("chair.psi_dot", "yaw_rate"), ("chair.u", "u"), ("chair.x", "x"), ("chair.y", "y")):
        np.testing.assert_allclose(ours[name], its[other], atol=0.02 * max(np.ptp(its[other]), 0.5))


SETTING_OFF = Run("setting-off", "straight", "fit", 0.0, 5.0, strokes(22.0, 1.2))


@pytest.mark.parametrize("turned", [(0.7, 0.4), (-0.5, 0.2), (0.3, 0.3)])
def test_casters_left_turned_round_are_found_where_nobody_filmed_them(tmp_path, turned):
    """A chair that stands with its casters aside and is pushed straight ahead is kicked aside by both together: their sum tells
    how far. What one is turned more than the other costs it a little drag only."""
    true = truth({}, seed=3).chair
    campaign = read(make(tmp_path / "turned", {}, manoeuvres=[SETTING_OFF], seed=3, turned=turned, chair=AT_PATCHES))
    values = {f"resistance.{f}": getattr(true, f) for f in ("f_r", "f_f")}
    values |= {"tyre.C_lambda": true.C_lambda, "chair.I_z": true.I_z}
    likelihood = Likelihood(campaign, CHAIR, columns=CALIBRATED)
    (straight,) = likelihood.evidence(campaign.runs, values).runs
    (found,) = likelihood.evidence(campaign.runs, values, (), tune_start=6).runs
    assert sum(straight.started[name] for name in CASTERS) == 0
    assert sum(found.started[name] for name in CASTERS) == pytest.approx(sum(turned), abs=0.1)
    assert np.nansum(found.r**2) < np.nansum(straight.r**2) - 20
    filmed = replace(campaign.runs[0], set=dict(zip(CASTERS, turned, strict=True)))
    (known,) = likelihood.evidence([filmed], values, (), tune_start=6).runs
    assert {name: known.started[name] for name in CASTERS} == filmed.set
    assert not any(known.uncertain[name] for name in CASTERS)


def test_a_diagnosis_tells_how_casters_stood_that_nobody_filmed(tmp_path):
    turned = (0.7, 0.4)
    campaign = read(make(tmp_path / "turned", {}, manoeuvres=[SETTING_OFF], seed=3, turned=turned, chair=AT_PATCHES))
    few = replace(CHAIR, catalogue={effect: bundled()[effect] for effect in ("rolling_resistance_asymmetry", "gyro_bias")})
    began = final(diagnose(campaign, few), {})["runs"]["setting-off"]["start"]
    told = [began[name] for name in CASTERS]
    assert sum(one["value"] for one in told) == pytest.approx(sum(turned), abs=0.1)
    assert all(0 < one["se"] < 0.3 and one["unit"] == "rad" for one in told)  # less unsure than where nobody looked


@pytest.mark.nightly
@pytest.mark.parametrize("seed", [1, 4])
def test_slow_manoeuvres_come_down_to_the_floor(tmp_path, seed):
    """From 0.2 to 0.6 m/s, starts and stops, spins, backing up: ideal casters leave three times the noise, these none.

    While the chair backs up, its casters stand on their tips as pencils do: slopes hold only about the path on which the errors
    of the recorded pushes led it.
    """
    campaign = read(make(tmp_path / "slow", {}, manoeuvres="slow", seed=seed, chair=AT_PATCHES))
    _, found, *_ = Models.of(ModelFactory(campaign, CHAIR)).calibrated()
    assert found.fit.evidence.rms < 1.03 and found.heldout.rms < 1.03
    assert all(np.nanmean(e.r**2) < 1.1 for e in (*found.fit.evidence.runs, *found.heldout.runs))
    _, ideal, *_ = Models.of(ModelFactory(campaign, Variant())).calibrated()
    assert ideal.fit.evidence.rms > 2 and ideal.heldout.rms > 2


UNMEASURED = Variant(Choice(caster="slipping"))  # nobody gave its casters' trail, inertia, friction or stiffness


@pytest.mark.nightly
@pytest.mark.parametrize("seed", [2, 6, 7, 8, 15])
def test_casters_that_nobody_measured_come_down_to_the_floor(tmp_path, seed):
    """A fit from what is usual stalls in all but the first: too much friction holds these casters where they stand."""
    campaign = read(make(tmp_path / "slow", {}, manoeuvres="slow", seed=seed, chair=AT_PATCHES))
    _, found, *_ = Models.of(ModelFactory(campaign, UNMEASURED)).calibrated()
    assert found.fit.evidence.rms < 1.04 and found.heldout.rms < 1.04
    assert found.fit.values["caster.trail"] == pytest.approx(OWN["caster.trail"], abs=0.003)
    assert found.fit.values["caster.I"] == pytest.approx(OWN["caster.I"], abs=5e-4)
    assert found.fit.values["caster.M"] == pytest.approx(OWN["caster.M"], abs=2e-3)


@pytest.mark.nightly
@pytest.mark.parametrize("seed", [1, 2, 3, 4, 5, 6, 7])
def test_nothing_is_missing_of_casters_that_nobody_measured(tmp_path, seed):
    found = diagnose(read(make(tmp_path / "c", {}, seed=seed, chair=AT_PATCHES)), UNMEASURED)
    assert found.verdict == "adequate" and not found.included


LATER = [pytest.param(*one, marks=pytest.mark.nightly) for one in (("slow", "ar1", 4), ("everyday", "white", 1))]


@pytest.mark.parametrize(("manoeuvres", "noise", "seed"), [("slow", "white", 1), *LATER])
def test_with_casters_that_swing_on_both_sides_nothing_is_missing(tmp_path, manoeuvres, noise, seed):
    found = diagnose(read(make(tmp_path / "c", {}, manoeuvres=manoeuvres, noise=noise, seed=seed, chair=AT_PATCHES)), CHAIR)
    assert found.verdict in ("adequate", "cannot_see", "small") and not found.included


@pytest.mark.nightly
@pytest.mark.parametrize("seed", [5, 7])
def test_a_pivot_torque_is_found_of_casters_that_nobody_measured(tmp_path, seed):
    """Without it a fit bends the casters, starts runs elsewhere and takes pushes for wrong; no step leads back from there."""
    hidden = {"pivot_torque": {"M": 1.5}}
    found = diagnose(read(make(tmp_path / "c", hidden, manoeuvres="slow", seed=seed, chair=AT_PATCHES)), UNMEASURED)
    assert found.verdict in ("missing", "tie") and "pivot_torque" in found.effects
    assert found.ladder[-1].fit < 1.1 and found.ladder[-1].heldout < 1.1
    low, high = found.intervals["effect.pivot_torque.M"]
    assert low <= 1.5 <= high
