"""The native flavour: generated C and fmu_src's own, compiled into one library that speaks both versions of FMI."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from uuid import UUID

from ..engine.source import CSRC
from ..errors import BuildError
from . import data, describe, describe3, documentation
from .platforms import Platform, chosen, compile_for
from .variables import Interface

PROTOCOLS = {"2": "fmi2.c", "3": "fmi3.c"}
HANDWRITTEN = (*PROTOCOLS.values(), "values.c", "motion.c", "derivatives.c", "saved.c", "instance.h", "model.h")
OPTIONS = ("-ffp-contract=off",)  # what the results depend on; more are our own choice


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


def compile_library(name: str, texts: dict[str, str], platform: Platform) -> bytes:
    """The shared library `name` of C files, given by name and text."""
    with TemporaryDirectory() as folder:
        for file, text in texts.items():
            (Path(folder) / file).write_text(text, encoding="utf-8")
        units = [Path(folder) / unit for unit in units_of(texts)]
        target = Path(folder) / f"{name}{platform.suffix}"
        compile_for(platform, units, target, ["-DSTATIC_LINKED", f"-I{folder}", f"-I{headers()}"])
        return target.read_bytes()


def units_of(texts: Iterable[str]) -> list[str]:
    return sorted(name for name in texts if name.endswith(".c"))


def archive(face: Interface) -> dict[str, bytes]:
    """Everything in the archive for FMI 2.0 on this system, by path."""
    return archives(face, ("2",), chosen("host"), {})["2"]


def archives(
    face: Interface, versions: Sequence[str], platforms: Sequence[Platform], results: Mapping[str, bytes]
) -> dict[str, dict[str, bytes]]:
    """Everything in the archive of each version of FMI, by path; `results` are what it should give, by file name."""
    texts, token = sources(face)
    libraries = {p: compile_library(face.name, texts, p) for p in platforms}
    beside = {f"documentation/{name}": text for name, text in results.items()}
    made = {}
    for version in versions:
        others = {file for other, file in PROTOCOLS.items() if other != version}
        mine = {name: text for name, text in texts.items() if name not in others}
        made[version] = {
            **_described(version, face, token, units_of(mine)),
            **{f"binaries/{p.folder if version == '2' else p.name}/{face.name}{p.suffix}": b for p, b in libraries.items()},
            **{f"sources/{name}": text.encode() for name, text in mine.items()},
            **beside,
        }
    return made


def _described(version: str, face: Interface, token: str, units: list[str]) -> dict[str, bytes]:
    pages = documentation.files(face)
    if version == "2":
        abilities = {kind: able for kind, able in describe.NATIVE.items() if face.states or kind == "CoSimulation"}
        description = describe.description(face, face.name, token, abilities, units)
        return {"modelDescription.xml": description, "model.png": (face.pages / "model.png").read_bytes(), **pages}
    return {
        "modelDescription.xml": describe3.description(face, face.name, token),
        "sources/buildDescription.xml": describe3.build_description(face.name, units, " ".join(OPTIONS)),
        "terminalsAndIcons/terminalsAndIcons.xml": describe3.terminals(face),
        "terminalsAndIcons/icon.png": (face.pages / "model.png").read_bytes(),
        **{f"terminalsAndIcons/{name}.png": documentation.icon(name) for name in ("pushrim", "floor")},
        **pages,
    }
