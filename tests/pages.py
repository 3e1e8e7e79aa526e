"""Pages whose example is a file of a user's configuration and its test: both go into a folder, and the test is run there."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
BLOCK = re.compile(r"`([\w/]+\.py)`:\n\n```python\n(.*?)```", re.DOTALL)
PARTS = ("laws", "channels", "manoeuvres")  # of a configuration


def page(name: str) -> str:
    return (ROOT / "docs" / name).read_text(encoding="utf-8")


def with_example(name: str, folder: Path) -> Path:
    """Puts the page's file into the configuration `folder`/config, and its test into `folder`; returns the test."""
    tests = []
    for path, text in BLOCK.findall(page(name)):
        own = path.split("/")[0] in PARTS
        file = folder / "config" / path if own else folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
        tests += [] if own else [file]
    (test,) = tests
    return test


def attempt(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Python in the folder, with its configuration."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "WHEELCHAIR_CONFIG": str(folder / "config")}
    return subprocess.run([sys.executable, *words], cwd=folder, env=environment, capture_output=True, text=True)


def run(folder: Path, *words: str) -> str:
    """What Python prints there; raises AssertionError with it where it fails."""
    done = attempt(folder, *words)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def its_test_passes(name: str, folder: Path) -> None:
    """The page's own test, with the page's file in the configuration."""
    test = with_example(name, folder)
    told = run(folder, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(test))
    assert " passed" in told, told
