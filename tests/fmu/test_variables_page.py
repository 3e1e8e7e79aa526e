"""docs/variables.md says what the FMU's variables are."""

from __future__ import annotations

from pathlib import Path

from wheelchair_fmu.fmu.variables_page import page

PAGE = Path(__file__).parents[2] / "docs" / "variables.md"


def test_the_page_is_as_the_records_are():
    assert PAGE.read_text(encoding="utf-8") == page(), "write it again by `make docs`"
