"""Effects of a user's own: read from a folder, and held to the contracts before anything is done with them."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from ..errors import EffectError, ModelError
from ..model.effects import Sources, bundled, read, sources
from ..model.stage import Effect
from . import breaches


def load(folder: Path) -> dict[str, Effect]:
    """The effects in a user's folder, by id.

    Raises ModelError for a folder that is not there, and EffectError with every file that defines no effect and every
    contract that one breaks.
    """
    return checked(sources(folder))


def checked(files: Sources) -> dict[str, Effect]:
    """The effects that these files define. Raises EffectError as `load` does."""
    return dict(_checked(files))


@cache
def _checked(files: Sources) -> dict[str, Effect]:
    """Once for each content: a contract takes a few hundredths of a second."""
    found, faults = read(files)
    broken = [breach for effect in found.values() for breach in breaches(effect)]
    if faults or broken:
        raise EffectError((*faults, *broken))
    return found


def catalogue(folder: Path | None) -> dict[str, Effect]:
    """The effects that are bundled, and those of a user's own folder. Raises ModelError where there are none in that."""
    own = load(folder) if folder else {}
    if folder and not own:
        raise ModelError(f"{folder}: no effect file in it; `wheelchair effects new ID -o {folder}` starts one")
    return {**bundled(), **own}


def catalogue_of(word: str) -> tuple[dict[str, Effect], str]:
    """What `--effects WORD` means: a folder joins its effects to the catalogue, anything else chooses from it."""
    if Path(word).is_dir():
        return catalogue(Path(word)), "default"
    return bundled(), word
