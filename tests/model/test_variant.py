"""Variants as files: what is written is read, and what cannot be meant is refused with the file's name."""

from __future__ import annotations

import pytest

from wheelchair_fmu.errors import UsageError
from wheelchair_fmu.model.variant import Variant, read_variant, variant_text

EFFECT = "rolling_resistance_asymmetry"


def test_what_is_written_is_read(tmp_path):
    chair = Variant(notes={"origin": {"campaign": "hall"}}).with_values({f"effect.{EFFECT}.D": 1.6, "chair.m": 91.0})
    (tmp_path / "chair.toml").write_text(variant_text(chair), encoding="utf-8")

    assert read_variant(tmp_path / "chair.toml") == chair


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ('[value]\n"chair.m" = 91.0', "no table 'value'; did you mean 'values'?"),
        ("values = 91.0", "values = 91.0 is no table; write [values]"),
        (f'[laws]\neffects = "{EFFECT}"', "is no list of ids; write effects ="),
        ('[laws]\neffects = ["asymmetry"]', f"no effect 'asymmetry'; did you mean '{EFFECT}'?"),
        ('[laws]\ntire = "linear"', "no law in [laws] 'tire'; did you mean 'tyre'?"),
        ('[laws]\ntyre = ["linear"]', "no tyre law"),
        ('[values]\n"chair.mass" = 91.0', "no parameter 'chair.mass'"),
        (
            '[values]\n"start.caster_l" = 0.4',
            "start.caster_l is a parameter of another caster law than 'ideal', which this chair has; choose "
            'caster = "swivelling" or caster = "slipping" in the [laws] of a variant',
        ),
        (
            '[laws]\ncaster = "slipping"\n[values]\n"start.caster_l" = 90',
            "start.caster_l = 90 is outside its bounds -3.2 to 3.2 rad",
        ),
        ('[values]\n"wheel.I" = 0.2', 'choose wheel = "spinning" in the [laws]'),
        ('[values]\n"chair.m" = -1.0', "chair.m = -1.0 is outside its bounds"),
        ('[values]\n"tyre.pressure_F" = 3', "tyre.pressure_F = 3 is outside its bounds -2 to 2; give a value between them"),
    ],
)
def test_a_fault_is_told_with_the_file(tmp_path, text, says):
    file = tmp_path / "chair.toml"
    file.write_text(text, encoding="utf-8")

    with pytest.raises(UsageError) as told:
        read_variant(file)

    assert str(told.value).startswith(f"{file}: ") and says in str(told.value)
