"""Runs in which nothing changes: the chair stood still, or the logger held."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.campaign import check, read
from wheelchair_fmu.errors import CampaignError

from .small import HEAD, RUNS, SI, csv_text, motion, rows

SAYS = "no channel changes in this run (the chair stood still, or the logger held), so it says nothing and is left out"
THREE = RUNS + '[[run]]\nfile = "c.csv"\nmanoeuvre = "slalom"\nrole = "fit"\nu0 = 1.0\n'


def standing(pushed: bool = False, empty: bool = False) -> str:
    data = motion(seed=2)
    data[:, 3 if pushed else 1 :] = 0.0
    cells = rows(data)
    for row in cells if empty else ():
        row[5] = ""
    return csv_text(SI, cells)


@pytest.mark.parametrize("how", [{}, {"pushed": True}, {"empty": True}])
def test_a_run_in_which_nothing_changes_is_left_out_in_one_sentence(campaign, how):
    folder = campaign(runs=THREE, files={"c.csv": standing(**how)})
    assert [str(f) for f in check(folder)] == [f"warning: run c.csv: {SAYS}; remove the run, or record it again"]
    found = read(folder)
    assert [run.name for run in found.runs] == ["a", "b"]
    assert all(run.channels for run in found.runs)


def test_a_standing_chair_whose_sensors_are_noisy_says_something(campaign):
    data = motion(seed=2)
    data[:, 3:] = 0.005 * np.random.default_rng(3).standard_normal(data[:, 3:].shape)
    found = read(campaign(runs=THREE, files={"c.csv": csv_text(SI, rows(data))}))
    assert [run.name for run in found.runs] == ["a", "b", "c"]


def test_where_no_run_is_left_to_learn_from_that_is_an_error(campaign):
    folder = campaign(files={"a.csv": standing()})
    errors = [str(f) for f in check(folder) if f.severity == "error"]
    assert errors == [
        "campaign.toml: no channel changes in any run with the role 'fit', so there is nothing to "
        "learn from; give role = 'fit' to a run in which the chair moves"
    ]
    with pytest.raises(CampaignError, match="nothing to learn from"):
        read(folder)


def test_where_none_is_left_to_prove_on_that_is_said(campaign):
    folder = campaign(files={"b.csv": standing()})
    said = [str(f) for f in check(folder)]
    assert len(said) == 2 and said[1].startswith("warning: campaign.toml") and "no effect can be proven" in said[1]
    assert not read(folder).holdout


def test_a_run_that_states_a_constant_channel_is_kept(campaign):
    runs = THREE.rstrip() + "\nconstant = { yaw_rate = 0.0 }\n"
    found = read(campaign(runs=runs, files={"c.csv": standing()}))
    assert set(found.runs[2].channels) == {"yaw_rate"}


def test_a_channel_that_is_stuck_everywhere_needs_no_noise(campaign):
    data = motion()
    data[:, 6] = 0.0
    stuck = {"a.csv": csv_text(SI, rows(data)), "b.csv": csv_text(SI, rows(data))}
    found = read(campaign(head=HEAD, noise="[noise]\nyaw_rate = 0.006\n", files=stuck))
    assert "a_y" not in found.noise and "a_y" not in found.runs[0].channels
