"""`wheelchair sweep` as a user meets it."""

from __future__ import annotations

from pathlib import Path

import pandas as pd
import pytest
from typer.testing import CliRunner

from tests.kit import tracked, with_settings
from wheelchair_fmu.cli.main import app

SAMPLE = Path(__file__).parents[2] / "examples" / "sample-campaign"
PLAN = f"""
[sweep]
method = "morris"
samples = 2
campaign = "{SAMPLE}"
[parameters]
"effect.rolling_resistance_asymmetry.D" = {{ from = 0, to = 4 }}
"chair.m" = {{ from = 70, to = 90 }}
[[manoeuvre]]
name = "spin"
time = 2
"""


def wheelchair(*words):
    return CliRunner().invoke(app, [str(w) for w in words])


def test_sweep_writes_a_table_and_its_indices(tmp_path):
    (tmp_path / "plan.toml").write_text(PLAN)
    done = wheelchair("sweep", tmp_path / "plan.toml", "-o", tmp_path / "out.parquet", "--workers", 1)
    assert done.exit_code == 0, done.output
    assert done.stderr == "", "a bar that is done has nothing to say to a file or a notebook"
    table = pd.read_parquet(tmp_path / "out.parquet")
    assert len(table) == 12 and set(table.manoeuvre) == {"spin time=2", "campaign sample-chair"}
    measured = table[table.rms.notna()]
    assert len(measured) == 6 and (measured.rms > 0.9).all() and measured.drift.isna().all()
    indices = pd.read_csv(tmp_path / "out-indices.csv")
    assert {"drift", "rms", "rms_holdout"} <= set(indices.quantity) and (indices.left_out == 0).all()
    assert "mu_star, by parameter" in done.output
    assert sorted(file.name for file in tmp_path.iterdir()) == ["out-indices.csv", "out.parquet", "plan.toml"]
    again = wheelchair("sweep", tmp_path / "plan.toml", "-o", tmp_path / "out.parquet")
    assert again.exit_code == 0 and "already done by this plan" in again.stderr


@pytest.mark.parametrize("engine", ["kernel", pytest.param("fmu", marks=pytest.mark.nightly)])
def test_the_rms_is_that_of_compare(tmp_path, engine):
    folder = tracked(with_settings(SAMPLE, tmp_path / "campaign"))
    (tmp_path / "plan.toml").write_text('[sweep]\ncampaign = "campaign"\n')
    words = ("-o", tmp_path / "o.parquet", "--workers", 1, "--engine", engine)
    assert wheelchair("sweep", tmp_path / "plan.toml", *words).exit_code == 0
    (row,) = pd.read_parquet(tmp_path / "o.parquet").to_dict("records")
    shown = wheelchair("compare", folder).output
    assert f"fitted runs together: {row['rms_fit']:.3f}" in shown
    assert f"held-out runs together: {row['rms_holdout']:.3f}" in shown


def test_effects_of_ones_own_are_in_the_sweep(tmp_path):
    folder, out = tmp_path / "effects", tmp_path / "out.parquet"
    assert wheelchair("effects", "new", "my_drag", "-o", folder).exit_code == 0
    plan = '[parameters]\n"effect.my_drag.q" = [0, 2]\n[[manoeuvre]]\nname = "coast-down"\ntime = 1\n'
    (tmp_path / "plan.toml").write_text(plan)
    words = ("sweep", tmp_path / "plan.toml", "-o", out, "--workers", 1)
    assert "no parameter 'effect.my_drag.q'" in wheelchair(*words).stderr
    assert wheelchair(*words, "--effects", folder).exit_code == 0
    without, slowed = pd.read_parquet(out).speed_end
    assert slowed < without - 0.02
    (folder / "my_drag.py").write_text("EFFECT = 1\n")
    spoilt = wheelchair(*words, "--effects", folder)
    assert spoilt.exit_code == 1 and f"{folder / 'my_drag.py'}: EFFECT is of type int" in spoilt.stderr


def test_the_examples_indices_say_what_the_paper_says(tmp_path):
    """Slip goes inversely with the cornering stiffness; the radius hardly notices it (section 6.1)."""
    done = wheelchair("sweep", SAMPLE.parent / "sweep.toml", "-o", tmp_path / "out.parquet")
    assert done.exit_code == 0, done.output
    table = pd.read_csv(tmp_path / "out-indices.csv").set_index(["manoeuvre", "quantity", "parameter"]).ST
    turn = table["steady-turn delta_force=10"]
    assert turn["slip_peak_rl"].idxmax() == turn["slip_peak_rr"].idxmax() == "tyre.C_lambda"
    assert turn["radius"]["tyre.C_lambda"] < 0.05 and turn["radius"].idxmax() == "chair.b"


@pytest.mark.parametrize(
    ("words", "code", "sentence"),
    [
        (("plan.toml", "-o", "out.csv"), 2, "the table is Parquet; give a name that ends in .parquet"),
        (("plan.toml", "-o", "o.parquet", "--engine", "fmi"), 2, "no engine 'fmi'; did you mean 'fmu'?"),
        (("plan.toml", "-o", "o.parquet", "--dask", "x", "--workers", 2), 2, "give one of them"),
        (("none.toml", "-o", "o.parquet"), 1, "none.toml: no such file"),
        (
            ("plan.toml", "-o", "o.parquet", "--effects", "none"),
            1,
            "none: no such folder; `wheelchair effects new ID` starts one",
        ),
        (("plan.toml",), 2, "--output"),
    ],
)
def test_sweep_refuses_in_one_sentence(tmp_path, monkeypatch, words, code, sentence):
    monkeypatch.chdir(tmp_path)
    Path("plan.toml").write_text(PLAN)
    done = wheelchair("sweep", *words)
    assert done.exit_code == code and sentence in done.stderr and "Traceback" not in done.output
    assert [file.name for file in tmp_path.iterdir()] == ["plan.toml"]
