"""`wheelchair report` and `wheelchair workbench` as typed, without a browser."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from wheelchair_fmu.cli.main import app
from wheelchair_fmu.report.page import unpacked

ROOT = Path(__file__).parents[2]
SAMPLE = str(ROOT / "examples" / "sample-campaign")
TOLD = ROOT / "tests" / "browser" / "sample-diagnosis.json"


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
