"""Pages whose example is two files for a checkout: these go into a copy of the package, and the page's test is run there."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
BLOCK = re.compile(r"(At\s+the\s+end\s+of\s+)?`([\w/]+\.py)`:\n\n```python\n(.*?)```", re.DOTALL)


def page(name: str) -> str:
    return (ROOT / "docs" / name).read_text(encoding="utf-8")


def with_example(name: str, folder: Path, *, first: str = "") -> Path:
    """A copy of the package with the page's files in it; returns the page's test. `first` is put before what is added."""
    shutil.copytree(ROOT / "wheelchair_fmu", folder / "wheelchair_fmu", ignore=shutil.ignore_patterns("__pycache__"))
    for data in ("fmu_src", "ssp", "examples", "references.bib"):
        (folder / data).symlink_to(ROOT / data)
    tests = []
    for at_the_end, path, text in BLOCK.findall(page(name)):
        file = folder / path
        assert file.exists() == bool(at_the_end), path
        file.parent.mkdir(parents=True, exist_ok=True)
        before = f"{file.read_text(encoding='utf-8')}\n\n{first}" if at_the_end else ""
        file.write_text(f"{before}{text}", encoding="utf-8")
        tests += [file] * path.startswith("tests/")
    (test,) = tests
    return test


def run(folder: Path, *words: str) -> str:
    """What Python prints in the copy; raises AssertionError with it where it fails."""
    done = subprocess.run(
        [sys.executable, *words], cwd=folder, env={**os.environ, "PYTHONPATH": str(folder)}, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def its_test_passes(name: str, folder: Path, *, first: str = "") -> None:
    """The page's own test, in a copy of the package that has the page's file."""
    test = with_example(name, folder, first=first)
    place = "import wheelchair_fmu; print(wheelchair_fmu.__file__)"
    assert Path(run(folder, "-c", place).strip()).is_relative_to(folder)
    told = run(folder, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(test))
    assert " passed" in told, told
