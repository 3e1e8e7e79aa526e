"""The catalogue: one physical effect per file, discovered. Each file has one record `EFFECT`."""

from __future__ import annotations

import linecache
import pkgutil
import re
from collections.abc import Container
from dataclasses import replace
from functools import cache
from importlib import import_module
from importlib.util import decode_source
from pathlib import Path
from types import ModuleType

from ...errors import EffectError, ModelError
from ...faults import Fault, raised
from ..stage import Effect, Program

Sources = tuple[tuple[str, bytes | str], ...]  # files by path, with their content, or their text where it was read before
NAME = re.compile(r"[a-z][a-z0-9_]*")  # of an effect


@cache
def bundled() -> dict[str, Effect]:
    """The effects that come with the package, by id, in alphabetical order."""
    names = sorted(module.name for module in pkgutil.iter_modules(__path__))
    return {name: import_module(f".{name}", __name__).EFFECT for name in names}


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
    """The effects that these files define, by id. Raises EffectError with the faults of all files."""
    found, faults = read(files)
    if faults:
        raise EffectError(faults)
    return found


def read(files: Sources) -> tuple[dict[str, Effect], list[Fault]]:
    """The effects that these files define, by id, and one fault for each file that defines none."""
    found: dict[str, Effect] = {}
    faults = []
    for file, content in files:
        effect = _effect(file, content)
        fault = effect if isinstance(effect, Fault) else _misnamed(file, effect.id, found)
        if fault:
            faults.append(fault)
        else:
            assert isinstance(effect, Effect)
            found[effect.id] = effect
    return found, faults


def _misnamed(file: str, id: object, others: Container[str]) -> Fault | None:
    stem = Path(file).stem
    if id == stem in bundled():
        return Fault(file, None, None, f"there is a bundled effect {id!r} already", "give the file and its effect another name")
    if id == stem and not NAME.fullmatch(stem):
        return Fault(
            file, None, None, f"{stem!r} is no name for an effect", "use small letters, digits and underscores, like my_drag"
        )
    if id == stem:
        return None
    taken = f", which is that of {id}.py" if isinstance(id, str) and id in others else ""
    return Fault(file, None, None, f"its effect is called {id!r}{taken}", f"call it {stem!r} like its file")


def _effect(file: str, content: bytes | str) -> Effect | Fault:
    """What a file makes, a sibling of the bundled effects. It is a program, and may end in any way."""
    stem = Path(file).stem
    module = ModuleType(f"{__name__}.{stem}")
    module.__dict__.update(__file__=file, __package__=__name__)
    try:
        exec(compile(content, file, "exec"), module.__dict__)
        text = content if isinstance(content, str) else decode_source(content)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # SystemExit too, which would end the command without a word
        return _failed(file, error)
    linecache.cache[file] = (len(text), None, text.splitlines(keepends=True), file)  # as it ran, for tracebacks
    effect = module.__dict__.get("EFFECT")
    if effect is None:
        return Fault(file, None, None, "there is no record EFFECT in it", f'write EFFECT = Effect("{stem}", ...)')
    if not isinstance(effect, Effect):
        return Fault(file, None, None, f"EFFECT is of type {type(effect).__name__}", f'write EFFECT = Effect("{stem}", ...)')
    return replace(effect, program=Program(file, text))


def _failed(file: str, error: BaseException) -> Fault:
    """One sentence for whatever a file raised."""
    place, line, said = raised(file, error)
    if isinstance(error, SystemExit):
        return Fault(place, line, None, "it ends the program instead of defining an effect", "leave out exit() and sys.exit()")
    return Fault(place, line, None, f"cannot be read as an effect: {said}", "mend this line, or move the file away")
