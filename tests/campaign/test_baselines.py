"""Baselines and ripples of push rims, that are known."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.campaign import check, read
from wheelchair_fmu.campaign.baselines import baseline, baselines, corrected

from .riding import coloured, strokes
from .small import HEAD, RUNS, csv_text, rows


def rim(seed: int, a: float = 0.0, offset: float = 0.8, ripple: float = 1.1, phase: float = 2.0, sides: int = 1):
    """Time, recorded torque, angle and true torque of 10 s with pushes (of both signs, where `sides` is 2)."""
    rng = np.random.default_rng(seed)
    t, force = strokes(rng, 10)
    force = np.where(t > 5, -force, force) if sides == 2 else force
    time = np.arange(0, 10, 1 / 240)
    angle = rng.uniform(0, 6) + np.cumsum(np.clip(0.6 * time - 0.6, 0, 4)) / 240
    torque = 0.3 * np.interp(time, t, force)
    noise = coloured(rng, len(time), 0.25, a)
    return time, torque + offset + ripple * np.sin(angle + phase) + noise, angle, torque


@pytest.mark.parametrize("sides", [1, 2])
def test_offset_ripple_and_phase_are_found_and_taken_away(sides):
    time, recorded, angle, true = rim(0, sides=sides)
    found = baseline(time, recorded, angle)
    assert found.enough and 0.2 < found.share_hands_off < 0.8
    assert found.offset == pytest.approx(0.8, abs=4 * found.offset_se) and found.offset_se < 0.05
    assert found.ripple == pytest.approx(1.1, abs=4 * found.ripple_se)
    assert found.phase == pytest.approx(2.0, abs=0.05)
    assert np.std(corrected(recorded, angle, found) - true) < 0.26


@pytest.mark.parametrize("a", [0.0, 0.9])
def test_standard_errors_cover_the_truth(a):
    z = []
    for seed in range(80):
        time, recorded, angle, _ = rim(seed, a)
        found = baseline(time, recorded, angle)
        z.append((found.offset - 0.8) / found.offset_se)
    assert np.mean(np.abs(z) < 1.96) >= 0.87
    assert 0.75 < np.sqrt(np.mean(np.square(z))) < 1.35


def test_runs_share_the_ripple_and_keep_their_offsets():
    runs = {f"run{i}": rim(i, offset=o)[:3] for i, o in enumerate((0.2, -0.6, 1.4))}
    found = baselines(runs)
    assert len({b.ripple for b in found.values()}) == 1
    for b, offset in zip(found.values(), (0.2, -0.6, 1.4), strict=True):
        assert b.offset == pytest.approx(offset, abs=4 * b.offset_se)
    alone = baseline(*runs["run0"])
    assert found["run0"].ripple_se < alone.ripple_se


def test_without_an_angle_only_the_offset_is_told():
    time, recorded, _, _ = rim(3, ripple=0.0)
    found = baseline(time, recorded)
    assert found.ripple == 0.0 and found.ripple_se == 0.0
    assert found.offset == pytest.approx(0.8, abs=4 * found.offset_se)


@pytest.mark.parametrize("level", [0.0, 1.5])
def test_readings_without_noise_tell_the_baseline_exactly(level):
    """Some wheels report nothing below a threshold, and some loggers write a column of zeros for the other side."""
    time, _, _, true = rim(4)
    held = np.where(np.abs(true) > 0.5, true, 0.0)
    for torque in (held, np.zeros_like(time)):
        found = baseline(time, torque + level)
        assert found.enough and (found.offset, found.offset_se) == (pytest.approx(level), pytest.approx(0, abs=1e-9))


def test_a_hand_that_never_leaves_the_rim_is_said():
    time = np.arange(0, 6, 1 / 240)
    found = baseline(time, 12 + 9 * np.sin(7 * time) + np.random.default_rng(0).normal(size=len(time)) * 0.2)
    assert not found.enough and "without a hand" in found.why and "stand" in found.why
    gone = baseline(time, np.full(len(time), np.nan))
    assert not gone.enough


def test_only_a_check_looks_at_rims_that_nobody_asked_about(campaign):
    """That takes as long as the reading itself, and an analysis has no use for it."""
    files = {}
    for seed, name in enumerate(("a.csv", "b.csv")):
        time, torque, _, _ = rim(seed, ripple=0.0)
        speed = 1 + 0.1 * np.sin(2 * time) + np.random.default_rng(seed).normal(0, 0.01, len(time))
        data = np.column_stack([time, torque, np.zeros_like(time), speed])
        files[name] = csv_text(["time [s]", "M_rl [N.m]", "M_rr [N.m]", "wheel_speed_l [m/s]"], rows(data))
    folder = campaign(head=HEAD, noise="", runs=RUNS, files=files)
    says = "the rim of M_rl shows 0."
    assert [f.fact.startswith(says) for f in check(folder)].count(True) == 1
    assert not any(f.fact.startswith(says) for f in read(folder).warnings)
    toml = HEAD + "[nuisance]\nM_rl = true\n" + RUNS
    assert not any(f.fact.startswith(says) for f in check(campaign(toml, files=files)))


@pytest.mark.parametrize("late", [0.0, 0.1])
@pytest.mark.parametrize("told", ["wheel_angle_l [rad]", "wheel_speed_l [m/s]"])
def test_a_ripple_is_taken_out_where_it_was_recorded(campaign, late, told):
    """Also where the pushes are read later than their file says: the wheel's angle goes with them. Where nobody recorded it,
    its speed tells it."""
    time, recorded, angle, true = rim(0)
    speed = 0.31 * np.interp(time - late * ("speed" in told), time, np.gradient(angle, time))
    speed += np.random.default_rng(1).normal(0, 0.01, len(time))
    columns = {"time [s]": time, "M_rl [N.m]": recorded, "wheel_angle_l [rad]": angle, "wheel_speed_l [m/s]": speed}
    columns = {name: values for name, values in columns.items() if name != "wheel_angle_l [rad]" or name == told}
    files = {"a.csv": csv_text([*columns], rows(np.column_stack([*columns.values()])))}
    entry = RUNS.partition('[[run]]\nfile = "b.csv"')[0] + f"constant = {{ M_rr = 0 }}\nclocks = {{ pushes = {late} }}\n"
    (run,) = read(campaign(HEAD + "[nuisance]\nM_rl = true\n" + entry, files=files)).runs
    left = run.inputs["push.M_rl"] - np.interp(run.time - late, time, true)
    assert np.std(left) < 0.26 and np.mean(left) == pytest.approx(0, abs=0.03)
