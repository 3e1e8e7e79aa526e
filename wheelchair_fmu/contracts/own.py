"""Effects and laws of a user's own, from files or out of a variant: held to the contracts before anything is done with them."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from functools import cache, partial
from pathlib import Path
from shlex import quote

from ..errors import EffectError, Failure, ModelError
from ..model.carried import Carried
from ..model.choice import Choice, taken_along
from ..model.effects import Sources, bundled, read, sources
from ..model.stage import Effect, Program
from ..model.variant import Variant, programs_in, read_variant, variant_text
from . import breaches
from .of_laws import law_breaches
from .trust import is_trusted, remember


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
    return (catalogue(Path(word)), "default") if names_folder(word) else (bundled(), word)


def names_folder(word: str) -> bool:
    """Is it a folder, or a path to one that may not be there? No effect is called so."""
    return Path(word).is_dir() or len(Path(word).parts) > 1


def variant_in(path: Path, known: Mapping[str, Effect] | None = None, *, trust: bool = False) -> Variant:
    """The variant in a TOML file, of these effects (the bundled ones unless given) and of those that the file carries.

    These are programs. They are run if this user trusts them, or where the caller says so by `trust`.

    Raises Failure for programs that nobody trusts, EffectError for those that define no effect or break a contract, and
    Failure or UsageError for other faults of the file.
    """
    return read_variant(Path(path), known, partial(_loaded, Path(path), trust))


def _loaded(path: Path, trust: bool, found: Carried) -> dict[str, Effect]:
    programs = found.programs()
    if not trust and not all(map(is_trusted, programs.values())):
        raise Failure(
            f"{carries(path, programs)}; read it there, and if you trust it, say so by `wheelchair trust {quote(str(path))}`, "
            "or in Python by Variant.read(..., trust=True)"
        )
    chosen = ((own.kind, Choice(own=found.laws).with_laws({own.kind: own.name})) for own in found.laws)
    if broken := [breach for kind, choice in chosen for breach in law_breaches(kind, choice)]:
        raise EffectError(broken)
    return checked(tuple((program.file, program.text) for program in found.effects.values()))


def carries(path: Path, programs: Mapping[str, Program]) -> str:
    """The sentence that says so, without its full stop."""
    what = "a program that runs" if len(programs) == 1 else "programs that run"
    return f"{path} carries the {' and the '.join(programs)}, {what} with your rights"


def untrusted(path: Path) -> dict[str, Program]:
    """The programs in a variant's file that this user does not trust yet, by what each is. Raises as `read_variant`."""
    return {what: program for what, program in programs_in(path).items() if not is_trusted(program)}


def text_of(variant: Variant) -> str:
    """The variant as TOML. The programs in it have run here, so they are trusted on this machine from now on."""
    with suppress(OSError):  # then the user is asked
        remember(effect.program for effect in variant.active() if effect.program)
        remember(own.program for own in taken_along(variant.choice, variant.values))
    return variant_text(variant)
