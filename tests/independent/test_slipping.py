"""Rear wheels that slip in the independent chair: as Coulomb has it, and as the loop tells it."""

from __future__ import annotations

import re

import numpy as np
import pytest

from benchmarks.independent.campaigns import make
from benchmarks.independent.chair import Chair, Start, simulate
from benchmarks.independent.hidden import usual
from tests.independent.test_wheelspin import CASES, coulomb
from wheelchair_fmu.campaign import Campaign, read
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.preflight.slipping import slipped
from wheelchair_fmu.model.choice import Choice
from wheelchair_fmu.model.generic import library
from wheelchair_fmu.model.variant import Variant

SLIPPED = {"strong-strokes", "strong-stop", "strong-right", "holdout-strong"}  # pushes beyond a third of the rear axle's load
SPINNING = Variant(Choice(wheel="spinning")).with_values({"tyre.mu": 0.33})


@pytest.mark.parametrize("case", ["spun up and let go", "to and fro on ice"])
def test_bristles_let_go_where_coulomb_says(case):
    push, _, mu = CASES[case]
    u, rim = coulomb(push, 0 * push, mu, 1.0)
    ours = simulate(Chair(f_r=0.0, f_f=0.0, slippery=1 / mu - 1), push / 2, push / 2, Start(u=1.0))
    np.testing.assert_allclose(ours["u"], u, atol=0.005 * np.ptp(u))
    np.testing.assert_allclose(ours["wheel_speed_l"], rim, atol=0.005 * np.ptp(rim))


@pytest.fixture(scope="module")
def slippery(tmp_path_factory) -> Campaign:
    """Said to be a floor like any other; a third of each wheel's load is all that it holds."""
    folder = tmp_path_factory.mktemp("slippery") / "c"
    return read(make(folder, {"slipping_wheels": usual("slipping_wheels", 2.0)}, manoeuvres="strong", seed=1))


@pytest.mark.nightly
def test_runs_in_which_wheels_slipped_are_named_and_nothing_makes_up_for_them(slippery):
    found = diagnose(slippery, generic=library())
    (note,) = [n for n in found.notes if "slipped" in n]
    shares = {run: int(share) for run, share in re.findall(r"([\w-]+) \((\d+)% of the time\)", note)}
    assert set(shares) == SLIPPED and all(10 <= share <= 30 for share in shares.values())
    assert float(re.search(r"tyre.mu = (\S+)$", note)[1]) == pytest.approx(1 / 3, abs=0.02)
    assert {r.name for r in found.models.campaign.runs} == {r.name for r in slippery.runs}, "no run is thrown out"
    assert found.verdict == "outside" and found.effects == found.included == () and found.proposal is None
    assert found.ladder[-1].left > 10


def test_the_law_that_is_named_explains_them(slippery):
    rolls, spins = (Models.of(ModelFactory(slippery, v)).calibrated()[1] for v in (Variant(), SPINNING))
    assert rolls.fit.evidence.rms > 10 and rolls.heldout.rms > 10
    assert spins.fit.evidence.rms < 1.5 and spins.heldout.rms < 1.6
    assert slipped(slippery, SPINNING) == ()


@pytest.mark.parametrize("manoeuvres", ["everyday", "slow", "fierce", "one-handed", "strong"])
@pytest.mark.parametrize(
    "hidden",
    [
        {},
        {"trunk_motion": {"amplitude": 0.03, "swing": 0.015}, "accelerometer_tilt": {"pitch": 0.05}},
        {"uneven_floor": {"slope": 0.003}, "wheel_radius_error": {"mean": 0.05}, "longitudinal_slip": {"compliance": 3e-4}},
        {"accelerometer_offset": {"x": 0.2, "y": 0.2}, "push_force_delay": {"tau": 0.1}, "wheel_inertia": {"m": 5.0}},
    ],
    ids=["nothing", "rider", "floor", "instruments"],
)
def test_no_wheel_that_rolls_is_said_to_slip(tmp_path, manoeuvres, hidden):
    campaign = read(make(tmp_path / "c", hidden, manoeuvres=manoeuvres, noise="ar1", seed=3))
    assert slipped(campaign, Variant()) == ()
