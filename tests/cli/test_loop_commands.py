"""compare, add and effects of one's own, as a user types them."""

from __future__ import annotations

import gc
import json
import re
import shutil
import tomllib
from pathlib import Path
from weakref import ref

import pytest
from typer.testing import CliRunner

from tests.kit import with_runs, with_settings
from wheelchair_fmu.api.comparing import compared
from wheelchair_fmu.campaign import condensed, read
from wheelchair_fmu.cli import compare
from wheelchair_fmu.cli.main import app
from wheelchair_fmu.cli.settings import subject
from wheelchair_fmu.cli.staircase import staircase_table
from wheelchair_fmu.inference.decision.among_forces import FORCES
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.residual.staircase import Step
from wheelchair_fmu.model.variant import Variant

SAMPLE = str(Path(__file__).parents[2] / "examples" / "sample-campaign")


def run(*words: str):
    return CliRunner().invoke(app, list(words), catch_exceptions=False)


@pytest.fixture
def brief(tmp_path_factory) -> str:
    """The sample campaign with two of its runs."""
    return str(with_runs(Path(SAMPLE), tmp_path_factory.mktemp("brief") / "campaign", ("coast-down", "holdout-random")))


def test_compare_says_where_the_error_is():
    done = run("compare", SAMPLE, "--json")
    assert done.exit_code == 0
    told = json.loads(done.stdout)
    assert told["rms"]["fit"] == pytest.approx(17.0, abs=0.3)
    assert told["runs"][0].keys() == {"run", "role", "rms"}
    for bins in told["excess"].values():
        assert sum(b["share"] for b in bins) == pytest.approx(1.0)


def test_samples_that_are_compared_as_means_are_forgotten_before(monkeypatch):
    """The recordings of a day would otherwise be in memory as long as anything is compared."""
    recorded, left = [], []

    def remembered(*words):
        found = subject(*words)
        recorded.extend(ref(run) for run in found[1].runs)
        return found

    def counted(*words, **how):
        gc.collect()
        left.extend(run for run in recorded if run() is not None)
        return compared(*words, **how)

    monkeypatch.setattr(compare, "subject", remembered)
    monkeypatch.setattr(compare, "compared", counted)
    assert "is compared as means" in run("compare", SAMPLE).stderr
    assert recorded and not left


def test_json_is_all_that_compare_prints_whatever_it_writes(brief, tmp_path):
    told = json.loads(run("compare", brief, "--json", "-o", str(tmp_path)).stdout)
    assert told["campaign"] == "sample-chair" and list(tmp_path.glob("*.csv"))


@pytest.mark.parametrize(
    "values", [{}, pytest.param({"chair.m": 90.0, "effect.push_force_delay.tau": 0.02}, marks=pytest.mark.nightly)]
)
def test_compare_weighs_what_the_fmu_simulates(tmp_path, values):
    """By whatever a run sets, the FMU goes as the model does by which its errors are weighed."""
    measured = condensed(read(with_settings(Path(SAMPLE), tmp_path / "campaign")))
    expected = Likelihood(measured, Variant()).evidence(measured.runs, values, tune_start=2).table()
    settings = [word for n, v in values.items() for word in ("--set", f"{n}={v}")]
    for told in json.loads(run("compare", str(measured.path), "--json", *settings).stdout)["runs"]:
        assert told["rms"] == pytest.approx(expected[told["run"]], rel=2e-3), told["run"]


def test_compare_with_what_was_hidden_comes_near_the_floor():
    values = {
        "tyre.C_lambda": 4790.8,
        "resistance.f_r": 0.018145,
        "resistance.f_f": 0.017922,
        "chair.I_z": 3.0931,
        "effect.rolling_resistance_asymmetry.D": 1.6066,
    }
    settings = [word for n, v in values.items() for word in ("--set", f"{n}={v}")]
    told = json.loads(run("compare", SAMPLE, "--json", *settings).stdout)
    # chair.I_z and the like go before what the campaign file says
    assert told["rms"]["holdout"] < 1.05


def test_compare_says_which_calibrated_value_nobody_should_believe():
    """A centre of mass that is given 8 cm off comes back by the 4 cm that no tape errs by, and that is said."""
    asked = ("compare", SAMPLE, "--calibrate", "chair.m, chair.a, tyre.C_lambda", "--set", "chair.a=0.33")
    told = json.loads(run(*asked, "--json").stdout)
    assert set(told["calibration"]) == set(told["calibrated"]) == {"chair.m", "chair.a", "tyre.C_lambda"}
    a = told["calibration"]["chair.a"]
    assert (a["prior"], a["prior_sd"], a["at_bound"], a["beyond"]) == (0.33, pytest.approx(0.01), True, True)
    assert a["value"] == told["values"]["chair.a"] == pytest.approx(0.29)
    (note,) = (n for n in told["notes"] if n.startswith("chair.a"))
    assert "comes out at 0.29 m, 4.0 standard deviations from the 0.33 ± 0.01 m given, where the search stops" in note
    assert f"note: {note}" in " ".join(run(*asked).stdout.split())
    plain = json.loads(run("compare", SAMPLE, "--json").stdout)
    assert plain["calibration"] == {} and plain["notes"] == []


