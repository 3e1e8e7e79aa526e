"""docs/performance.md is made of its records and of nothing else."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks import page
from benchmarks.rows import Row

ROOT = Path(__file__).parent.parent


def test_the_page_is_made_of_its_records():
    records = json.loads((ROOT / page.KEPT).read_text(encoding="utf-8"))
    assert (ROOT / page.PAGE).read_text(encoding="utf-8") == page.page(records)


def test_a_row_and_its_limit_on_the_page():
    rows = [
        Row("a run", "ms", [2.0, 4.0, 3.0], 10.0, 45.0, "beside another", limit=1.5, why="12 operations", released=3.5),
        Row("a file", "s", [5.0], 4.0),
    ]
    made = page.page(
        {"machine": {"cores": "2", "release": "v0.1.0", "core": "1 GFLOP/s"}, "rows": [row.as_json() for row in rows]}
    )
    assert "- Cores: 2\n- Last release: v0.1.0\n- A core: 1 GFLOP/s\n" in made
    assert "| a run | 3 ms | 2 to 4 | 3.5 ms | 15.0× | ≥ 10×: met | beside another |" in made
    assert "| a file | 5 s | 5 to 5 |  |  | ≤ 4 s: **missed** |  |" in made
    assert made.count("| a run | 3 ms | 1.5 ms | 2.0× | 12 operations |") == 1 and made.count("a file") == 1


@pytest.fixture
def elsewhere(tmp_path, monkeypatch):
    (tmp_path / "docs").mkdir()
    (tmp_path / "out").mkdir()
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_command_keeps_the_records_beside_the_page(elsewhere, capsys):
    text = json.dumps({"machine": {"cores": "1"}, "rows": [Row("a run", "ms", [2.0]).as_json()]})
    page.RECORDS.write_text(text)
    assert page.main() == 0 and json.loads(page.KEPT.read_text()) == json.loads(text)
    assert page.PAGE.read_text(encoding="utf-8") == page.page(json.loads(text))
    assert "docs/performance.md" in capsys.readouterr().out.replace("\\", "/")


def test_large_ones_have_a_section_and_either_stays_where_the_other_is_run(elsewhere):
    def records(what, cores):
        return json.dumps({"machine": {"cores": cores}, "rows": [Row(what, "ms", [2.0]).as_json()]})

    page.RECORDS.write_text(records("a run", "1"))
    assert page.main() == 0
    page.RECORDS.unlink()
    page.OF_LARGE.write_text(records("a fleet", "8"))
    assert page.main() == 0
    usual, _, large = page.PAGE.read_text(encoding="utf-8").partition("## Large")
    assert "| a run |" in usual and "- Cores: 1\n" in usual and "a fleet" not in usual
    assert "| a fleet |" in large and "- Cores: 8\n" in large and "a run |" not in large


def test_without_records_it_says_what_writes_them(elsewhere, capsys):
    assert page.main() == 2 and "make bench writes it" in capsys.readouterr().err
