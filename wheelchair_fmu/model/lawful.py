"""Laws that exclude each other, found as the files of a folder."""

from __future__ import annotations

import pkgutil
from collections.abc import Iterable
from importlib import import_module

from ..errors import ModelError
from .stage import Alternative


def names(folder: Iterable[str], first: tuple[str, ...], but: tuple[str, ...] = ()) -> tuple[str, ...]:
    """The laws in a package's folder by the names of their files: those that come `first`, then all others but these."""
    others = sorted({module.name for module in pkgutil.iter_modules(folder)} - {*first, *but})
    return (*first, *others)


def laws(package: str, names: Iterable[str]) -> dict[str, Alternative]:
    """The records of laws by name. Raises ModelError for a file without one, or one with another name."""
    return {name: _law(f"{package}.{name}", name) for name in names}


def _law(module: str, name: str) -> Alternative:
    law = getattr(import_module(module), "LAW", None)
    if not isinstance(law, Alternative) or law.name != name:
        raise ModelError(f'{module}: no law {name!r} in it; write LAW = Alternative("{name}", ...)')
    return law
