"""docs/your-own-effect.md: its commands do what it shows."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from wheelchair_fmu.cli.main import app

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "your-own-effect.md").read_text(encoding="utf-8")


def commands() -> list[tuple[str, str]]:
    """Each command of the page, with what is shown below it."""
    blocks = re.findall(r"```\n(\$ .*?)```", PAGE, re.DOTALL)
    return [(entry.partition("\n")[0], entry.partition("\n")[2]) for block in blocks for entry in block[2:].split("\n$ ")]


def follow(page: list[tuple[str, str]], folder: Path) -> None:
    """Run the page's commands in this folder; the file is put in place behind the first, as the page says."""
    (folder / "examples").symlink_to(ROOT / "examples")
    for command, shown in page:
        told = _told(shlex.split(command), folder)
        for line in filter(None, shown.splitlines()):
            assert line in told.splitlines(), (command, told)
        if " new " in command:
            program, test = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
            (folder / "effects" / "rubbing_brake.py").write_text(program, encoding="utf-8")
            (folder / "test_rubbing_brake.py").write_text(test, encoding="utf-8")


def _told(words: list[str], folder: Path) -> str:
    if words[0] == "wheelchair":
        done = CliRunner().invoke(app, words[1:], catch_exceptions=False)
        return done.output
    if words[0] == "pytest":
        words = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *words[1:]]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": str(ROOT)})
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.skipif(shutil.which("sed") is None, reason="the page edits a file with sed")
def test_what_is_quick(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    quick = [
        (c, shown) for c, shown in commands() if c.startswith(("wheelchair effects", "wheelchair simulate", "sed", "pytest"))
    ]
    assert len(quick) == 6
    follow(quick, tmp_path)


@pytest.mark.nightly
def test_the_whole_page(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    follow(commands(), tmp_path)
    assert (tmp_path / "dist" / "Better.fmu").exists()
