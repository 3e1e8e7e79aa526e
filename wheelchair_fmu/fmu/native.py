"""The native flavour: generated C and fmu_src's own, compiled into one library without further needs."""

from __future__ import annotations

import hashlib
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from uuid import UUID

from ..engine import compiler
from ..engine.source import CSRC
from ..errors import BuildError
from . import data, describe, documentation
from .variables import Interface

HANDWRITTEN = ("fmi2.c", "instance.c", "instance.h", "model.h")
PLATFORMS = {"win32": "win64", "darwin": "darwin64"}  # else linux64
PLATFORM = PLATFORMS.get(sys.platform, "linux64")
# -Bsymbolic: our calls reach our functions, whatever the importer has loaded before.
LINK = () if sys.platform in PLATFORMS else ("-Wl,-Bsymbolic", "-Wl,--no-undefined", "-s")


def token_of(face: Interface, texts: dict[str, str]) -> str:
    """A guid that changes with everything that changes results or variables."""
    content = "\0".join((repr(face.variables), repr(face.jumps), repr(face.watches), *sorted(texts),
                         *(texts[name] for name in sorted(texts))))  # fmt: skip
    return "{" + str(UUID(bytes=hashlib.sha256(content.encode()).digest()[:16])) + "}"


def handwritten() -> dict[str, str]:
    folders = {**dict.fromkeys(HANDWRITTEN, documentation.SOURCE), "advance.c": CSRC, "advance.h": CSRC}
    try:
        return {name: (folder / name).read_text(encoding="utf-8") for name, folder in folders.items()}
    except FileNotFoundError as error:
        raise BuildError(f"{error.filename}: no such file; build from a checkout, which has fmu_src") from error


def sources(face: Interface) -> tuple[dict[str, str], str]:
    """All C files by name, and the token in them."""
    texts = {**handwritten(), **data.generate(face)}
    token = token_of(face, texts)
    return {**texts, "model_data.c": data.tables(face, face.name, token)}, token


def headers() -> Path:
    """The folder with the FMI headers."""
    import fmpy

    return Path(fmpy.__file__).parent / "c-code"


def compile_library(texts: dict[str, str], target: Path) -> Path:
    """Compile C files, given by name and text, into the shared library `target`."""
    with TemporaryDirectory() as folder:
        for name, text in texts.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        units = [Path(folder) / name for name in units_of(texts)]
        return compiler.compile_shared(units, target, ["-DSTATIC_LINKED", f"-I{folder}", f"-I{headers()}", *LINK])


def units_of(texts: dict[str, str]) -> list[str]:
    return sorted(name for name in texts if name.endswith(".c"))


def archive(face: Interface) -> dict[str, bytes]:
    """Everything in the archive, by path."""
    texts, token = sources(face)
    library = f"binaries/{PLATFORM}/{face.name}{compiler.SUFFIX}"
    with TemporaryDirectory() as folder:
        binary = compile_library(texts, Path(folder) / f"{face.name}{compiler.SUFFIX}").read_bytes()
    return {
        "modelDescription.xml": describe.description(face, face.name, token, describe.NATIVE, units_of(texts)),
        library: binary,
        **{f"sources/{name}": text.encode() for name, text in texts.items()},
        **documentation.files(face),
    }
