"""The fonts that figures carry as files."""

from __future__ import annotations

from io import BytesIO

from fontTools.ttLib import TTFont

from wheelchair_fmu.report.press import FACES, press, subset


def test_a_face_has_the_letters_that_were_asked_for_and_no_others():
    for style in FACES:
        made = subset(style, "aλ−")
        assert made == subset(style, "−λa")  # the same letters, the same bytes
        font = TTFont(BytesIO(made))
        assert set(font.getBestCmap()) == set(map(ord, "aλ−"))
        assert "Bitstream" in font["name"].getDebugName(0)  # its copyright stays with it
        assert len(made) < 12_000


def test_letters_that_the_fonts_lack_are_named_and_licences_stay_with_the_scripts():
    made = press(["chair", "輪椅\n"])
    assert made["lacking"] == "椅輪"
    assert all("Permission is hereby granted, free of charge" in s for s in made["scripts"])


def test_letters_that_join_keep_the_forms_they_take_by_their_neighbours():
    font = TTFont(BytesIO(subset("normal", "مقعد")))
    assert "GSUB" in font and len(font.getGlyphOrder()) > 1 + len("مقعد")
    assert "GSUB" not in TTFont(BytesIO(subset("normal", "chair")))
