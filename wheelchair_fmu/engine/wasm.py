"""The same generated C as WebAssembly, for the report's page: no imports, one memory, compiled by PyPI's ziglang."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence
from functools import partial
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from threading import Lock

from ..children import side_by_side
from ..errors import BuildError
from ..model.stage import Effect
from ..model.wheelchair import Choice, assemble
from . import cache, compiler
from .kernel import at_rest, kernel, seldom_among
from .source import CSRC, NOTHING, c_source, coefficients, tangent_source
from .store import kept
from .tangent import tangent

PUSHES = 2  # the hands' forces: a campaign states no noise of torques
STACK = 1 << 20  # bytes; the filter's matrices take the most
FLAGS = (
    "-target",
    "wasm32-wasi",
    "-mexec-model=reactor",
    "-std=c11",
    "-O3",
    "-fno-unroll-loops",
    "-msimd128",
    "-g0",
    "-s",
    "-ffp-contract=off",
    "-fno-sanitize=all",
    "-fvisibility=hidden",
    f"-Wl,-z,stack-size={STACK}",
    f"-DWC_PUSHES={PUSHES}",
)

# What is small wins: the step in loops over its stages instead of written out, second derivatives by difference.
KERNEL = {"step": "wc_page_step", "forward": NOTHING, "rate": NOTHING}
TANGENT = dict.fromkeys(("prepare", "bend", "slopes_all", "prepare_all", "bend_all", "begin"), NOTHING)

_deriving = Lock()  # CasADi's objects are not for several threads


def modules(
    models: Iterable[tuple[Choice, Iterable[Effect]]], columns: Sequence[str], moving: Iterable[str] = ()
) -> list[bytes]:
    """Models as WebAssembly modules that export `csrc/page.c`, with derivatives by the parameters `columns`, on a level floor
    with open brakes but for inputs that are `moving`.

    What is not cached is compiled side by side. The first of all on a machine waits for ziglang to build its C library.

    Raises BuildError where ziglang is not installed.
    """
    if not find_spec("ziglang"):
        raise BuildError(
            "the model is compiled to WebAssembly by ziglang, which is not installed; pip install 'wheelchair-fmu[report]'"
        )
    moved = seldom_among(moving)
    with side_by_side() as pool:
        waiting = []
        for choice, some in models:
            effects = sorted(some, key=lambda e: e.id)
            make = partial(_compile, choice, effects, columns, moved)
            waiting.append(pool.submit(kept, _name(choice, effects, columns, moved), ".wasm", make))
        return [w.result().read_bytes() for w in waiting]


def _name(choice: Choice, effects: list[Effect], columns: Sequence[str], moving: list[str]) -> str:
    words = "\n".join(
        (cache.sources(), str(FLAGS), repr(choice), repr(list(columns)), repr(moving), *map(cache.effect_key, effects))
    )
    return hashlib.sha256(f"{words} {version('ziglang')}".encode()).hexdigest()[:24]


def _compile(choice: Choice, effects: list[Effect], columns: Sequence[str], moving: list[str], target: Path) -> None:
    files = _written(choice, effects, columns, moving, target.parent)
    by_hand = [CSRC / name for name in ("tangent.c", "rodas.c", "page.c")]
    flags = [*FLAGS, f"-I{CSRC}", "-include", str(target.with_name("coefficients.h"))]
    compiler.compile_wasm([*files, *by_hand], target, flags)


def _written(choice: Choice, effects: list[Effect], columns: Sequence[str], moving: list[str], place: Path) -> list[Path]:
    """The model's C files, and what they need beside them."""
    with _deriving:
        model = at_rest(assemble(choice, effects), moving)
        sources = {
            "model.c": c_source(kernel(model), "model", KERNEL),
            "tangent_model.c": tangent_source(tangent(model, columns, PUSHES), "tangent", TANGENT),
        }
    for name, text in {**sources, "coefficients.h": coefficients()}.items():
        (place / name).write_text(text)
    return [place / name for name in sources]
