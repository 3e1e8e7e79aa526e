"""The same generated C as WebAssembly, for the report's page: a module for each model, without imports, and one that evaluates
their runs, compiled by PyPI's ziglang."""

from __future__ import annotations

import hashlib
from collections.abc import Collection, Iterable, Sequence
from functools import partial
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path

from ..children import side_by_side
from ..errors import BuildError
from ..model.deriving import deriving
from ..model.stage import Effect
from ..model.wheelchair import Choice, assemble
from . import cache, compiler
from .kernel import at_rest, kernel, seldom_among
from .source import CSRC, NOTHING, c_source, coefficients, tangent_source
from .store import kept
from .tangent import PUSHES, noisy, tangent

FORCES, TORQUES = 2, ("push.M_rl", "push.M_rr")  # the hands' forces carry noise; torques and a body do where they move
STACK = 1 << 20  # bytes; the filter's matrices take the most
# bytes: where in a model's memory the data of what evaluates its runs begin. Stacks grow down: the model's from STACK, above
# which are its data; that of the evaluation from here, so that neither reaches the other's.
BESIDE = 3 * STACK
FLAGS = (
    "-target",
    "wasm32-wasi",
    "-mexec-model=reactor",
    "-std=c11",
    "-Os",
    "-fno-unroll-loops",
    "-msimd128",
    "-g0",
    "-s",
    "-ffp-contract=off",
    "-fno-sanitize=all",
    "-fvisibility=hidden",
)

# What is small wins: the step in loops over its stages instead of written out, and no other beside it; second derivatives by
# difference.
STEP = {"step": "wc_page_step"}
KERNEL = ("start", "project", "output", "mass")
TANGENT = dict.fromkeys(("prepare", "bend", "slopes_all", "prepare_all", "bend_all", "begin"), NOTHING)


def modules(
    models: Iterable[tuple[Choice, Iterable[Effect]]], columns: Sequence[str], moving: Collection[str] = ()
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
    moved, pushes = seldom_among(moving), _noisy(moving)
    with side_by_side() as pool:
        waiting = []
        for choice, some in models:
            effects = sorted(some, key=lambda e: e.id)
            make = partial(_compile, choice, effects, columns, moved, pushes)
            waiting.append(pool.submit(kept, _name(choice, effects, columns, moved, pushes), ".wasm", make))
        return [w.result().read_bytes() for w in waiting]


def evaluation(moving: Collection[str] = ()) -> bytes:
    """The module that evaluates runs of such models, `csrc/page_evaluation.c`, in the memory of one of them."""
    pushes = _noisy(moving)
    words = "\n".join((cache.sources(), str(FLAGS), str(BESIDE), str(pushes), version("ziglang")))
    name = f"evaluation-{hashlib.sha256(words.encode()).hexdigest()[:24]}"
    return kept(name, ".wasm", partial(_compile_evaluation, pushes)).read_bytes()


def _compile_evaluation(pushes: int, target: Path) -> None:
    beside = ["-Wl,--import-memory", f"-Wl,--global-base={BESIDE}", _stack(BESIDE)]
    files = [CSRC / name for name in ("innovations.c", "evaluation.c", "page_evaluation.c")]
    compiler.compile_wasm(files, target, [*FLAGS, f"-DWC_PUSHES={pushes}", *beside])


def _stack(size: int) -> str:
    return f"-Wl,-z,stack-size={size}"


def _noisy(moving: Collection[str]) -> int:
    """How many of the first inputs carry noise, and are derived by."""
    several = noisy(moving)
    return several if several > PUSHES or any(t in moving for t in TORQUES) else FORCES


def _name(choice: Choice, effects: list[Effect], columns: Sequence[str], moving: list[str], pushes: int) -> str:
    given = map(repr, (choice, list(columns), moving, pushes))
    words = "\n".join((cache.sources(), str(FLAGS), str(STACK), *given, *map(cache.effect_key, effects)))
    return hashlib.sha256(f"{words} {version('ziglang')}".encode()).hexdigest()[:24]


def _compile(
    choice: Choice, effects: list[Effect], columns: Sequence[str], moving: list[str], pushes: int, target: Path
) -> None:
    files = _written(choice, effects, columns, moving, pushes, target.parent)
    by_hand = [CSRC / name for name in ("tangent.c", "rodas.c", "page.c")]
    flags = [*FLAGS, _stack(STACK), f"-DWC_PUSHES={pushes}", f"-I{CSRC}", "-include", str(target.with_name("coefficients.h"))]
    compiler.compile_wasm([*files, *by_hand], target, flags)


def _written(
    choice: Choice, effects: list[Effect], columns: Sequence[str], moving: list[str], pushes: int, place: Path
) -> list[Path]:
    """The model's C files, and what they need beside them."""
    with deriving:
        model = at_rest(assemble(choice, effects), moving)
        sources = {
            "model.c": c_source(kernel(model, KERNEL), "model", STEP),
            "tangent_model.c": tangent_source(tangent(model, columns, pushes), "tangent", TANGENT),
        }
    for name, text in {**sources, "coefficients.h": coefficients()}.items():
        (place / name).write_text(text)
    return [place / name for name in sources]
