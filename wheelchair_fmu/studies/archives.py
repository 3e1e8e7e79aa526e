"""The FMU of a variant, built once and kept beside the compiled kernels."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import replace
from functools import cache
from pathlib import Path

import casadi

from .. import __version__, configuration
from ..engine import compiler
from ..engine.cache import effect_key
from ..engine.store import kept
from ..fmu.build import build, with_chosen_effects
from ..model.variant import Variant
from ..resources import FMU_SOURCES

PACKAGE = Path(__file__).parent.parent
MAKERS = (
    *(PACKAGE / name for name in ("quantities.py", "model", "engine", "fmu")),
    FMU_SOURCES,
)  # what an archive's content comes from


def fmu_of(variant: Variant, effects: str | Iterable[str] = "default", *, with_starts: bool = False) -> Path:
    """The FMU of a variant's laws and effects, and of `effects` as `build_fmu.py` knows them.

    Its start values are the defaults: a variant's values are set when it runs, so one file serves them all. With
    `with_starts` they are the variant's values, for importers that set none.

    Raises UsageError for an unknown effect and BuildError where it cannot be built.
    """
    values = dict(sorted(variant.values.items())) if with_starts else {}
    bare = replace(with_chosen_effects(variant, effects), values=values, notes={})
    words = (_makers(), repr(bare.choice), *([repr(values)] if values else ()), *(effect_key(e) for e in bare.active()))
    key = hashlib.sha256("\n".join(words).encode()).hexdigest()[:24]
    return kept(f"Wheelchair-{key}", ".fmu", lambda path: build(bare, path, effects="none"))


@cache
def _makers() -> str:
    """A digest of every file, and the versions, that an archive depends on."""
    files = (f for place in MAKERS for f in _files(place))
    digest = hashlib.sha256(b"\0".join(f.read_bytes() for f in files)).hexdigest()
    own = configuration.digest(*configuration.OF_MODELS)
    return f"{__version__} {digest} {casadi.CasadiMeta.version()} {compiler.version()} {compiler.FLAGS} {own}"


def _files(path: Path) -> list[Path]:
    if path.is_file():
        return [path]
    return sorted(f for f in path.rglob("*") if f.is_file() and "__pycache__" not in f.parts)
