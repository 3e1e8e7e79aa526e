"""What is bundled in examples/."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.util import read_csv

from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies import fmu_of

EXAMPLES = Path(__file__).parents[2] / "examples"


def simulated(name: str, capsys) -> np.ndarray:
    result = fmpy.simulate_fmu(str(fmu_of(Variant())), input=read_csv(str(EXAMPLES / f"{name}.csv")))
    assert "missing input" not in capsys.readouterr().out
    return result


def test_the_input_files_are_those_of_their_script(tmp_path):
    subprocess.run(
        [sys.executable, str(EXAMPLES / "make_inputs.py"), str(tmp_path)],
        check=True,
        cwd=EXAMPLES.parent,
        env={"PYTHONPATH": str(EXAMPLES.parent)},
    )
    for name in ("push", "turn", "slalom"):
        assert (tmp_path / f"{name}.csv").read_text() == (EXAMPLES / f"{name}.csv").read_text()


def test_push_speeds_the_chair_up_in_strokes(capsys):
    u = simulated("push", capsys)["chair.u"]
    assert 1.2 < u[-1] < 2.0 and (np.diff(u) < 0).any() and (np.diff(u) > 0).any()


def test_turn_goes_round_to_the_right_at_about_constant_speed(capsys):
    result = simulated("turn", capsys)
    assert result["chair.psi"][-1] > 2 and abs(result["chair.u"][-1] - 1) < 0.1


def test_slalom_swings_both_ways(capsys):
    rate = simulated("slalom", capsys)["chair.psi_dot"]
    assert rate.max() == pytest.approx(-rate.min(), rel=0.2) and rate.max() > 0.2
