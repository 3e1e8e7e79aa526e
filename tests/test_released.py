"""Which source the benchmark takes for the last release."""

from __future__ import annotations

import subprocess

import pytest

from benchmarks import released


@pytest.fixture
def checkout(tmp_path):
    """Three commits, whose file says which one it is."""
    place = tmp_path / "checkout"
    git(tmp_path, "init", "-q", place)
    for n in range(3):
        (place / "file").write_text(str(n))
        git(place, "add", "file")
        git(place, "-c", "user.name=n", "-c", "user.email=n@n", "commit", "-qm", str(n))
    return place


def git(place, *words):
    return subprocess.run(["git", *map(str, words)], cwd=place, check=True, capture_output=True, text=True).stdout.strip()


def test_the_newest_tag_before_this_commit_is_the_last_release(checkout, tmp_path):
    git(checkout, "tag", "v0.1.0", "HEAD~2")
    git(checkout, "tag", "other", "HEAD~1")
    git(checkout, "tag", "v0.2.0", "HEAD")  # the release that is measured
    found = released.last(checkout, tmp_path / "kept")
    assert found.name == "v0.1.0" and (found.tree / "file").read_text() == "0"
    (found.tree / "file").write_text("kept")
    assert released.last(checkout, tmp_path / "kept").tree == found.tree and (found.tree / "file").read_text() == "kept"


def test_before_any_release_the_baseline_stands_for_it(checkout, tmp_path):
    baseline = git(checkout, "rev-parse", "HEAD~1")
    found = released.last(checkout, tmp_path / "kept", baseline)
    assert found.name == f"none yet; beside it, commit {baseline[:7]}" and (found.tree / "file").read_text() == "1"


def test_where_neither_is_there_nothing_stands_beside(checkout, tmp_path):
    assert released.last(checkout, tmp_path / "kept") is None  # not this project's commits
    assert released.last(tmp_path, tmp_path / "kept") is None


def test_figures_are_read_from_what_its_own_benchmark_wrote(tmp_path):
    (tmp_path / "benchmarks").mkdir()
    (tmp_path / "benchmarks" / "bench.py").write_text(
        "import json, pathlib, sys\n"
        "pathlib.Path('out').mkdir()\n"
        "rows = [{'what': f'{sys.argv[1]} of old', 'median': 2.5}]\n"
        "pathlib.Path('out/bench.json').write_text(json.dumps({'rows': rows}))\n"
    )
    assert released.Released("v0", tmp_path).figures("step_cost") == {"step_cost of old": 2.5}
    assert released.Released("v0", tmp_path).figures("file_cost") == {}
    (tmp_path / "benchmarks" / "bench.py").write_text("raise SystemExit('no such option')")
    with pytest.raises(subprocess.CalledProcessError) as error:
        released.Released("v0", tmp_path).figures("step_cost")
    assert "no such option" in error.value.stderr
