"""The catalogue: one physical effect per file, discovered. Each file has one record `EFFECT`."""

from __future__ import annotations

import linecache
import pkgutil
from functools import cache
from importlib import import_module
from importlib.util import decode_source
from pathlib import Path
from types import ModuleType

from ...errors import ModelError
from ..stage import Effect

Sources = tuple[tuple[str, bytes], ...]  # files by path, with their content


@cache
def bundled() -> dict[str, Effect]:
    """The effects that come with the package, by id, in alphabetical order."""
    names = sorted(module.name for module in pkgutil.iter_modules(__path__))
    return {name: import_module(f".{name}", __name__).EFFECT for name in names}


def load(folder: Path) -> dict[str, Effect]:
    """The effects in a user's folder, by id. Raises ModelError as `sources` and `defined` do."""
    return defined(sources(folder))


def sources(folder: Path) -> Sources:
    """The effect files in a user's folder, to be read here or in a process that does not see the folder.

    Raises ModelError for a folder that is not there, or a file that cannot be opened.
    """
    if not Path(folder).is_dir():
        raise ModelError(f"{folder}: no such folder; `wheelchair effects new ID` starts one")
    files = sorted(file for file in Path(folder).glob("*.py") if not file.name.startswith("_"))
    try:
        return tuple((str(file), file.read_bytes()) for file in files)
    except OSError as error:
        raise ModelError(f"{error.filename}: cannot be read as an effect: {error.strerror}") from error


def defined(files: Sources) -> dict[str, Effect]:
    """The effects that these files define, by id.

    Raises ModelError for a file that is no Python, has no record `EFFECT`, or one whose id is not the file's name.
    """
    found = {}
    for file, content in files:
        stem = Path(file).stem
        effect = _run(file, content).__dict__.get("EFFECT")
        if not isinstance(effect, Effect):
            raise ModelError(f"{file}: no record EFFECT; write EFFECT = Effect('{stem}', ...)")
        if effect.id != stem:
            raise ModelError(f"{file}: its effect is called {effect.id!r}; call it {stem!r} like its file")
        found[effect.id] = effect
    return found


def _run(file: str, content: bytes) -> ModuleType:
    """The module that a file makes, a sibling of the bundled effects."""
    module = ModuleType(f"{__name__}.{Path(file).stem}")
    module.__dict__.update(__file__=file, __package__=__name__)
    try:
        exec(compile(content, file, "exec"), module.__dict__)
        lines = decode_source(content).splitlines(keepends=True)
    except Exception as error:
        raise ModelError(f"{file}: cannot be read as an effect: {type(error).__name__}: {error}") from error
    linecache.cache[file] = (len(content), None, lines, file)  # the text as it ran, for tracebacks and the kernels' cache
    return module


def catalogue_of(word: str) -> tuple[dict[str, Effect], str]:
    """What `--effects WORD` means: a folder joins its effects to the catalogue, anything else chooses from it."""
    if Path(word).is_dir():
        return {**bundled(), **load(Path(word))}, "default"
    return bundled(), word
