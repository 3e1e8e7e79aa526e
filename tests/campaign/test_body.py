"""The rider's body as a measured input: its momentum by a position or by markers, and what is wrong with such a record."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from wheelchair_fmu.campaign import body, check, read
from wheelchair_fmu.inference.subject import known_parameters

RATE, OMEGA, SWING, MASS = 150.0, 2 * np.pi * 1.3, 0.04, 70.0
TIME = np.arange(0, 6, 1 / RATE)
S = SWING * (1 - np.cos(OMEGA * TIME))
MOMENTUM = MASS * SWING * OMEGA * np.sin(OMEGA * TIME)


def campaign(folder: Path, columns: dict[str, np.ndarray], rest: str = "") -> Path:
    """One run of a chair that rolls, whose rider swings, with these columns besides."""
    u = 1.0 - 0.02 * TIME
    data = {"time [s]": TIME, "F_rl [N]": 0 * TIME, "F_rr [N]": 0 * TIME, "wheel_speed_l [m/s]": u, "wheel_speed_r [m/s]": u}
    pd.DataFrame(data | columns).to_csv(folder / "run.csv", index=False)
    (folder / "campaign.toml").write_text(
        f'[campaign]\naxes = "SAE-J670"\n{rest}\n[noise]\nwheel_speed_l = 0.01\nwheel_speed_r = 0.01\n'
        '[[run]]\nfile = "run.csv"\nmanoeuvre = "coast-down"\nrole = "fit"\nu0 = 1.0\n'
    )
    return folder


def errors(folder: Path) -> list[str]:
    return [str(f) for f in check(folder, known_parameters()) if f.severity == "error"]


def test_a_position_and_its_mass_are_a_momentum(tmp_path):
    noisy = S + np.random.default_rng(1).normal(0, 0.0005, len(TIME))
    made = read(campaign(tmp_path, {"rider.s [mm]": 1000 * noisy}, f"[rider]\nm = {MASS}"), known_parameters())
    run = made.runs[0]
    assert made.known["rider.m"] == MASS
    expected = np.interp(run.time, TIME, MOMENTUM)
    off = run.inputs["rider.momentum"] - expected
    assert np.sqrt(np.mean(off**2)) < 0.06 * np.ptp(MOMENTUM) / 2  # smoothing takes 2 % of it, noise adds 0.6 N s
    assert np.abs(run.inputs["rider.s"] - np.interp(run.time, TIME, S)).max() < 0.003
    force = np.gradient(expected, run.time)
    assert np.corrcoef(run.inputs["rider.force"], force)[0, 1] > 0.8
    assert 0.1 * np.std(MOMENTUM) < made.noise["rider.momentum"] < 0.3 * np.std(MOMENTUM)


def test_a_momentum_is_taken_as_it_is(tmp_path):
    made = read(campaign(tmp_path, {"rider.momentum [N.s]": MOMENTUM}, "[noise]".replace("[noise]", "")), known_parameters())
    np.testing.assert_allclose(made.runs[0].inputs["rider.momentum"], MOMENTUM, rtol=1e-6, atol=1e-6)
    assert "rider.m" not in made.known and "rider.s" not in made.runs[0].inputs


def test_the_channels_names_may_be_written_with_dots(tmp_path):
    folder = campaign(tmp_path, {"p [kg.m/s]": MOMENTUM}, "[columns]\nrider.momentum = 'p'\n")
    text = (folder / "campaign.toml").read_text().replace("[noise]\n", "[noise]\nrider.momentum = 2.0\n")
    (folder / "campaign.toml").write_text(text)
    made = read(folder, known_parameters())
    assert made.noise["rider.momentum"] == 2.0 and np.ptp(made.runs[0].inputs["rider.momentum"]) == pytest.approx(
        np.ptp(MOMENTUM), rel=1e-6
    )


def test_a_position_without_a_mass_is_told_in_one_sentence(tmp_path):
    (fault,) = errors(campaign(tmp_path, {"rider.s [m]": S}))
    assert "rider.s is given, but not the mass that moves with it; write [rider] m = ... in kg" in fault


def test_a_mass_below_zero_and_a_swing_of_a_hundred_metres_are_refused(tmp_path):
    found = errors(campaign(tmp_path, {"rider.s [m]": 100 * S}, "[rider]\nm = -3"))
    assert len(found) == 2
    assert any("rider.m = -3 is outside 0 to 500" in f for f in found)
    assert any("rider.s reaches 8 m, above any plausible 2 m; check its unit (is it mm?)" in f for f in found)


def test_where_the_body_is_not_seen_the_run_ends(tmp_path):
    hidden = np.where(TIME > 4.0, np.nan, S)
    folder = campaign(tmp_path, {"rider.s [m]": hidden}, f"[rider]\nm = {MASS}")
    run = read(folder, known_parameters()).runs[0]
    assert run.time[0] < 0.1 and 3.8 < run.time[-1] <= 4.0
    assert all(np.isfinite(v).all() for v in run.inputs.values())
    said = [str(f) for f in check(folder, known_parameters()) if "is left out" in str(f)]
    assert len(said) == 1 and "the rider's body is seen from" in said[0]


def test_a_body_that_is_never_seen_is_told_in_one_sentence(tmp_path):
    hidden = np.where(np.arange(len(TIME)) % 40 < 20, np.nan, S)
    (fault,) = errors(campaign(tmp_path, {"rider.s [m]": hidden}, f"[rider]\nm = {MASS}"))
    assert "nowhere seen for 0.5 s" in fault


def test_a_trunk_that_leans_as_a_rigid_body_moves_the_persons_mass_by_its_shares():
    """Shoulders that move by d: of the trunk 1 − 0.405 of it, all of the head and the arms."""
    moved = body.position(TIME, {"shoulder_l": 0.3 + S, "shoulder_r": 0.3 + S})
    share = 0.430 * (1 - 0.405) + 0.068 + 2 * (0.0263 + 0.0150 + 0.00585)
    np.testing.assert_allclose(moved, share * (S - np.median(S[TIME <= 0.3])), atol=1e-12)


def test_all_segments_that_move_alike_are_the_whole_of_what_sits():
    moved = body.position(TIME, {name: S for name in body.MARKERS})
    whole = 0.430 + 0.068 + 2 * (0.0263 + 0.0150 + 0.00585)  # legs and feet stay on the chair
    np.testing.assert_allclose(np.ptp(moved), whole * np.ptp(S), rtol=1e-9)


def test_a_marker_that_is_hidden_for_a_moment_moves_on_as_the_other_one_does():
    rng = np.random.default_rng(3)
    seen = {f"shoulder_{side}": S + rng.normal(0, 0.0005, len(S)) for side in "lr"}
    whole = body.position(TIME, seen)
    hidden = {**seen, "shoulder_l": np.where((TIME > 2.0) & (TIME < 2.5), np.nan, seen["shoulder_l"])}
    np.testing.assert_allclose(body.position(TIME, hidden), whole, atol=0.002)


def test_a_longer_gap_of_all_markers_stays_one():
    hidden = np.where((TIME > 2.0) & (TIME < 2.5), np.nan, S)
    assert np.isnan(body.position(TIME, {"sternum": hidden})[(TIME > 2.1) & (TIME < 2.4)]).all()
    first, last = body.stretch(TIME, body.of_position(TIME, hidden, MASS).series["rider.momentum"], 0.1)
    assert 2.5 < first < 2.6 and last > 5.9
