"""The same generated C as WebAssembly, for the report's page: no imports, one memory, compiled by PyPI's ziglang."""

from __future__ import annotations

import hashlib
import tempfile
from collections.abc import Iterable, Sequence
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

from ..errors import BuildError
from ..model.stage import Effect
from ..model.wheelchair import Choice, assemble
from . import cache, compiler
from .kernel import kernel
from .source import CSRC, c_source, coefficients, tangent_source
from .tangent import tangent

STACK = 1 << 20  # bytes; the filter's matrices take the most
FLAGS = ("-target", "wasm32-wasi", "-mexec-model=reactor", "-std=c11", "-O3", "-msimd128", "-g0", "-s", "-ffp-contract=off",
         "-fno-sanitize=all", "-fvisibility=hidden", f"-Wl,-z,stack-size={STACK}")  # fmt: skip


def module(choice: Choice, effects: Iterable[Effect], columns: Sequence[str]) -> bytes:
    """A model as a WebAssembly module that exports `csrc/page.c`, with derivatives by the parameters `columns`.

    Raises BuildError where ziglang is not installed.
    """
    effects = sorted(effects, key=lambda e: e.id)
    words = "\n".join((cache.sources(), str(FLAGS), repr(choice), repr(list(columns)), *map(cache.effect_key, effects)))
    if not find_spec("ziglang"):
        raise BuildError("the model is compiled to WebAssembly by ziglang, which is not installed; "
                         "pip install 'wheelchair-fmu[report]'")  # fmt: skip
    key = hashlib.sha256(f"{words} {version('ziglang')}".encode()).hexdigest()[:24]
    target = cache.folder() / f"{key}.wasm"
    if not target.exists():
        with tempfile.TemporaryDirectory(dir=cache.folder()) as place:
            _compile(choice, effects, columns, Path(place), target)
    return target.read_bytes()


def _compile(choice: Choice, effects: list[Effect], columns: Sequence[str], place: Path, target: Path) -> None:
    model = assemble(choice, effects)
    sources = {"model.c": c_source(kernel(model), "model"),
               "tangent_model.c": tangent_source(tangent(model, columns), "tangent"),
               "coefficients.h": coefficients()}  # fmt: skip
    for name, text in sources.items():
        (place / name).write_text(text)
    files = [place / "model.c", place / "tangent_model.c", CSRC / "tangent.c", CSRC / "page.c"]
    compiler.compile_wasm(files, target, [*FLAGS, f"-I{CSRC}", "-include", str(place / "coefficients.h")])
