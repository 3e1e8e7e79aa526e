"""Clocks and baselines of simulated lab recordings, beside their truths, where these lie beside the project."""

from __future__ import annotations

import json

import numpy as np
import pytest

from benchmarks.clocks import baseline_errors, clock_errors, run_signals
from wheelchair_fmu.campaign import read
from wheelchair_fmu.campaign.clocks import odd_ones_out

from .test_measurements import MEASUREMENTS, OPEN, folder

SOME = [("lab-00", "run05"), ("lab-01", "run03"), ("lab-02", "m03")]
ALL = [(f"lab-{i:02d}", f"{'m0' if i == 2 else 'run0'}{k}") for i in range(3) for k in range(1, 8)]


def truth(lab: str) -> dict:
    folder(lab)
    return json.loads((MEASUREMENTS / "lab-answers.json").read_text())[lab]


def agree(lab: str, run: str) -> None:
    if lab == "lab-02":
        pytest.importorskip("openpyxl", reason="reading a workbook needs openpyxl")
    for name, error, se in clock_errors(folder(lab), truth(lab), run):
        assert abs(error) < 0.02, name
        assert abs(error) < 3.5 * se, name


@pytest.mark.parametrize(("lab", "run"), SOME)
def test_every_clock_is_sure_and_right(lab, run):
    agree(lab, run)


@pytest.mark.nightly
@pytest.mark.parametrize(("lab", "run"), [pair for pair in ALL if pair not in SOME])
def test_every_clock_is_sure_and_right_in_all_runs(lab, run):
    agree(lab, run)


@pytest.mark.parametrize(("lab", "side"), [("lab-00", "left"), ("lab-01", "right")])
def test_baselines_and_ripple_are_within_their_errors(lab, side):
    z = [error / se for _, error, se in baseline_errors(folder(lab), truth(lab), side)]
    assert np.max(np.abs(z)) < 2.0


def test_scrub_that_delays_a_turn_is_no_clock():
    assert odd_ones_out({run.name: run_signals(run) for run in read(folder("open-04-scrub")).runs}) == {}


@pytest.mark.nightly
@pytest.mark.parametrize("early", [0.0, 0.03])
@pytest.mark.parametrize("name", OPEN)
def test_no_hidden_effect_and_no_delay_of_all_pushes_names_a_run(name, early):
    assert odd_ones_out({run.name: run_signals(run, early) for run in read(folder(f"open-{name}")).runs}) == {}
