"""Long recordings in pieces, and the choice of windows from a large campaign."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from wheelchair_fmu.campaign import Campaign, Run, pieces, windows
from wheelchair_fmu.campaign.windows import HEADING, WINDOW


def turning(name, role="fit", seconds=600.0, rate=0.2, **channels) -> Run:
    """A run at 1 m/s that turns at a constant rate but for a second's pause in every two."""
    time = np.arange(round(seconds * 50) + 1) / 50
    yaw_rate = np.where(np.mod(time, 2) < 1, 0.0, rate)
    push = np.sin(time)
    return Run(
        name,
        Path(f"{name}.csv"),
        "turns",
        role,
        0.7,
        {"chair.m": 90.0},
        time,
        {"push.F_rl": push, "push.F_rr": -push},
        {"wheel_speed_l": 1 + 0 * time, "wheel_speed_r": 1.2 + 0 * time, "yaw_rate": yaw_rate, **channels},
    )


def campaign(*runs) -> Campaign:
    return Campaign("turns", Path("turns"), "SAE-J670", {}, {}, {}, frozenset(), (), {}, runs, "")


def test_pieces_are_the_whole_run_once():
    run = turning("a", seconds=130)
    parts = pieces(run, 60)
    assert np.array_equal(np.concatenate([p.time for p in parts]), run.time)
    assert np.array_equal(np.concatenate([p.inputs["push.F_rl"] for p in parts]), run.inputs["push.F_rl"])
    assert [len(p.time) for p in parts] == pytest.approx([3250, 3251], abs=1) and len({p.name for p in parts}) == 2
    assert parts[0].u0 == 0.7 and parts[1].u0 == pytest.approx(1.1)  # stated; then from both wheels


def test_a_short_run_is_its_own_piece():
    run = turning("a", seconds=100)
    assert pieces(run, 60) == [run]


def test_a_piece_has_the_heading_that_the_yaw_rate_says_or_a_channel_tells():
    run = turning("a", seconds=120)
    assert pieces(run, 60)[1].set == {"chair.m": 90.0, HEADING: pytest.approx(0.2 * 30, abs=0.01)}
    tracked = turning("a", seconds=120, yaw=np.zeros(6001))
    assert pieces(tracked, 60)[1].set == {"chair.m": 90.0}


def test_where_a_run_starts_says_nothing_of_its_later_pieces_but_the_heading():
    run = turning("a", seconds=120)
    said = {"start.u": 0.5, "start.x": 2.0, HEADING: 1.0}
    first, second = pieces(replace(run, set={**run.set, **said}), 60)
    assert first.set == {"chair.m": 90.0, **said}
    assert second.set == {"chair.m": 90.0, HEADING: pytest.approx(1 + 0.2 * 30, abs=0.01)}
    blind = replace(run, set={**run.set, **said}, channels={"wheel_speed_l": 1 + 0 * run.time})
    assert pieces(blind, 60)[1].set == {"chair.m": 90.0, HEADING: 1.0}  # nothing says otherwise


def test_a_small_campaign_is_left_alone():
    small = campaign(turning("a", seconds=20))
    assert windows(small) is small


def test_a_large_one_is_thinned_evenly_and_says_so():
    large = campaign(*(turning(f"run{n}") for n in range(6)), *(turning(f"held{n}", "holdout") for n in range(2)))
    chosen = windows(large, most=24_000)  # a tenth
    assert 0.6 * 24_000 < sum(len(r.time) for r in chosen.runs) <= 24_000
    for role, count in (("fit", 6), ("holdout", 2)):
        names = [r.name.partition("@")[0] for r in chosen.runs if r.role == role]
        assert len(set(names)) == count and max(map(names.count, names)) - min(map(names.count, names)) == 0
    starts = np.sort([r.time[0] for r in chosen.runs if r.name.startswith("run0@")])
    assert np.diff(starts).max() < 2 * 600 / len(starts) and starts[0] < 2 * 600 / len(starts)
    assert all(WINDOW - 2.1 < r.time[-1] - r.time[0] < WINDOW + 0.5 and r.set["chair.m"] == 90 for r in chosen.runs)
    assert f"{len(chosen.runs)} windows" in chosen.thinned and "240008 samples" in chosen.thinned
    assert windows(chosen, most=100) is chosen


def test_windows_share_no_sample_and_begin_where_the_chair_goes_straight():
    chosen = windows(campaign(turning("a")), most=15_000)
    ends = sorted((r.time[0], r.time[-1]) for r in chosen.runs)
    assert len(ends) > 20 and all(stop < start for (_, stop), (start, _) in pairwise(ends))
    assert all(r.channels["yaw_rate"][:25].max() == 0 for r in chosen.runs)


def test_more_runs_than_windows():
    chosen = windows(campaign(*(turning(f"r{n}", seconds=12) for n in range(100))), most=6_000)
    assert 8 <= len(chosen.runs) <= 10 and sum(len(r.time) for r in chosen.runs) <= 6_050


def test_a_gap_in_the_record_gives_no_empty_piece():
    run = turning("a")
    there = (run.time < 100) | (run.time > 400)
    cut = {kind: {name: v[there] for name, v in getattr(run, kind).items()} for kind in ("inputs", "channels")}
    parts = pieces(replace(run, time=run.time[there], **cut), 12)
    assert all(len(p.time) >= 10 for p in parts) and sum(len(p.time) for p in parts) == there.sum()
