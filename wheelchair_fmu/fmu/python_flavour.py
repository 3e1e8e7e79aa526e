"""The Python flavour: the model's own files inside an FMU, driven by pythonfmu.

pythonfmu writes neither units nor bounds nor right InitialUnknowns, so the description is the native
one. The package inside gets a name of its own for each build: two FMUs whose modules share a name
silently use each other's.
"""

from __future__ import annotations

import hashlib
import json
import sys
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import version
from math import isfinite
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from uuid import UUID

from .. import configuration
from ..configuration import OF_MODELS
from ..errors import BuildError
from ..model.choice import names
from ..resources import FMU_SOURCES
from . import describe, documentation
from .variables import GRID, TOLERANCE, Interface, Variable

NAME = "WheelchairPython"
PACKAGE = Path(__file__).parents[1]
PLACEHOLDER = "wheelchair_package"  # what slave.py calls the package before it has its name
NEEDED = ("casadi", "numpy")  # as slave.py asks for them
PACKAGES = {  # of a user's own files
    "laws/tyre": "tyre",
    "laws/caster": "caster",
    "laws/wheel": "wheel",
    "channels": "readings",
}
NOTHING_OF_THE_HOST_S = '''"""A user's own laws and channels are in this FMU already."""


def places(kind):
    return []
'''
ENGINE = ("__init__.py", "kernel.py", "lu.py", "rodas.py")


def archive(face: Interface) -> dict[str, bytes]:
    """Everything in the archive, by path."""
    face = face.without("derivative", "indicator")  # for Model Exchange, which pythonfmu does not do
    modules = _modules(face)
    token = _token(face, modules)
    package = f"wheelchair_python_{token[1:9]}"
    with TemporaryDirectory() as folder:
        source = Path(folder) / "source"
        script = _write(source, package, modules, _interface(face, token))
        files = _pythonfmu(script, source / package, Path(folder))
    description = describe.description(face, NAME, token, describe.PYTHON, [])
    return {
        **files,
        "modelDescription.xml": description,
        "model.png": (face.pages / "model.png").read_bytes(),
        **documentation.files(face, "2", {}),
        "documentation/externalDependencies.txt": _dependencies().encode(),
    }


def _dependencies() -> str:
    """What a host must have for this FMU to run, with the versions that it was built with."""
    lines = [f"{name} {version(name)}" for name in ("pythonfmu", *NEEDED)]
    return (
        "This FMU runs in the Python of its host. It needs Python 3.11 or newer and these packages, for instance by\n"
        f"pip install {' '.join(NEEDED)}\n\npythonfmu is inside. Built with:\n" + "".join(f"{line}\n" for line in lines)
    )


def _modules(face: Interface) -> dict[str, str]:
    """The model's files by their path in the package, and stepping.py beside them."""
    files = [PACKAGE / f"{name}.py" for name in ("quantities", "errors", "faults", "units", "unit_text")]
    files += [f for f in (PACKAGE / "model").rglob("*.py") if f.name not in ("variant.py", "carried.py")]
    files += [PACKAGE / "engine" / name for name in ENGINE]
    texts = {f.relative_to(PACKAGE).as_posix(): f.read_text(encoding="utf-8") for f in files}
    texts |= {f"model/effects/{e.id}.py": e.program.text for e in face.model.effects if e.program}  # a user's own come along
    texts |= {_place_of(name): file.read_text(encoding="utf-8") for name, file in configuration.files(*OF_MODELS).items()}
    texts |= {f"model/{own.kind}/{own.name}.py": own.text for own in face.variant.choice.own}
    texts["configuration.py"] = NOTHING_OF_THE_HOST_S
    texts["__init__.py"] = '"""The model of the FMU around it."""\n'
    texts["stepping.py"] = (FMU_SOURCES / "python" / "stepping.py").read_text(encoding="utf-8")
    return texts


def _place_of(name: str) -> str:
    """Where a user's own file lies in the package: "model/tyre/brush.py" for "laws/tyre/brush.py"."""
    kind, _, file = name.rpartition("/")
    return f"model/{PACKAGES[kind]}/{file}"


def _token(face: Interface, modules: dict[str, str]) -> str:
    slave = (FMU_SOURCES / "python" / "slave.py").read_text(encoding="utf-8")
    content = "\0".join(
        (json.dumps(_interface(face, ""), sort_keys=True), slave, *(name + "\0" + modules[name] for name in sorted(modules)))
    )
    return "{" + str(UUID(bytes=hashlib.sha256(content.encode()).digest()[:16])) + "}"


def _interface(face: Interface, token: str) -> dict[str, Any]:
    """What the slave has to know, as plain data."""
    choice = face.variant.choice
    return {
        "token": token,
        "choice": {"caster": choice.caster, "wheel": choice.wheel, "equations": choice.equations},
        "laws": names(choice)["tyre"],
        "effects": [e.id for e in face.model.effects],
        "tolerance": TOLERANCE,
        "grid": GRID,
        "log_categories": describe.LOG_CATEGORIES,
        "variables": [_variable(v) for v in face.variables],
        "jumps": [{"parameter": j.parameter.name, "mode": j.mode.name, "when": j.when, "state": j.state} for j in face.jumps],
        "watches": [
            {
                "variables": [v.name for v in w.variables],
                "limits": w.limits,
                "meaning": w.meaning,
                "guard": w.guard.name if w.guard else "",
                "guard_limit": w.guard_limit,
            }
            for w in face.watches
        ],
        "idles": [{"input": i.input.name, "parameter": i.parameter.name} for i in face.idles],
    }


def _variable(v: Variable) -> dict[str, Any]:
    start = int(v.start or 0) if v.choices else v.start
    lower, upper = (b if isfinite(b) else None for b in (v.lower, v.upper))
    return {
        "name": v.name,
        "kind": v.kind,
        "type": v.type,
        "unit": v.unit.name,
        "start": start,
        "min": lower,
        "max": upper,
        "variability": v.variability,
        "choices": v.choices,
    }


def _write(source: Path, package: str, modules: dict[str, str], interface: dict[str, Any]) -> Path:
    """The package and the slave's script, in the folder `source`; returns the script."""
    for name, text in modules.items():
        file = source / package / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    (source / package / "interface.json").write_text(json.dumps(interface, indent=1), encoding="utf-8")
    slave = (FMU_SOURCES / "python" / "slave.py").read_text(encoding="utf-8")
    script = source / f"{package}_slave.py"
    script.write_text(slave.replace(PLACEHOLDER, package), encoding="utf-8")
    return script


def _pythonfmu(script: Path, package: Path, folder: Path) -> dict[str, bytes]:
    """What pythonfmu puts into the archive, by path."""
    try:
        from pythonfmu.builder import FmuBuilder
    except ImportError as error:
        raise BuildError("the python flavour needs pythonfmu; `pip install pythonfmu`") from error
    with _imports_undone(package.name):
        target = FmuBuilder.build_FMU(script, dest=folder, project_files=[package])
    with zipfile.ZipFile(target) as made:
        names = [n for n in made.namelist() if not n.endswith("/") and "__pycache__" not in n]
        return {name: made.read(name) for name in names}


@contextmanager
def _imports_undone(package: str) -> Iterator[None]:
    """pythonfmu imports the script to ask for its variables; afterwards it never happened."""
    path, bytecode = list(sys.path), sys.dont_write_bytecode
    sys.dont_write_bytecode = True
    try:
        yield
    finally:
        sys.path[:], sys.dont_write_bytecode = path, bytecode
        for name in [n for n in sys.modules if n.startswith(package)]:
            del sys.modules[name]
