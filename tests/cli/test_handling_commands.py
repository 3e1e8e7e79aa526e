"""`wheelchair linearize` as a user meets it."""

from __future__ import annotations

import json

import numpy as np
import pytest
from scipy.io import loadmat
from typer.testing import CliRunner

from wheelchair_fmu.cli.main import app


def wheelchair(*words):
    return CliRunner().invoke(app, [str(w) for w in words])


def test_linearize_prints_the_keys_that_are_fixed(tmp_path):
    done = wheelchair("linearize", "--speed", 1, "--delta-force", 10, "--json", "--mat", tmp_path / "turn.mat")
    told = json.loads(done.output)
    assert done.exit_code == 0
    assert {"v", "psi_dot", "radius", "slip_rl", "slip_rr", "total_force"} <= told["trim"].keys()
    assert told["trim"]["radius"] == pytest.approx(3.3018, abs=1e-4)
    assert told["states"] == ["v", "psi_dot"] and told["inputs"][:2] == ["push.F_rl", "push.F_rr"]
    A, B, C, D = (np.array(told[key]) for key in "ABCD")
    n, w, y = (len(told[key]) for key in ("states", "inputs", "outputs"))
    assert (A.shape, B.shape, C.shape, D.shape) == ((n, n), (n, w), (y, n), (y, w))
    assert not any(name in told["outputs"] for name in ("chair.x", "chair.psi", "sensor.y", "load.lifted"))
    eigenvalues = sorted(complex(*z).real for z in told["eigenvalues"])
    assert eigenvalues == pytest.approx(sorted(np.linalg.eigvals(A).real))
    assert told["radius_sensitivity"]["chair.b"] == pytest.approx(0.995, abs=1e-3)
    kept = loadmat(tmp_path / "turn.mat", simplify_cells=True)
    np.testing.assert_array_equal(kept["A"], A)
    assert list(kept["inputs"]) == told["inputs"]


def test_linearize_knows_laws_effects_values_and_free_speed(tmp_path):
    (tmp_path / "v.toml").write_text('[laws]\ntyre = "dugoff"\n[values]\n"chair.m" = 90\n')
    words = (
        "linearize",
        "--radius",
        -2,
        "--variant",
        tmp_path / "v.toml",
        "--effects",
        "relaxation_length",
        "--free-speed",
        "--set",
        "effect.relaxation_length.sigma=0.1",
    )
    told = json.loads(wheelchair(*words, "--json").output)
    assert told["states"] == ["u", "v", "psi_dot", *(f"effect.relaxation_length.lagged_slip.{w}" for w in ("rl", "rr"))]
    assert told["trim"]["radius"] == pytest.approx(-2) and told["trim"]["delta_force"] < 0
    shown = wheelchair(*words).output
    for word in ("R_c = -2 m", "lagged_slip.rl", "time constant", "chair.m + 1 %"):
        assert word in shown, word


def test_linearize_straight_on():
    told = json.loads(wheelchair("linearize", "--delta-force", 0, "--equations", "paper", "--json").output)
    assert told["trim"]["radius"] is None and told["radius_sensitivity"] == {}
    assert "straight on" in wheelchair("linearize", "--radius", "inf").output


@pytest.mark.parametrize(
    ("words", "code", "sentence"),
    [
        (("--delta-force", 1900), 1, "no steady turn at 1 m/s with ΔF = 1900 N"),
        (("--radius", 0.1, "--equations", "paper"), 1, "the nearest has ΔF ="),
        (("--radius", 2, "--delta-force", 3), 2, "give one of --delta-force and --radius"),
        (("--speed", 0, "--equations", "paper"), 2, "the paper divides by the forward speed"),
        (("--speed", "nan"), 2, "--speed nan m/s"),
        (("--set", "speed.u=2"), 2, "here --speed decides that"),
        (("--set", "tyre.C_lamda=2"), 2, "did you mean 'tyre.C_lambda'"),
        (("--set", "chair.m=-2"), 2, "outside its bounds"),
        (("--effects", "relaxation"), 2, "did you mean 'relaxation_length'"),
        (("--equations", "papr"), 2, "did you mean 'paper'"),
        (("--variant", "none.toml"), 1, "no such file"),
        (("--speed", "fast"), 2, "Invalid value for '--speed'"),  # then Typer in its own words
    ],
)
def test_linearize_refuses_in_one_sentence(words, code, sentence):
    done = wheelchair("linearize", *words)
    assert done.exit_code == code and sentence in done.stderr and "Traceback" not in done.output


def test_a_mat_file_that_cannot_be_written_leaves_what_was_there(tmp_path):
    (tmp_path / "full").write_text("kept")
    done = wheelchair("linearize", "--mat", tmp_path / "full" / "turn.mat")
    assert done.exit_code == 1 and (tmp_path / "full").read_text() == "kept"


@pytest.mark.nightly
def test_paper_writes_every_figure_and_the_table(tmp_path):
    done = wheelchair("paper", "--no-ranges", "-o", tmp_path)
    assert done.exit_code == 0 and "29 of 29 hold" in done.output
    figures = {f"fig-{n}.{ending}" for n in range(12, 20) for ending in ("png", "svg")}
    assert {f.name for f in tmp_path.iterdir()} == {"statements.md", *figures}
    told = json.loads(wheelchair("paper", "--no-ranges", "--json", "--delta-force", 60, "-o", tmp_path).output)
    holds = {s["id"]: s["holds"] for s in told["statements"]}
    assert not holds["slip-1-degree"] and holds["radius-cornering"]


def test_paper_refuses_in_one_sentence(tmp_path):
    for words, sentence in (
        (("--set", "tyre.C_lamda=2"), "did you mean 'tyre.C_lambda'"),
        (("--period", 0), "--period 0 s"),
        (("--delta-force", 9000), "outside"),
        (("--equations", "papr"), "did you mean 'paper'"),
    ):
        done = wheelchair("paper", "--no-ranges", "-o", tmp_path, *words)
        assert done.exit_code == 2 and sentence in done.stderr, done.output
    assert not list(tmp_path.iterdir())


def test_steady_says_how_the_chair_turns(tmp_path):
    done = wheelchair("steady", "--set", "effect.lateral_load_transfer.h=0.6", "-o", tmp_path)
    assert done.exit_code == 0
    for word in ("understeer", "a rear tyre slips by 1°", "a wheel lifts", "0.375", "no motion grows"):
        assert word in done.output, word
    assert {f.name for f in tmp_path.iterdir()} == {"steady-turns.csv", "eigenvalues.csv", "steady.png", "steady.svg"}
    told = json.loads(wheelchair("steady", "--radius", -2, "--slip-limit", 0.5, "--json", "-o", tmp_path).output)
    assert told["character"] == "understeer" and told["limits"]["slip"]["slip_rl"] == pytest.approx(np.radians(-0.5))
    assert len(told["root_locus"]) == 200 and "lift" not in told["limits"]


@pytest.mark.parametrize(
    ("words", "code", "sentence"),
    [
        (("--delta-force", 0), 2, "no turn to judge"),
        (("--speed", 0, "--delta-force", 5), 2, "no turn to judge"),
        (("--slip-limit", 0), 2, "0.001"),
        (("--delta-force", 900, "--set", "tyre.law=dugoff"), 1, "the nearest has ΔF ="),
    ],
)
def test_steady_refuses_in_one_sentence(tmp_path, words, code, sentence):
    done = wheelchair("steady", "-o", tmp_path / "new", *words)
    assert done.exit_code == code and sentence in done.stderr and not (tmp_path / "new").exists()
