"""`wheelchair tyre`: what it prints and writes, and how it ends."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from typer.testing import CliRunner

from wheelchair_fmu.cli.main import app
from wheelchair_fmu.model.variant import read_variant

EXAMPLES = Path(__file__).parents[2] / "examples"
DISC = EXAMPLES / "rotating-disc.csv"


def wheelchair(*words: object):
    return CliRunner().invoke(app, [str(word) for word in words])


@pytest.fixture(scope="module")
def told():
    done = wheelchair("tyre", "fit", DISC, "--json")
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def test_json_has_the_keys_that_are_fixed_in_si_units(told):
    assert len(told["conditions"]) == 8
    for c in told["conditions"]:
        assert set(c) >= {"tyre", "pressure", "load", "speed", "linear", "dugoff", "magic_formula"}
        assert c["pressure"] in (2e5, 4e5) and c["load"] in (400, 600)
        assert set(c["linear"]) >= {"C_lambda", "C_m_lambda", "C_phi", "C_m_phi", "interval", "range"}
        assert set(c["dugoff"]) >= {"C_lambda", "mu", "c_p", "rms_force", "rms_torque"}
        for channel in ("force", "torque"):
            assert set(c["magic_formula"][channel]) >= {"B", "C", "D", "E", "rms"}
    first = told["conditions"][0]
    assert first["speed"] == pytest.approx(4 / 3.6)
    assert first["linear"]["C_lambda"] == pytest.approx(5038, rel=0.02)
    assert 0 < first["linear"]["range"]["C_lambda"]["angle"] < math.radians(5)
    assert told["across"]["A"]["laws"]["C_lambda"]["exponents"]["pressure"]["value"] == pytest.approx(0.62, abs=0.03)


def test_the_coefficients_in_json_are_those_of_equation_1_in_the_papers_signs(told):
    """Y = D sin(C atan(Bx − E(Bx − atan Bx))) at 5°, against the half difference in the file."""
    for channel, raw in (("force", (-327.56, 346.41)), ("torque", (1.5131, -1.6932))):
        law = told["conditions"][0]["magic_formula"][channel]
        z = law["B"] * math.radians(5)
        Y = law["D"] * math.sin(law["C"] * math.atan(z - law["E"] * (z - math.atan(z))))
        assert pytest.approx((raw[1] - raw[0]) / 2, abs=3 * law["rms"]) == Y
        assert law["B"] * law["C"] * law["D"] == pytest.approx(law["BCD"])


def test_the_tables_name_every_condition():
    done = wheelchair("tyre", "fit", DISC)
    assert done.exit_code == 0
    for word in ("tyre A, 2 bar, 400 N, 4 km/h", "Dugoff", "Magic Formula, torque", "tyre B, C_lambda"):
        assert word in done.output


def test_the_figures_of_the_paper_are_written(tmp_path):
    done = wheelchair("tyre", "plot", DISC, "-o", tmp_path)
    assert done.exit_code == 0, done.output
    names = ("reference", "speed", "pressure", "load", "A-force", "A-torque", "B-force", "B-torque")
    assert sorted(f.name for f in tmp_path.iterdir()) == sorted(f"tyre-{n}.{e}" for n in names for e in ("png", "svg"))


def test_camber_alone_and_names_that_are_no_file_names_can_be_drawn(tmp_path):
    head, *rows = DISC.read_text().splitlines()
    lean = [row.replace("B,", "24/7 *,", 1) for row in rows if ",camber," in row]
    (tmp_path / "lean.csv").write_text("\n".join([head, *lean]))
    (tmp_path / "odd.csv").write_text(
        "\n".join([head, *(row.replace("B,", "24/7 *,", 1) for row in rows if row.startswith("B,"))])
    )
    for name, figure, there in (("lean", "tyre-24-7--force.png", False), ("odd", "tyre-24-7--force.png", True)):
        done = wheelchair("tyre", "plot", tmp_path / f"{name}.csv", "-o", tmp_path / name)
        assert done.exit_code == 0, done.output
        assert (tmp_path / name / "tyre-load.png").exists() and (tmp_path / name / figure).exists() == there
    refused = wheelchair("tyre", "export", tmp_path / "lean.csv", "--tyre", "A", "-o", tmp_path / "a.toml")
    assert refused.exit_code == 1 and "measure side slip, too" in refused.output


def test_an_export_is_a_variant_a_parameter_set_and_a_tyre_file(tmp_path):
    files = [tmp_path / f"a.{ending}" for ending in ("toml", "ssv", "tir")]
    done = wheelchair("tyre", "export", DISC, "--tyre", "A", "--pressure", 2, *(w for f in files for w in ("-o", f)))
    assert done.exit_code == 0 and done.output.split() == [str(f) for f in files]
    variant = read_variant(files[0])
    assert variant.choice.tyre == "magic_formula" and variant.values["tyre.pressure"] == 2
    assert "ParameterSet" in files[1].read_text() and "PCY1" in files[2].read_text()
    again = wheelchair("tyre", "fit", files[2], "--json")
    assert again.exit_code == 0 and json.loads(again.stdout)["conditions"][0]["pressure"] == pytest.approx(2e5)


def test_an_exported_tyre_drives_the_chair(tmp_path):
    assert wheelchair("tyre", "export", DISC, "--tyre", "B", "-o", tmp_path / "b.toml").exit_code == 0
    done = wheelchair("simulate", "steady-turn", "--variant", tmp_path / "b.toml", "-o", tmp_path)
    assert done.exit_code == 0, done.output


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (("fit", "none.csv"), 1, "none.csv: no such file"),
        (("fit", DISC, "--tolerance", 2), 2, "--tolerance 2 is no fraction"),
        (("fit", DISC, "--axes", "left"), 2, "no axes 'left'"),
        (("export", DISC, "--tyre", "A", "-o", "a.doc"), 2, "write a .toml, .ssv or .tir"),
        (("export", DISC, "-o", "a.toml"), 2, "choose one by --tyre"),
        (("export", DISC, "--tyre", "C", "-o", "a.toml"), 2, "no tyre 'C'"),
        (("export", DISC, "--tyre", "A", "--law", "magic", "-o", "a.toml"), 2, "did you mean 'magic_formula'"),
        (("export", DISC, "--tyre", "A", "--load", 500, "-o", "a.toml"), 2, "there are 400 N, 600 N"),
    ],
)
def test_bad_usage_says_what_is_wrong_and_writes_nothing(words, code, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = wheelchair("tyre", *words)
    assert done.exit_code == code and message in done.output
    assert not list(tmp_path.iterdir())


def test_data_that_support_no_fit_end_with_1(tmp_path):
    lines = DISC.read_text().splitlines()
    right = [line for line in lines[1:26] if float(line.split(",")[5]) > 0]
    (tmp_path / "half.csv").write_text("\n".join([lines[0], *right]))
    done = wheelchair("tyre", "fit", tmp_path / "half.csv")
    assert done.exit_code == 1
    assert "all angles are positive; measure every angle with both signs" in done.output
