"""The native flavour: generated C and fmu_src's own, compiled into one library that speaks both versions of FMI.

In an archive's sources all C files are parts of one, all.c, for whoever builds from them. All functions but FMI's own are
static there, and several source FMUs can be linked into one program.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from uuid import UUID

from ..children import side_by_side
from ..engine import compiler, objects
from ..engine.cache import LEVELS
from ..engine.source import CSRC
from ..errors import BuildError
from ..resources import FMU_SOURCES
from . import data, describe, describe3, documentation, related
from .platforms import Platform, chosen, for_oldest_libc
from .variables import Interface

PROTOCOLS = {"2": "fmi2.c", "3": "fmi3.c"}
CORE = ("advance.c", "values.c", "motion.c", "derivatives.c", "saved.c")
HANDWRITTEN = (*PROTOCOLS.values(), *CORE[1:], "instance.h", "model.h")
TABLES = "model_data.c"
UNIT = "all.c"
BUILD_DESCRIPTION = "buildDescription.xml"
WHOLE = """/* The one file to compile: it includes all others, so that nothing but FMI's own functions is seen outside.
 * Define FMI2_FUNCTION_PREFIX or FMI3_FUNCTION_PREFIX to link several FMUs into one program. */
"""
# Contracting a·b + c to one rounding would give other digits on other machines; each compiler is asked in its own way.
BEGINNING = """#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off")
#elif defined(_MSC_VER)
#pragma fp_contract(off)
#endif
#define WC_LOCAL {linkage}
#define CASADI_SYMBOL_EXPORT static
#if defined(__GNUC__) /* CasADi writes functions that nobody calls, with arguments that nobody reads */
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif
"""
BETWEEN = """#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif
"""


def token_of(face: Interface, texts: dict[str, str]) -> str:
    """A guid that changes with everything that changes results or variables."""
    said = map(repr, (face.variables, face.jumps, face.watches, face.idles))
    content = "\0".join((*said, *sorted(texts), *(texts[name] for name in sorted(texts))))
    return "{" + str(UUID(bytes=hashlib.sha256(content.encode()).digest()[:16])) + "}"


def handwritten() -> dict[str, str]:
    folders = {**dict.fromkeys(HANDWRITTEN, FMU_SOURCES), "advance.c": CSRC, "advance.h": CSRC}
    try:
        return {name: (folder / name).read_text(encoding="utf-8") for name, folder in folders.items()}
    except FileNotFoundError as error:
        raise BuildError(f"{error.filename}: no such file; install wheelchair-fmu again, which brings it") from error


def sources(face: Interface) -> tuple[dict[str, str], str]:
    """All C files by name, and the token in them."""
    texts = {**handwritten(), **data.generate(face)}
    token = token_of(face, texts)
    return {**texts, TABLES: data.tables(face, face.name, token)}, token


def unit(face: Interface, versions: Iterable[str]) -> str:
    """all.c for these versions of FMI."""
    return WHOLE + _included(data.names(face), versions)


def _included(generated: Iterable[str], versions: Iterable[str], before: str = "") -> str:
    """C that includes generated files, then all that is written by hand."""
    equations = "".join(f'#include "{name}"\n#undef CASADI_PREFIX\n' for name in generated)
    others = (TABLES, *CORE, *(PROTOCOLS[version] for version in versions))
    return (
        BEGINNING.format(linkage="static") + before + equations + BETWEEN + "".join(f'#include "{name}"\n' for name in others)
    )


def headers() -> Path:
    """The folder with the FMI headers."""
    import fmpy

    return Path(fmpy.__file__).parent / "c-code"


def compile_library(face: Interface, texts: Mapping[str, str], platform: Platform) -> bytes:
    """The shared library of C files, given by name and text, for both versions of FMI. The equations of each law are an object
    of their own here, which FMUs that differ by start values share; `all.c` of an archive's sources has them in one."""
    cross, kernels = platform.command(), data.kernels(face)
    with TemporaryDirectory() as folder, side_by_side(os.cpu_count()) as pool:
        jobs = [pool.submit(_equations, texts[name], platform) for name in kernels]
        declared = '#include "advance.h"\n' + "".join(f"extern const wc_kernel {Path(name).stem}_kernel;\n" for name in kernels)
        for file, text in texts.items():
            (Path(folder) / file).write_text(text, encoding="utf-8")
        rest = Path(folder) / UNIT
        others = [name for name in data.names(face) if name not in kernels]
        rest.write_text(for_oldest_libc(platform, _included(others, PROTOCOLS, declared)), encoding="utf-8")
        target = Path(folder) / f"{face.name}{platform.suffix}"
        sources = [rest, *(job.result() for job in jobs)]
        compiler.compile_shared(sources, target, [f"-I{folder}", f"-I{headers()}", *platform.link], cross)
        return target.read_bytes()


def _equations(text: str, platform: Platform) -> Path:
    """The object of one law's equations, optimised as little as those of the engine (see `engine.cache.LEVELS`)."""
    whole = BEGINNING.format(linkage="") + text + BETWEEN
    return objects.compiled("equations", for_oldest_libc(platform, whole), (LEVELS["model"],), platform.command())


def archive(face: Interface) -> dict[str, bytes]:
    """Everything in the archive for FMI 2.0 on this system, by path."""
    return archives(face, ("2",), chosen("host"), {})["2"]


def archives(
    face: Interface, versions: Sequence[str], platforms: Sequence[Platform], results: Mapping[str, bytes]
) -> dict[str, dict[str, bytes]]:
    """Everything in the archive of each version of FMI, by path; `results` are what it should give, by file name."""
    texts, token = sources(face)
    libraries = {p: compile_library(face, texts, p) for p in platforms}
    beside = related.files(face.variant, results) if results else {}
    made = {}
    for version in versions:
        others = {file for other, file in PROTOCOLS.items() if other != version}
        mine = {**{name: text for name, text in texts.items() if name not in others}, UNIT: unit(face, [version])}
        made[version] = {
            **_described(version, face, token, results),
            **{f"binaries/{p.folder if version == '2' else p.name}/{face.name}{p.suffix}": b for p, b in libraries.items()},
            **{f"sources/{name}": text.encode() for name, text in mine.items()},
            **beside,
        }
    return made


def _described(version: str, face: Interface, token: str, results: Mapping[str, bytes]) -> dict[str, bytes]:
    pages = documentation.files(face, version, results)
    common = {
        f"sources/{BUILD_DESCRIPTION}": describe3.build_description(face.name, version, UNIT),
        "terminalsAndIcons/terminalsAndIcons.xml": describe3.terminals(face),
        **documentation.icons(face),
        **pages,
    }
    if version == "2":
        abilities = {kind: able for kind, able in describe.NATIVE.items() if face.states or kind == "CoSimulation"}
        description = describe.description(face, face.name, token, abilities, [UNIT])
        return {"modelDescription.xml": description, "model.png": (face.pages / "model.png").read_bytes(), **common}
    return {"modelDescription.xml": describe3.description(face, face.name, token), **common}
