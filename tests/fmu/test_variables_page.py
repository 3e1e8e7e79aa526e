"""docs/variables.md says what the FMU's variables are."""

from __future__ import annotations

import re
from pathlib import Path

from wheelchair_fmu.fmu.variables_page import page
from wheelchair_fmu.model.effects import bundled

PAGE = Path(__file__).parents[2] / "docs" / "variables.md"


def test_the_page_is_as_the_records_are():
    assert PAGE.read_text(encoding="utf-8") == page(), "write it again by `make docs`"


def test_it_has_each_variable_once_and_those_of_every_effect_and_law():
    listed = re.findall(r"^\| `(\S+)` \|", page(), re.M)
    assert len(listed) == len(set(listed))
    effects = [e for e in bundled().values() if not e.delays_record]
    assert {p.name for e in effects for p in e.owned} <= set(listed)
    assert {"start.caster_l", "caster.sigma", "wheel.I", "rim.rl", "effect.relaxation_length.lagged_slip.rl"} <= set(listed)
