"""The phase of strokes by the pushes: whole numbers where strokes begin, a rate without jumps, rest where nobody strokes."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from wheelchair_fmu.campaign import check
from wheelchair_fmu.campaign.strokes import begun, steady, with_strokes

TIME = np.arange(0, 20, 0.01)


def pushes(beginnings, seconds=0.5, force=60.0):
    """Half sines."""
    since = TIME[:, None] - np.asarray(beginnings)
    return np.where((since > 0) & (since < seconds), force * np.sin(np.pi * since / seconds), 0.0).sum(axis=1)


def test_each_stroke_begins_at_a_whole_turn_and_the_rate_has_no_jumps():
    rng = np.random.default_rng(1)
    beginnings = 3 + np.cumsum(rng.normal(1.1, 0.05, 10))
    phase, rate = steady(TIME, pushes(beginnings))
    counted = np.interp(begun(TIME, pushes(beginnings)), TIME, phase)
    np.testing.assert_allclose(counted, np.round(counted), atol=1e-3)
    np.testing.assert_allclose(np.diff(counted), 1, atol=2e-3)
    np.testing.assert_allclose(np.gradient(phase, TIME)[1:-1], rate[1:-1], atol=0.02)  # it bends at knots
    assert np.max(np.abs(np.diff(rate))) < 0.1 and rate.min() >= 0
    among = (beginnings[1] < TIME) & (beginnings[-1] > TIME)
    np.testing.assert_allclose(rate[among].mean(), 1 / 1.1, rtol=0.03)


def test_a_body_rests_at_whole_turns_between_two_bouts():
    phase, rate = steady(TIME, pushes([1.0, 2.0, 3.0, 4.0, 12.0, 13.0, 14.0]))
    still = (TIME > 5.3) & (TIME < 10.8)
    assert np.ptp(phase[still]) < 1e-9 and not rate[still].any()
    np.testing.assert_allclose(phase[still], np.round(phase[still]), atol=1e-9)
    assert np.all(np.diff(phase) >= 0)


@pytest.mark.parametrize("beginnings", [[], [2.0], [2.0, 3.0], [1.0, 1.6, 4.0, 4.7, 9.5, 10.4, 17.0]])
def test_what_has_no_rhythm_has_no_phase(beginnings):
    assert steady(TIME, pushes(beginnings)) is None


def test_whoever_measured_the_body_or_the_phase_is_believed():
    strokes = pushes(np.arange(1.0, 18.0))
    torques = {"M_rl": 0.3 * strokes / 2, "M_rr": 0.3 * strokes / 2}
    found = with_strokes(TIME, torques, 0.3)
    np.testing.assert_allclose(found["stroke.phase"], steady(TIME, strokes)[0], atol=1e-9)
    assert "stroke.phase" not in with_strokes(TIME, {**torques, "rider.momentum": 0 * TIME}, 0.3)
    given = with_strokes(TIME, {**torques, "stroke.phase": 1.1 * TIME}, 0.3)
    np.testing.assert_allclose(given["stroke.rate"], 1.1)
    np.testing.assert_allclose(given["stroke.phase"], 1.1 * TIME)


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        ({"stroke.phase": "gap"}, "stroke.phase is missing in 51 of 501 rows; fill its gaps, or leave it out"),
        ({"stroke.phase": "wrapped"}, "stroke.phase falls by 99 a second at 0.99 s; count strokes on from 0"),
        ({"stroke.phase": "radians"}, "stroke.phase grows by 6.28 a second at "),
        ({"stroke.rate [Hz]": "turns"}, "stroke.rate is given, but not stroke.phase; add stroke.phase"),
        ({"stroke.phase": "turns"}, ""),
    ],
)
def test_a_phase_that_is_given_is_whole_in_strokes_and_of_a_person(tmp_path, columns, said):
    time = np.arange(501) * 0.01
    kinds = {"turns": time, "gap": np.where((time > 1.995) & (time < 2.505), np.nan, time), "wrapped": np.mod(time, 1.0)}
    kinds["radians"] = 2 * np.pi * time
    pushes = {"time [s]": time, "F_rl [N]": 10 + 0 * time, "F_rr [N]": 10 + np.sin(time), "yaw_rate [rad/s]": np.sin(time)}
    pd.DataFrame(pushes | {n: kinds[kind] for n, kind in columns.items()}).to_csv(tmp_path / "a.csv", index=False)
    run = '[[run]]\nfile = "a.csv"\nmanoeuvre = "strokes"\nrole = "fit"\nu0 = 1.0\n'
    (tmp_path / "campaign.toml").write_text('[campaign]\nname = "c"\naxes = "SAE-J670"\n' + run)
    wrong = [str(f) for f in check(tmp_path) if f.severity == "error"]
    assert len(wrong) == bool(said) and all(said in f for f in wrong), wrong