def test_add_writes_a_variant_that_everything_reads(tmp_path):
    better = tmp_path / "better.toml"
    done = run("add", "rolling_resistance_asymmetry", SAMPLE, "-o", str(better), "--json")
    assert done.exit_code == 0
    told = json.loads(done.stdout)
    assert [s["step"] for s in told["ladder"]] == ["nominal", "calibrated", "+rolling_resistance_asymmetry"]
    assert told["ladder"][0]["heldout"] > told["ladder"][1]["heldout"] > 1.05 > told["ladder"][2]["heldout"]
    table = tomllib.loads(better.read_text())
    assert table["values"]["effect.rolling_resistance_asymmetry.D"] == pytest.approx(1.6, abs=0.1)
    assert len(table["origin"]["fingerprint"]) == 64
    assert better.with_suffix(".png").read_bytes().startswith(b"\x89PNG")
    again = json.loads(run("compare", SAMPLE, "--variant", str(better), "--json").stdout)
    assert again["rms"]["holdout"] < 1.05


def test_add_says_what_it_estimated_with_units(tmp_path):
    said = run("add", "rolling_resistance_asymmetry", SAMPLE, "-o", str(tmp_path / "better.toml")).output
    size = re.search(r"^effect.rolling_resistance_asymmetry.D = (\S+) ± (\S+) N$", said, re.MULTILINE)
    assert size and float(size[1]) == pytest.approx(1.6, abs=3 * float(size[2]))
    written = tomllib.loads((tmp_path / "better.toml").read_text())["standard_errors"]
    assert written["effect.rolling_resistance_asymmetry.D"] == pytest.approx(float(size[2]), abs=0.0005)


@pytest.mark.parametrize(
    ("words", "code", "sentence"),
    [
        (("add", "relaxation", SAMPLE, "-o", "x.toml"), 2, "no effect 'relaxation'; did you mean 'relaxation_length'?"),
        (("compare", SAMPLE, "--calibrate", "tyre.law"), 2, "tyre.law cannot be calibrated"),
        (("compare", SAMPLE, "--set", "chair.m=-1"), 2, "chair.m = -1 is outside its bounds 1 to 1000 kg"),
        (("compare", "nowhere"), 1, "nowhere"),
        (("diagnose", SAMPLE, "--effects", "nowhere"), 1, "nowhere: no such folder"),
        (("effects", "new", "MyDrag"), 2, "'MyDrag' is no name for an effect"),
        (("effects", "new", "toe_misalignment"), 2, "there is an effect 'toe_misalignment' already"),
    ],
)
def test_bad_words_get_one_sentence(words, code, sentence, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = run(*words)
    assert done.exit_code == code
    assert sentence in done.stderr
    assert "Traceback" not in done.output
    assert not list(tmp_path.iterdir())


def test_an_effect_of_ones_own(tmp_path):
    """A stub, edited, simulated: with F = −5 N u |u| the chair stops sooner."""
    folder = tmp_path / "effects"
    assert run("effects", "new", "my_drag", "-o", str(folder)).exit_code == 0
    file = folder / "my_drag.py"
    file.write_text(file.read_text().replace("-q * u", "-q * u * magnitude(u, v_eps)").replace("N_S_M", "N_S2_M2"))
    done = run("simulate", "coast-down", "--effects", str(folder), "--set", "effect.my_drag.q=5", "-o", str(tmp_path / "out"))
    assert done.exit_code == 0, done.output
    last = (tmp_path / "out" / "coast-down.csv").read_text().splitlines()
    x = float(last[-1].split(",")[last[0].split(",").index("chair.x [m]")])
    drag = 9.81 * (0.012 * 0.25 + 0.020 * 0.20) / 0.45 * 80
    # closed form of m u u' = −D − q u² from 1 m/s to rest
    import math

    assert x == pytest.approx(80 / (2 * 5) * math.log(1 + 5 / drag), rel=1e-3)


def test_a_law_must_be_arithmetic():
    from wheelchair_fmu.errors import UsageError
    from wheelchair_fmu.model.expression import law

    assert law("-q * u")(2.0, 3.0) == -6.0
    for text, why in (("u.__class__", "has a point in it"), ("open(u)", "no function 'open'"), ("u +", "no expression")):
        with pytest.raises(UsageError, match=why):
            law(text)


def test_a_run_in_which_the_chair_stands_is_left_out(tmp_path):
    folder = tmp_path / "campaign"
    shutil.copytree(SAMPLE, folder)
    file = folder / "runs" / "straight-strokes.csv"
    header, *rows = file.read_text(encoding="utf-8").splitlines()
    still = [",".join([row.partition(",")[0], *["0"] * header.count(",")]) for row in rows]
    file.write_text("\n".join([header, *still]) + "\n", encoding="utf-8")
    assert run("check", str(folder)).exit_code == 0
    done = run("compare", str(folder), "--json")
    assert done.exit_code == 0 and done.stderr.count("says nothing and is left out") == 1
    told = json.loads(done.stdout)
    assert "straight-strokes" not in [r["run"] for r in told["runs"]] and len(told["runs"]) == 9


def test_a_notebook_s_colours_bring_no_control_codes_into_a_pipe(brief, tmp_path, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    told = run("compare", brief, "-o", str(tmp_path))
    assert told.exit_code == 0 and "\x1b" not in told.output


def test_a_staircase_says_from_where_on_forces_are_noise():
    steps = [Step("nominal", 9.0, 9.0), Step("calibrated", 3.0, 3.0)]
    assert staircase_table(steps).caption is None
    assert FORCES in str(staircase_table([*steps, Step(FORCES, 1.0, 1.0)]).caption)
