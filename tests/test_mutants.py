"""The faults that `make mutants` puts into the code by name are faults of the code as it is."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.mutants import NAMED

ROOT = Path(__file__).parent.parent


@pytest.mark.parametrize(("file", "before", "after"), NAMED)
def test_a_named_fault_has_its_place(file, before, after):
    assert (ROOT / file).read_text(encoding="utf-8").count(before) == 1 and before != after
