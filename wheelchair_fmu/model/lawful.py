"""Laws that exclude each other, and whatever else is found as the files of a folder, one record in each.

A package whose files these are adds a user's own folder to its `__path__`: a file there is read as if it lay beside the others.
"""

from __future__ import annotations

import ast
import linecache
import pkgutil
import re
from collections.abc import Iterable, Iterator, MutableSequence
from contextlib import suppress
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Any

from ..errors import ModelError
from ..faults import raised
from .stage import Alternative

NAME = re.compile(r"[a-z][a-z0-9_]*")
EXAMPLE = 'Alternative("{}", ...)'


def names(folder: MutableSequence[str], first: tuple[str, ...] = (), but: tuple[str, ...] = ()) -> tuple[str, ...]:
    """The files in a package's folders by their names: those that come `first`, then the bundled, then a user's own.

    Raises ModelError for files of a user's own whose name is taken, or is none.
    """
    found = ((module.name, Path(place)) for place in folder[1:] for module in pkgutil.iter_modules([place]))
    own = {name: place / f"{name}.py" for name, place in found if not name.startswith("_")}
    bundled = {module.name for module in pkgutil.iter_modules(folder[:1])}
    if strange := [file for name, file in own.items() if name in bundled or not NAME.fullmatch(name)]:
        raise ModelError("\n".join(f"{file}: {_why_not(file.stem, bundled)}" for file in strange))
    return (*first, *sorted(bundled - {*first, *but}), *own)


def _why_not(name: str, bundled: Iterable[str]) -> str:
    if name in bundled:
        return f"there is a bundled {name!r} already; give the file and its record another name"
    return f"{name!r} is no name here; use small letters, digits and underscores, like my_law"


def records(package: str, names: Iterable[str], called: str, kind: type, example: str) -> dict[str, Any]:
    """The records in a package's files, by the files' names; each is `called` so there.

    Raises ModelError for all files that cannot be read, have no record of this kind, or one with another name.
    """
    found, faults = {}, []
    for name in names:
        try:
            found[name] = _record(f"{package}.{name}", name, called, kind, example)
        except ModelError as error:
            faults.append(str(error))
    if faults:
        raise ModelError("\n".join(faults))
    return found


def _record(module: str, name: str, called: str, kind: type, example: str) -> Any:
    try:
        record = getattr(import_module(module), called, None)
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # a user's own file is a program, and may end in any way
        raise ModelError(_failed(module, error)) from error
    return _checked(record, module, name, called, kind, example)


def _checked(record: Any, place: str, name: str, called: str, kind: type, example: str) -> Any:
    if not isinstance(record, kind) or getattr(record, "name", name) != name:
        raise ModelError(f"{place}: no {example.format(name)} in it; write {called} = {example.format(name)}")
    return record


def _failed(module: str, error: BaseException) -> str:
    """One sentence for whatever a file raised."""
    spec = find_spec(module)
    return _failure(spec.origin or module if spec else module, error)


def _failure(file: str, error: BaseException) -> str:
    place, line, said = raised(file, error)
    at = f"{place}:{line}" if line else place
    return f"{at}: cannot be read: {said}; mend this line, or move the file away"


def laws(package: str, names: Iterable[str]) -> dict[str, Alternative]:
    """The laws by name. Raises ModelError as `records`, and for a user's own file that reads another one beside it."""
    found = records(package, names, "LAW", Alternative, EXAMPLE)
    bundled = Path(import_module(package).__file__ or "").parent
    files = (Path(import_module(f"{package}.{name}").__file__ or "") for name in found)
    for file in files:
        if file.parent != bundled:
            _alone(package, file.read_text(encoding="utf-8"), str(file))
    return found


def _alone(package: str, text: str, file: str) -> None:
    """A variant carries a law as one text, so the law reads nothing of the user's own. Raises ModelError where it does."""
    top = package.partition(".")[0]
    bundled = {module.name for module in pkgutil.iter_modules([str(Path(import_module(package).__file__ or "").parent)])}
    for line, module in _read_beside(ast.parse(text), package):
        name = module.partition(".")[0]
        if name not in bundled:
            raise ModelError(
                f"{file}:{line}: reads {name}.py beside it, which does not go along where {top} takes the law; "
                f"write into {Path(file).name} what it needs of {name}.py"
            )


def _read_beside(program: ast.Module, package: str) -> Iterator[tuple[int, str]]:
    """Line and name of each module of the law's own package that a program imports."""
    for node in ast.walk(program):
        match node:
            case ast.ImportFrom(level=1, module=None, names=names):
                yield from ((node.lineno, each.name) for each in names)
            case ast.ImportFrom(level=1, module=str(module)):
                yield node.lineno, module
            case ast.ImportFrom(level=0, module=str(module)) if module == package:
                yield from ((node.lineno, each.name) for each in node.names)
            case ast.ImportFrom(level=0, module=str(module)) if module.startswith(f"{package}."):
                yield node.lineno, module.removeprefix(f"{package}.")
            case ast.Import(names=names):
                inside = (each.name for each in names if each.name.startswith(f"{package}."))
                yield from ((node.lineno, name.removeprefix(f"{package}.")) for name in inside)


def law_of_text(package: str, name: str, text: str, file: str) -> Alternative:
    """The law that a program's text makes, as if its file lay in this package. Raises ModelError as `records`, with `file`."""
    module = ModuleType(f"{package}.{name}")
    with suppress(SyntaxError):  # which the program says itself when it is run
        _alone(package, text, file)
    module.__dict__.update(__file__=file, __package__=package)
    try:
        exec(compile(text, file, "exec"), module.__dict__)
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        raise ModelError(_failure(file, error)) from error
    linecache.cache[file] = (len(text), None, text.splitlines(keepends=True), file)  # as it ran, for tracebacks
    made: Alternative = _checked(module.__dict__.get("LAW"), file, name, "LAW", Alternative, EXAMPLE)
    return made
