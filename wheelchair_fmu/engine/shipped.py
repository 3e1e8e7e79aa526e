"""Compiled models that come with an installed package: nobody waits for a compiler, or needs one, before a first diagnosis.

`make release` puts them into the folder `kernels` beside this file, by system; a checkout has none.
"""

from __future__ import annotations

import ctypes
import logging
from collections.abc import Callable
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from . import compiler, store

FOLDER = Path(__file__).parent / "kernels"
log = logging.getLogger(__name__)


def library(key: str) -> ctypes.CDLL | None:
    """The loaded library of this key for this system; None where there is none, or none that runs here."""
    path = store.found(key, compiler.SUFFIX, FOLDER / compiler.SYSTEM)
    if path is None:
        return None
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:  # as with another C library than the one that it was made for
        _said(f"what came with the package does not load here ({error}); it is compiled")
        return None


def put(key: str, system: str, suffix: str, make: Callable[[Path], object]) -> Path:
    """Let `make(path)` make the library of this key for a system, and keep it where installed packages look."""
    place = FOLDER / system
    place.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(dir=FOLDER) as work:
        beside = Path(work) / f"{key}{suffix}"
        make(beside)
        return beside.replace(place / store.named(key, beside, suffix))


@cache
def _said(words: str) -> None:
    log.info(words)
