"""The faults that `make mutants` puts into the code by name are faults of the code as it is."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.mutants import NAMED, enough

ROOT = Path(__file__).parent.parent


@pytest.mark.parametrize(("file", "before", "after"), NAMED)
def test_a_named_fault_has_its_place(file, before, after):
    assert (ROOT / file).read_text(encoding="utf-8").count(before) == 1 and before != after


@pytest.mark.parametrize("drawn", [10, 20, 30, 70])
def test_nine_in_ten_are_enough_and_one_fewer_is_not(drawn):
    assert enough(drawn * 9 // 10, drawn) and not enough(drawn * 9 // 10 - 1, drawn)
