"""The benchmarks are too slow to run here; that they still fit the package is not."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent.parent / "benchmarks"
NAMES = sorted(
    ".".join(file.relative_to(FOLDER.parent).with_suffix("").parts)
    for file in FOLDER.rglob("*.py")
    if file.parent.name != "importers" and file.stem != "__init__"
)


@pytest.mark.parametrize("name", NAMES)
def test_a_benchmark_finds_all_it_imports(name):
    assert import_module(name).__doc__
