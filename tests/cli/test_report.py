"""`wheelchair report` and `wheelchair workbench` as typed, without a browser."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from tests.kit import SAMPLE_DIAGNOSIS as TOLD
from wheelchair_fmu.cli.main import app
from wheelchair_fmu.report.page import unpacked

ROOT = Path(__file__).parents[2]
SAMPLE = str(ROOT / "examples" / "sample-campaign")


def run(*words: str):
    return CliRunner().invoke(app, list(words), catch_exceptions=False)


def test_a_diagnosis_becomes_one_page(tmp_path):
    file = tmp_path / "report.html"
    done = run("report", SAMPLE, "--diagnosis", str(TOLD), "-o", str(file))
    assert done.exit_code == 0, done.output
    assert done.stdout == f"{file}\n"
    html = file.read_text(encoding="utf-8")
    assert "<h1" in html and "rolls harder than the other" in html
    content = unpacked(html)
    assert content["diagnosis"]["verdict"] == "missing"
    assert "seconds" not in content["diagnosis"]  # or the same measurements give another page each time
    assert [r["name"] for r in content["runs"]][-1] == "holdout-strokes"
    assert len(content["models"]) == 3


@pytest.mark.parametrize(
    ("content", "sentence"),
    [("no json", "not JSON"), ("{}", "no diagnosis; give what `wheelchair diagnose --json` wrote"), (None, "of 'another'")],
)
def test_any_other_file_is_refused(tmp_path, content, sentence):
    file, page = tmp_path / "diagnosis.json", tmp_path / "report.html"
    file.write_text(content if content is not None else json.dumps({**json.loads(TOLD.read_text()), "campaign": "another"}))
    done = run("report", SAMPLE, "--diagnosis", str(file), "-o", str(page))
    assert done.exit_code == 1
    assert sentence in done.stderr
    assert not page.exists()


@pytest.mark.parametrize(
    ("words", "sentence"), [(("nowhere",), "nowhere: no such folder"), (("--port", "99999999"), "port 99999999 cannot be used")]
)
def test_the_workbench_says_why_it_does_not_start(tmp_path, words, sentence):
    done = run("workbench", *words, "--no-open", "--folder", str(tmp_path / "work"))
    assert done.exit_code == 2
    assert sentence in done.stderr


def test_a_diagnosis_becomes_the_supplement_of_a_paper(tmp_path):
    done = run("report", SAMPLE, "--diagnosis", str(TOLD), "--paper", "-o", str(tmp_path / "supplement"))
    assert done.exit_code == 0, done.output
    assert [Path(line).name for line in done.stdout.splitlines()][:2] == ["methods.md", "methods.tex"]
    assert sorted(done.stdout.splitlines()) == sorted(map(str, (tmp_path / "supplement").iterdir()))


@pytest.mark.parametrize(
    ("change", "words", "sentence"),
    [
        ({"final": None}, (), "has no 'final', as earlier versions wrote it; diagnose the campaign again"),
        ({}, ("--set", "chair.m=80"), "was made with nothing set by --set; give the same values"),
        ({"campaign": "another"}, (), "a diagnosis of 'another', not of 'sample-chair'"),
    ],
)
def test_a_diagnosis_that_is_not_of_this_case_becomes_no_supplement(tmp_path, change, words, sentence):
    told, content = tmp_path / "d.json", {**json.loads(TOLD.read_text(encoding="utf-8")), **change}
    told.write_text(json.dumps({k: v for k, v in content.items() if v is not None}))
    done = run("report", SAMPLE, "--diagnosis", str(told), "--paper", "-o", str(tmp_path / "s"), *words)
    assert done.exit_code == 1 and not (tmp_path / "s").exists()
    assert done.stderr.splitlines()[-1].startswith(f"{told}: ") and sentence in done.stderr


def test_a_folder_that_cannot_be_written_is_a_sentence(tmp_path):
    place = tmp_path / "file"
    place.write_text("is here")
    done = run("report", SAMPLE, "--diagnosis", str(TOLD), "--paper", "-o", str(place))
    assert done.exit_code == 1 and place.read_text() == "is here"
    assert done.stderr.splitlines()[-1] == f"{place}: file exists; give another place, or the rights to use this one"
