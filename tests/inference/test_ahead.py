"""What held-out runs show that fitted ones do not: values that these left open, or something that no value explains."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.independent.campaigns import make
from tests.inference.linear import evidence, least_squares, noise, signals, values
from wheelchair_fmu.campaign import Campaign, read
from wheelchair_fmu.inference.decision.ahead import Ahead, which_to_fit
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.estimation.foretelling import unforetold
from wheelchair_fmu.inference.estimation.problem import Fit
from wheelchair_fmu.inference.evidence.evidence import Evidence
from wheelchair_fmu.inference.explain.ranking import as_json
from wheelchair_fmu.inference.policy import DEFAULT
from wheelchair_fmu.inference.residual.staircase import Step
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant

NAMES, LONG = ("a", "b"), 500
NOTHING_KNOWN = np.zeros(2)
DRAWS = 100
WAVE = 1.0  # standard deviations of the noise, of something that no value does


def foretold(rng: np.random.Generator, more: float = 0.0) -> tuple[Fit, Evidence]:
    """A fit that hardly saw the first value, and two held-out runs that see it well, with a wave that no value makes."""
    slopes = signals(rng, 1, LONG, 2)
    slopes[0][:, :, 0] *= 0.01
    true = rng.normal(size=2)
    found = least_squares([s @ true + noise(rng, (LONG, 1)) for s in slopes], slopes, NAMES)
    there = [5 * s for s in signals(rng, 2, LONG, 2)]
    wave = more * np.sin(np.arange(LONG) / 11.0)[:, None]
    left = [s @ (true - values(found)) + noise(rng, (LONG, 1)) + wave for s in there]
    return found, evidence(left, there, NAMES)


def test_values_go_where_held_out_runs_want_them_within_what_the_fit_leaves_open():
    found, held = foretold(np.random.default_rng(1))
    precise = np.linalg.inv(found.covariance) + held.S.T @ held.S
    step = np.linalg.solve(precise, held.S.T @ held.r)
    left, moved = unforetold(found, held, NOTHING_KNOWN)
    assert left.r == pytest.approx(held.r - held.S @ step, abs=1e-8)
    assert [moved[n] for n in NAMES] == pytest.approx([np.sqrt(np.mean((held.S[:, i] * step[i]) ** 2)) for i in range(2)])


def test_what_values_explain_is_nothing_missing_and_what_none_explains_is():
    """Of campaigns whose held-out runs are off by many times the noise, as nobody could know a value."""
    rng = np.random.default_rng(2)
    off, said, missed = [], 0, 0
    for _ in range(DRAWS):
        found, held = foretold(rng)
        off.append(held.rms)
        said += Ahead(*unforetold(found, held, NOTHING_KNOWN)).unexplained(DEFAULT)
        missed += not Ahead(*unforetold(*foretold(rng, WAVE), NOTHING_KNOWN)).unexplained(DEFAULT)
    assert np.median(off) > 2
    assert said == 0 and missed == 0


def test_beside_what_was_found_a_share_of_what_it_explained_may_be_left():
    told = Ahead(*unforetold(*foretold(np.random.default_rng(3), WAVE), NOTHING_KNOWN))
    assert 1.1 < told.rms < 1.4
    assert replace(told, before=1.2).unexplained(DEFAULT) and not replace(told, before=5.0).unexplained(DEFAULT)


def step(fit: float, heldout: float) -> Step:
    return Step("", fit, heldout, {}, {}, {}, {}, {})


def test_which_run_to_fit_is_said_where_only_held_out_ones_show_an_error():
    plain, more = (Ahead(*unforetold(*foretold(np.random.default_rng(4), w), NOTHING_KNOWN)) for w in (0.0, WAVE))
    (said,) = which_to_fit((step(2.0, 3.0), step(1.0, 2.0)), plain)
    assert said.startswith("run ") and "2.0 times the noise" in said and "(a)" in said and 'role = "fit"' in said
    (other,) = which_to_fit((step(2.0, 3.0), step(1.0, 1.4)), more)
    assert "no value of the chair explains it" in other and "yaw_rate" in other
    assert which_to_fit((step(2.0, 3.0), step(1.0, 1.2)), plain) == ()
    assert which_to_fit((step(2.0, 3.0), step(1.5, 2.0)), plain) == (), "fitted runs show it as well"


def swinging(campaign: Campaign, size: float) -> Campaign:
    """The first two held-out runs with a yaw rate that swings by so much (rad/s)."""
    swung = {
        r.name: replace(r, channels={**r.channels, "yaw_rate": r.channels["yaw_rate"] + size * np.sin(2 * r.time)})
        for r in campaign.holdout[:2]
    }
    return replace(campaign, runs=tuple(swung.get(r.name, r) for r in campaign.runs))


def test_a_model_is_not_adequate_where_held_out_runs_have_what_no_fitted_one_shows(tmp_path):
    """Three held-out runs of a chair of which nothing is missing, in two of which the yaw rate swings by itself."""
    campaign = read(make(tmp_path / "null", {}, seed=4))
    swung = {r.name for r in campaign.holdout[:2]}
    found = diagnose(swinging(campaign, 0.03))
    assert found.ladder[-1].fit < 1.05 and found.ladder[-1].heldout > 1.3
    assert found.verdict == "outside" and not found.effects
    assert any(note.startswith(tuple(swung)) and "yaw_rate most" in note for note in found.notes)
    assert found.to_fit in swung and as_json(found)["to_fit"] == found.to_fit


@pytest.mark.nightly
def test_nor_is_one_among_forces_that_nobody_recorded(tmp_path):
    """On an uneven floor, the yaw rate of two held-out runs swings by itself, by more than that floor does."""
    few = {effect: bundled()[effect] for effect in ("rolling_resistance_asymmetry", "aerodynamic_drag")}
    campaign = swinging(read(make(tmp_path / "floor", {"uneven_floor": {"slope": 0.003}}, seed=1)), 0.1)
    found = diagnose(campaign, Variant(catalogue=few))
    assert found.models.factory.leads and found.ladder[-1].fit < 1.2 and found.ladder[-1].heldout > 1.3
    assert found.verdict == "outside" and found.to_fit in {r.name for r in campaign.holdout[:2]}
    assert any(note.startswith(found.to_fit) and "yaw_rate most" in note for note in found.notes)
