"""Effects inside a variant's file: what is written is read to the letter, and nothing is run that is not what was written."""

from __future__ import annotations

from pathlib import Path

import pytest
import tomli_w

from wheelchair_fmu.errors import Failure, Note, UsageError
from wheelchair_fmu.model.carried import programs, text
from wheelchair_fmu.model.effects import bundled, defined
from wheelchair_fmu.model.expression import effect_file
from wheelchair_fmu.model.stage import Program
from wheelchair_fmu.model.variant import LAWS, Variant, programs_in, read_variant, variant_text
from wheelchair_fmu.quantities import N

SOURCE = effect_file("my_drag", "a drag", "F_x", N, "-q * tanh(u)", size=0.5, lower=0.0, upper=100.0, source="chosen")
SIZE = {"effect.my_drag.q": 2.0}


def chair_with(source: str) -> Variant:
    return Variant(catalogue={**bundled(), **defined((("my_drag.py", source),))}).with_values(SIZE)


def load(programs):
    return defined(tuple((p.file, p.text) for p in programs.effects.values()))


def test_a_variant_without_own_effects_is_written_as_ever():
    chair = Variant(notes={"origin": {"campaign": "hall"}}).with_values({"effect.scrub_torque.M": 0.2})
    laws = {kind: getattr(chair.choice, kind) for kind in LAWS}
    told = {"laws": {**laws, "effects": ["scrub_torque"]}, "values": dict(chair.values), **chair.notes}
    assert variant_text(chair) == tomli_w.dumps(told)


def test_an_effect_that_is_off_does_not_go_along():
    assert "own" not in variant_text(Variant(catalogue=chair_with(SOURCE).catalogue))


@pytest.mark.parametrize("end", ["", "\n", "'", "x = '''text'''\n", "# a page\f\n", '# λ, \\n and """\n'])
def test_a_program_is_read_as_it_was_written(tmp_path, end):
    source = f"{SOURCE}\n# {end}" if end == "'" else SOURCE.rstrip("\n") + "\n" + end
    file, chair = tmp_path / "better.toml", chair_with(source)
    file.write_text(variant_text(chair), encoding="utf-8")
    assert programs_in(file)["effect my_drag"].text == source
    again = read_variant(file, load=load)
    assert again == chair and again.catalogue["my_drag"].program == Program(f"{file}/my_drag.py", source)
    assert variant_text(again) == variant_text(chair)


def test_a_person_can_read_it_in_the_file():
    assert SOURCE in variant_text(chair_with(SOURCE))


@pytest.mark.parametrize(
    ("table", "says"),
    [
        (1, r"own = 1 is no table; write \[own.my_drag\]"),
        ({"My-Drag": {}}, "is no name for an effect"),
        ({"my_drag": {"source": SOURCE}}, r"\[own.my_drag\] is no effect; it has two texts, sha256 and source"),
        ({"my_drag": {"source": SOURCE, "sha256": 1}}, r"\[own.my_drag\] is no effect"),
        ({"my_drag": {"source": SOURCE, "sha256": "0" * 64}}, "the source of my_drag was changed after it was written"),
        ({"gyro_bias": {"source": SOURCE, "sha256": ""}}, "it carries an effect 'gyro_bias', and the catalogue has one"),
    ],
)
def test_what_was_not_written_so_is_refused(table, says):
    with pytest.raises(UsageError, match=says):
        programs(table, Path("better.toml"))


def test_no_program_is_run_unless_somebody_loads_it(tmp_path):
    (tmp_path / "better.toml").write_text(variant_text(chair_with(SOURCE)), encoding="utf-8")
    with pytest.raises(Failure, match="carries the effect my_drag, and programs are not run here"):
        read_variant(tmp_path / "better.toml")


def test_the_catalogue_goes_before_the_file_and_where_they_differ_this_is_said(tmp_path):
    file, other = tmp_path / "better.toml", chair_with(SOURCE.replace("a drag", "another drag"))
    file.write_text(variant_text(chair_with(SOURCE)), encoding="utf-8")
    with pytest.warns(Note, match="carries another my_drag; the one in my_drag.py is taken"):
        assert read_variant(file, other.catalogue).active()[0].title == "another drag"


def test_effects_without_programs_have_no_tables():
    assert text(bundled().values()) == ""


def test_a_variant_that_was_written_before_says_that_it_needs_the_folder(tmp_path):
    (tmp_path / "old.toml").write_text('[laws]\neffects = ["my_drag"]\n', encoding="utf-8")
    with pytest.raises(UsageError, match="one of your own needs the folder of its file, by --effects"):
        read_variant(tmp_path / "old.toml")
    assert read_variant(tmp_path / "old.toml", chair_with(SOURCE).catalogue).effects == ("my_drag",)
