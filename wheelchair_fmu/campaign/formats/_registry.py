"""Which formats there are: the package's, those of installed packages, and the user's own."""

from __future__ import annotations

import pkgutil
from functools import cache
from importlib import import_module, metadata
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

from ...configuration import FORMATS, folder
from ...faults import WARNING, Fault
from ._record import Format, Option

GROUP = "wheelchair_fmu.formats"


@cache
def bundled() -> dict[str, Format]:
    """The formats that come with the package, by id, in alphabetical order."""
    package = import_module(__name__.rpartition(".")[0])
    names = sorted(module.name for module in pkgutil.iter_modules(package.__path__) if not module.name.startswith("_"))
    found = [import_module(f"{package.__name__}.{name}").FORMAT for name in names]
    return {record.id: record for record in found}


def user_folder() -> Path:
    """Where a user's own formats lie, one file each."""
    return folder(FORMATS)


@cache
def formats() -> tuple[dict[str, Format], tuple[Fault, ...]]:
    """All formats by id, and a sentence for each of the user's that cannot be used."""
    found, faults = dict(bundled()), []
    for place, load in (*_entry_points(), *_files()):
        try:
            record = load()
        except Exception as error:  # it is the user's code: it may raise anything
            what = f"{type(error).__name__}: {' '.join(str(error).split())}"
            faults.append(Fault(place, None, None, f"cannot be read as a format: {what}", "correct or remove it", WARNING))
            continue
        if not isinstance(record, Format):
            faults.append(Fault(place, None, None, "there is no record FORMAT", "write FORMAT = Format(...)", WARNING))
        elif record.id in found:
            fact = f"there is already a format {record.id!r}"
            faults.append(Fault(place, None, None, fact, "give it another id", WARNING))
        else:
            found[record.id] = record
    return found, tuple(faults)


def _entry_points() -> list:
    return [(f"{GROUP} {point.name}", point.load) for point in sorted(metadata.entry_points(group=GROUP), key=lambda p: p.name)]


def _files() -> list:
    files = sorted(user_folder().glob("*.py")) if user_folder().is_dir() else []
    return [(str(file), lambda file=file: _run(file)) for file in files if not file.name.startswith("_")]


def _run(file: Path) -> object:
    spec = spec_from_file_location(f"{GROUP}.own.{file.stem}", file)
    if spec is None or spec.loader is None:
        raise ImportError("it is no Python file")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return getattr(module, "FORMAT", None)


def known_options() -> dict[str, Option]:
    """The options of all formats by key."""
    return {option.key: option for record in formats()[0].values() for option in record.options}
