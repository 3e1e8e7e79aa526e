"""The catalogue: one physical effect per file, discovered. Each file has one record `EFFECT`."""

from __future__ import annotations

import importlib.util
import pkgutil
from functools import cache
from importlib import import_module
from pathlib import Path

from ...errors import ModelError
from ..stage import Effect


@cache
def bundled() -> dict[str, Effect]:
    """The effects that come with the package, by id, in alphabetical order."""
    names = sorted(module.name for module in pkgutil.iter_modules(__path__))
    return {name: import_module(f".{name}", __name__).EFFECT for name in names}


def load(folder: Path) -> dict[str, Effect]:
    """The effects in a user's folder, by id.

    Raises ModelError for a folder that is not there, a file without a record `EFFECT`, or one whose id is not its
    file's name.
    """
    if not Path(folder).is_dir():
        raise ModelError(f"{folder}: no such folder; `wheelchair effects new ID` starts one")
    found = {}
    for file in sorted(Path(folder).glob("*.py")):
        if file.name.startswith("_"):
            continue
        spec = importlib.util.spec_from_file_location(f"{__name__}.{file.stem}", file)
        assert spec and spec.loader
        module = importlib.util.module_from_spec(spec)
        try:
            spec.loader.exec_module(module)
        except Exception as error:
            raise ModelError(f"{file}: cannot be read as an effect: {type(error).__name__}: {error}") from error
        effect = getattr(module, "EFFECT", None)
        if not isinstance(effect, Effect):
            raise ModelError(f"{file}: no record EFFECT; write EFFECT = Effect('{file.stem}', ...)")
        if effect.id != file.stem:
            raise ModelError(f"{file}: its effect is called {effect.id!r}; call it {file.stem!r} like its file")
        found[effect.id] = effect
    return found


def catalogue_of(word: str) -> tuple[dict[str, Effect], str]:
    """What `--effects WORD` means: a folder joins its effects to the catalogue, anything else chooses from it."""
    if Path(word).is_dir():
        return {**bundled(), **load(Path(word))}, "default"
    return bundled(), word
