"""What the page needs for figures as files: two fonts with the letters that the page has, and what writes PDF."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Iterable
from importlib.resources import files
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING
from unicodedata import bidirectional, category

if TYPE_CHECKING:  # fontTools takes a fifth of a second to load
    from fontTools.ttLib import TTFont

VENDOR = files(__package__) / "page" / "vendor"
WRITERS = ("jspdf-4.2.1.umd.min.js", "svg2pdf-2.8.1.umd.min.js")  # github.com/parallax/jsPDF and yWorks/svg2pdf.js, both MIT
FACES = {"normal": "DejaVuSans.ttf", "bold": "DejaVuSans-Bold.ttf"}  # as matplotlib brings them


def press(texts: Iterable[str]) -> dict[str, object]:
    """Fonts {"normal", "bold"} as TrueType in base64 with the letters of `texts`, the letters that the fonts do not have, and
    the scripts that write PDF, with their licences."""
    letters = sorted(set().union(*texts))
    there = set(_face("normal").getBestCmap())
    scripts = [_vendored(name) for name in WRITERS]
    return {
        "fonts": {style: b64encode(subset(style, letters)).decode() for style in FACES},
        "lacking": "".join(c for c in letters if c.isprintable() and ord(c) not in there),
        "scripts": scripts,
    }


def subset(style: str, letters: Iterable[str]) -> bytes:
    """A face of DejaVu Sans with these letters alone, as TrueType; the same letters give the same bytes."""
    from fontTools.subset import Options, Subsetter

    options = Options()
    options.hinting = False
    options.name_IDs = [0, 1, 2, 4, 6, 13, 14]  # names, copyright and licence
    options.drop_tables += ["FFTM"]
    letters = list(letters)
    if not any(map(_joins, letters)):
        options.layout_features = []
        options.drop_tables += ["GDEF", "GPOS", "GSUB"]
    face, made = _face(style), BytesIO()
    chosen = Subsetter(options)
    chosen.populate(text="".join(letters))
    chosen.subset(face)
    face.save(made)
    return made.getvalue()


def _joins(letter: str) -> bool:
    """Does a letter take a form by its neighbours, which tables of the font tell, or stand on one of them?"""
    return bidirectional(letter) in ("R", "AL") or category(letter).startswith("M")


def _face(style: str) -> TTFont:
    import matplotlib  # here, not above: see `canvas`
    from fontTools.ttLib import TTFont

    return TTFont(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / FACES[style], recalcTimestamp=False)


def _vendored(name: str) -> str:
    licence = VENDOR.joinpath(f"{name.partition('-')[0]}-LICENSE.txt").read_text(encoding="utf-8")
    return f"/*\n{licence}*/\n{VENDOR.joinpath(name).read_text(encoding='utf-8')}"
