"""`wheelchair ssp` as typed."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from PIL import Image
from typer.testing import CliRunner

from wheelchair_fmu.cli.main import app
from wheelchair_fmu.studies.ssp import sources
from wheelchair_fmu.studies.ssp.reading import opened

ROOT = Path(__file__).parents[2]


def wheelchair(*words: object):
    return CliRunner().invoke(app, ["ssp", *(str(word) for word in words)])


@pytest.fixture(scope="module")
def archive(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("ssp") / "strokes.ssp"
    done = wheelchair("build", "strokes", "-o", path)
    assert done.exit_code == 0 and done.output.strip() == str(path)
    return path


def test_run_writes_a_table_a_figure_and_a_film(archive, tmp_path):
    done = wheelchair("run", archive, "--time", 1, "--step", 0.02, "--animation", "-o", tmp_path)
    assert done.exit_code == 0, done.output
    assert sorted(f.name for f in tmp_path.iterdir()) == ["strokes.csv", "strokes.gif", "strokes.png"]
    header, *rows = (tmp_path / "strokes.csv").read_text().splitlines()
    assert header.startswith("time [s],Chair.chair.x [m],") and len(rows) == 51 and rows[-1].startswith("1,")
    assert Image.open(tmp_path / "strokes.gif").n_frames > 3
    assert "Chair.chair.x [m]" in done.output


def test_check_finds_no_fault_in_what_build_makes(archive):
    assert wheelchair("check", archive).output == f"{archive}: no faults\n"
    assert json.loads(wheelchair("check", archive, "--json").output) == []


def test_check_tells_faults_and_fails(archive, tmp_path):
    import zipfile

    bad = tmp_path / "bad.ssp"
    with zipfile.ZipFile(archive) as good, zipfile.ZipFile(bad, "w") as made:
        for name in good.namelist():
            made.writestr(name, good.read(name).replace(b'value="80"', b'value="-80"'))
    done = wheelchair("check", bad)
    assert done.exit_code == 1 and "Parameter chair.m: -80 is outside the bounds" in done.output
    fault = json.loads(wheelchair("check", bad, "--json").output)[0]
    assert fault["file"].endswith(".ssv") and fault["line"] > 0 and set(fault) == {"file", "element", "fact", "cure", "line"}
    done = wheelchair("run", bad, "-o", tmp_path / "out")
    assert done.exit_code == 1 and not (tmp_path / "out").exists()


def test_parameters_of_a_chair_with_an_effect_of_ones_own(tmp_path):
    folder, variant, target = tmp_path / "effects", tmp_path / "own.toml", tmp_path / "own.ssv"
    assert CliRunner().invoke(app, ["effects", "new", "my_drag", "-o", str(folder)]).exit_code == 0
    variant.write_text('[laws]\neffects = ["my_drag"]\n[values]\n"effect.my_drag.q" = 5.0\n')
    assert "no effect 'my_drag'" in wheelchair("parameters", variant, "-o", target).output
    done = wheelchair("parameters", variant, "--effects", folder, "-o", target)
    assert done.exit_code == 0, done.output
    assert 'name="effect.my_drag.q"' in target.read_text()


@pytest.mark.parametrize("source", ["low-cost-tyre", "ssp/parameters/fitted.toml"])
def test_parameters_writes_a_set_that_a_run_can_bind(source, archive, tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    target = tmp_path / "mine.ssv"
    done = wheelchair("parameters", source, "-o", target, "--ssp", 2)
    assert done.exit_code == 0 and done.output.strip() == str(target)
    with opened(archive) as unpacked:
        (unpacked.folder / "mine.ssv").write_bytes(target.read_bytes())
        assert dict(unpacked.parameter_set("mine.ssv").settings) == dict(sources.parameter_set(source)[1].settings)
        assert unpacked.faults == []


def test_build_replays_a_recording(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    path = tmp_path / "replay.ssp"
    run = "examples/sample-campaign/runs/straight-strokes.csv"
    assert wheelchair("build", "strokes", "--replay", run, "-o", path).exit_code == 0
    done = wheelchair("run", path, "--time", 0.5, "-o", tmp_path)
    assert done.exit_code == 0, done.output


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        (("build", "slolam"), 2, "no system 'slolam'; did you mean 'slalom'?"),
        (("build", "slalom", "--ssp", 3), 2, "there is no SSP 3; choose 1 or 2"),
        (("build", "--parameters", "deflated"), 2, "did you mean 'deflated-tyres'?"),
        (("build", "--replay", "nothing.csv"), 1, "nothing.csv: no such file; give a CSV with the columns time, F_rl, F_rr"),
        (("build", "--variant", "nothing.toml"), 1, "nothing.toml: no such file"),
        (("run", "nothing.ssp"), 1, "nothing.ssp: no such file; build one with `wheelchair ssp build`"),
        (("check", "README.md"), 1, "README.md: not a zip archive that can be read"),
        (("parameters", "nothing.toml", "-o", "x.ssv"), 1, "nothing.toml: no such file"),
        (("parameters", "low-cost", "-o", "x.ssv"), 2, "no parameter set 'low-cost'; did you mean 'low-cost-tyre'?"),
    ],
)
def test_what_is_wrong_is_said_in_one_sentence(words, code, told, monkeypatch):
    monkeypatch.chdir(ROOT)
    done = wheelchair(*words)
    assert done.exit_code == code and told in done.output, done.output


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("time [s],F_rl [N]\n0,1\n1,2\n", "there is no column F_rr"),
        (
            "time [s],F_rl [N],F_rr [kg]\n0,1,1\n1,2,2\n",
            "line 1 column 'F_rr [kg]': unit 'kg' measures a mass, but 'N' is needed",
        ),
        ("time [s],F_rl [N],F_rr [N]\n0,1,1\n1,,2\n", "line 3 column 'F_rl [N]': a gap, which hands cannot replay"),
        ("time [s],F_rl [N],F_rr [N]\n0,1,1\n1,two,2\n", "line 3 column 'F_rl [N]': 'two' is not a number"),
        ("time [s],F_rl [N],F_rr [N]\n1,1,1\n0,2,2\n", "time that rises from sample to sample"),
    ],
)
def test_a_bad_recording_is_told_by_line_and_column(text, told, tmp_path):
    (tmp_path / "r.csv").write_text(text)
    done = wheelchair("build", "strokes", "--replay", tmp_path / "r.csv", "-o", tmp_path / "r.ssp")
    assert done.exit_code == 1 and told in done.output, done.output
    assert not (tmp_path / "r.ssp").exists()
