"""docs/effects.md says what the effects' files say, and docs/physics.md names only what is there."""

from __future__ import annotations

import re
from pathlib import Path

from wheelchair_fmu.model.catalogue_page import DRAWINGS, drawings, page
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.wheelchair import Choice, assemble

DOCS = Path(__file__).parents[2] / "docs"


def test_the_page_is_as_the_records_are():
    assert (DOCS / "effects.md").read_text(encoding="utf-8") == page(), "write it again by `make docs`"


def test_the_drawings_are_as_the_records_are():
    there = {file.name: file.read_text(encoding="utf-8") for file in (DOCS / DRAWINGS).iterdir()}
    assert there == drawings(), "write them again by `make docs`"


def test_the_models_page_names_inputs_parameters_and_effects_that_there_are():
    text = (DOCS / "physics.md").read_text(encoding="utf-8")
    model = assemble()
    others = (p for law in ({"caster": "slipping"}, {"wheel": "spinning"}) for p in assemble(Choice(**law)).parameters)
    known = {q.name for q in (*model.inputs, *model.parameters, *model.outputs, *others)} | set(bundled())
    named = set(re.findall(r"`([a-z]+(?:[._][a-zA-Z_]+)+)(?: = \w+)?`", text)) - {"wheelchair_fmu", "magic_formula"}
    assert len(named) > 12 and named <= known, named - known
    assert {i.name for i in model.inputs} <= set(re.findall(r"`([\w.]+)`", text))


def test_the_drawing_of_the_stages_has_every_effect_once():
    drawn = re.findall(r'font-family="monospace"[^>]*>(\w+)<', (DOCS / "physics" / "stages.svg").read_text(encoding="utf-8"))
    assert sorted(drawn) == sorted(bundled())
