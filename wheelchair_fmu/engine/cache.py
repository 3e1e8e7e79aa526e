"""Compiled kernels, kept between sessions: derived and compiled once for each choice of laws and effects."""

from __future__ import annotations

import ctypes
import hashlib
import os
from collections.abc import Iterable
from functools import cache
from pathlib import Path

import casadi
import platformdirs

from ..model.stage import Effect
from ..model.wheelchair import Choice, assemble
from . import compiler
from .kernel import kernel
from .source import CSRC, c_source

PACKAGE = Path(__file__).parent.parent


def folder() -> Path:
    """Where compiled kernels are kept: $WHEELCHAIR_CACHE, or the user's cache folder."""
    path = Path(os.environ.get("WHEELCHAIR_CACHE") or platformdirs.user_cache_dir("wheelchair-fmu"))
    path.mkdir(parents=True, exist_ok=True)
    return path


def library(choice: Choice, effects: Iterable[Effect]) -> ctypes.CDLL:
    """The loaded shared library of a model, with `wc_kernel model_kernel` and `advance.h`'s functions."""
    effects = sorted(effects, key=lambda e: e.id)
    key = hashlib.sha256("\n".join((_toolchain(), repr(choice), *map(_effect_key, effects))).encode()).hexdigest()[:24]
    target = folder() / f"{key}{compiler.SUFFIX}"
    if not target.exists():
        source = target.with_name(f"{key}-{os.getpid()}.c")
        try:
            source.write_text(c_source(kernel(assemble(choice, effects)), "model"))
            compiler.compile_shared([source, CSRC / "advance.c"], target, ["-fvisibility=default", f"-I{CSRC}"])
        finally:
            source.unlink(missing_ok=True)
    return ctypes.CDLL(str(target))


@cache
def _toolchain() -> str:
    """What every kernel depends on: this package's equations, the compiler, CasADi."""
    files = sorted([*(PACKAGE / "model").rglob("*.py"), *(PACKAGE / "engine").rglob("*.[pch]*"),
                    PACKAGE / "quantities.py"])  # fmt: skip
    files = [f for f in files if "__pycache__" not in f.parts]
    texts = hashlib.sha256(b"".join(f.read_bytes() for f in files)).hexdigest()
    return f"{texts} {casadi.__version__} {compiler.version()} {compiler.FLAGS}"


def _effect_key(effect: Effect) -> str:
    """An effect by its file's content, so that an edited file is a new effect."""
    code = (effect.contributions[0].law if effect.contributions else effect.rows[0].rate).__code__
    return f"{effect.id} {hashlib.sha256(Path(code.co_filename).read_bytes()).hexdigest()}"
