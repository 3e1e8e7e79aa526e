"""Files beside the code that are no code: in a checkout at its top, in an installed package in its folder `share`."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).parent
_SHARE = _PACKAGE / "share"  # which the wheel has, by pyproject.toml, and a checkout has not
ROOT = _SHARE if _SHARE.is_dir() else _PACKAGE.parent

FMU_SOURCES = ROOT / "fmu_src"
SYSTEMS = ROOT / "ssp"
EXAMPLES = ROOT / "examples"
REFERENCES = ROOT / "references.bib"
