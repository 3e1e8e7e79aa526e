"""Compiled kernels, kept between sessions: derived and compiled once for each choice of laws and effects."""

from __future__ import annotations

import ctypes
import hashlib
import linecache
import logging
import os
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cache, partial
from importlib.metadata import version
from pathlib import Path

import casadi as cs

from ..children import side_by_side
from ..configuration import OF_MODELS, digest
from ..errors import BuildError
from ..model.deriving import deriving
from ..model.expression import ExpressionLaw
from ..model.stage import Effect, Law
from ..model.wheelchair import Choice, assemble
from . import compiler, shipped
from .kernel import SIMULATED, at_rest, kernel, seldom_among
from .lanes import in_two, lanes_source, of_stages
from .objects import compiled
from .source import CSRC, c_source, coefficients, tangent_source
from .store import kept
from .tangent import Tangent, noisy, tangent

log = logging.getLogger(__name__)
PACKAGE = Path(__file__).parent.parent
# How much to optimise: of what CasADi writes, straight lines of arithmetic, -O2 takes compilers up to twice as long, for a few
# percent of speed in derivatives and for none in a step; of what calls the others, -O3 does.
LEVELS = {
    **{"model": "-O1", "tangent_model": "-O1", "tangent_lanes": "-O1", "model_lanes": "-O2"},
    **{"advance": "-O2", "tangent": "-O3", "rodas": "-O3", "lanes": "-O3"},
    **{"innovations": "-O3", "evaluation": "-O2", "processor": "-O2"},
}
SIMULATING, DERIVING = ("advance",), ("tangent", "rodas", "innovations", "evaluation")  # files of `csrc` in libraries that do
OF_PUSHES = ("tangent", "rodas", "evaluation")  # and those that are compiled for a number of noisy inputs
VECTORS = {8: ("-mavx512f", "-mavx512dq", "-mavx512vl"), 4: ("-mavx2",), 2: ()}  # flags by how many numbers a vector holds
RESTING = {"output": (2,), "still": (1, 2)}  # results of a chair's rows: its parameters are the same in all; its inputs, too
ANYWHERE = 2  # numbers in a vector: what every processor of a system has
SHORT = 4  # and as many as rows of one chair's derivatives and covariances make use of


@dataclass(frozen=True)
class Wanted:
    """What a model's library is asked for: laws, effects in order, parameters to differentiate by, and inputs that move."""

    choice: Choice
    effects: tuple[Effect, ...]
    columns: tuple[str, ...] | None
    moved: tuple[str, ...] | None

    @classmethod
    def of(
        cls,
        choice: Choice,
        effects: Iterable[Effect],
        columns: Iterable[str] | None = None,
        moving: Iterable[str] | None = None,
    ) -> Wanted:
        moved = None if moving is None else tuple(seldom_among(moving))
        return cls(choice, tuple(sorted(effects, key=lambda e: e.id)), None if columns is None else tuple(columns), moved)

    @property
    def words(self) -> str:
        """The same for what is the same."""
        return "\n".join((repr(self.choice), repr(self.columns), repr(self.moved), *map(effect_key, self.effects)))


def library(
    choice: Choice, effects: Iterable[Effect], columns: Sequence[str] | None = None, moving: Iterable[str] | None = None
) -> ctypes.CDLL:
    """The loaded shared library of a model, with `wc_kernel model_kernel` and `advance.h`'s functions.

    With `columns`, parameters to differentiate by, also `wc_tangent tangent_tangent` and `tangent.h`'s. With
    `moving`, inputs, the chair is on a level floor with open brakes but for these, whatever the others say: half the work.
    """
    wanted = Wanted.of(choice, effects, columns, moving)
    if there := shipped.library(_independent(wanted.words)):
        return there
    wide = width()
    key = hashlib.sha256(f"{_toolchain()}\n{wide}\n{wanted.words}".encode()).hexdigest()[:24]
    return _loaded(kept(key, compiler.SUFFIX, lambda path: _compile(wanted, path, wide)))


def lanes(choice: Choice, effects: Iterable[Effect], step: str, results: Sequence[str]) -> ctypes.CDLL:
    """The loaded shared library of `lanes.c` for a model: this `step` of its kernel, and the `results` of these names.

    Raises BuildError where the compiler has no vectors.
    """
    wanted, wide = Wanted.of(choice, effects), width()
    words = "\n".join((_toolchain(), str(wide), step, repr(tuple(results)), wanted.words))
    key = hashlib.sha256(words.encode()).hexdigest()[:24]
    return _loaded(kept(key, compiler.SUFFIX, lambda path: _compile_lanes(wanted, step, results, wide, path)))


def width() -> int:
    """How many numbers fit into a vector of this processor; as many as anywhere where that cannot be asked."""
    try:
        return int(helper("processor").wc_width())
    except BuildError:
        return ANYWHERE


def helper(name: str, wide: int = ANYWHERE) -> ctypes.CDLL:
    """A hand-written C file of `csrc` that stands alone, compiled for vectors of so many numbers, and loaded."""
    if there := shipped.library(_independent(name)):
        return there
    key = _name(f"{name}-{wide}", compiler.SUFFIX)
    return _loaded(kept(key, compiler.SUFFIX, lambda path: _compile_helper(name, path, wide)))


def ship(wanted: Wanted, system: str, suffix: str, cross: tuple[str, ...] | None) -> Path:
    """What `library` would load on another system, by the compiler for that, where an installed package looks for it."""
    return shipped.put(_independent(wanted.words), system, suffix, partial(_compile, wanted, wide=ANYWHERE, cross=cross))


def ship_helper(name: str, system: str, suffix: str, cross: tuple[str, ...] | None) -> Path:
    """The same for what `helper` would load."""
    return shipped.put(_independent(name), system, suffix, partial(_compile_helper, name, wide=ANYWHERE, cross=cross))


def _compile_helper(name: str, target: Path, wide: int, cross: tuple[str, ...] | None = None) -> None:
    compiler.compile_shared([_Build(0, wide, cross).by_hand(name)], target, (), cross)


def _loaded(path: Path) -> ctypes.CDLL:
    try:
        return ctypes.CDLL(str(path))
    except OSError as error:
        raise BuildError(
            f"what {' '.join(compiler.command())} makes cannot be loaded here ({error}); set CC to a compiler for this machine"
        ) from error


def _compile(wanted: Wanted, target: Path, wide: int, cross: tuple[str, ...] | None = None) -> None:
    build, by_hand = _Build(noisy(wanted.moved or ()), wide, cross), SIMULATING if wanted.columns is None else DERIVING
    with side_by_side(os.cpu_count()) as pool:
        others = [pool.submit(build.by_hand, name) for name in by_hand]  # while the model is derived
        with deriving:  # what compiles models runs side by side
            texts, by = _derived(wanted, build)
        try:
            build.link(texts, others, target, pool)
        except BuildError as error:
            if by is None:
                raise
            log.info("stages are evaluated one by one: %s", error)
            with deriving:
                plainly = tangent_source(by, "tangent")
            build.link({"model": texts["model"], "tangent_model": plainly}, others, target, pool)


def _derived(wanted: Wanted, build: _Build) -> tuple[dict[str, str], Tangent | None]:
    """Generated C by name, and the derivatives that it has, if any."""
    model = assemble(wanted.choice, wanted.effects)
    if wanted.moved is not None:
        model = at_rest(model, wanted.moved)
    texts = {"model": c_source(kernel(model, SIMULATED), "model")}
    if wanted.columns is None:
        return texts, None
    by = tangent(model, wanted.columns, build.pushes)
    of_several, names = of_stages(by, "tangent")
    together = {"tangent_lanes": of_several, "tangent_model": tangent_source(by, "tangent", names, build.wide)}
    return {**texts, **together}, by


def _compile_lanes(wanted: Wanted, step: str, results: Sequence[str], wide: int, target: Path) -> None:
    model = assemble(wanted.choice, wanted.effects)
    places = {o.name: i for i, o in enumerate(model.outputs)}
    some = cs.densify(model.y[[places[name] for name in results]])
    output = cs.Function("output", [model.x, model.w, model.p], cs.cse([some]))
    texts = [lanes_source({"step": kernel(model, [step]).functions[step]})]
    texts += [in_two(output, name, resting) for name, resting in RESTING.items()]
    with side_by_side(os.cpu_count()) as pool:
        build = _Build(0, wide, None)
        build.link({"model_lanes": "".join(texts)}, [pool.submit(build.by_hand, "lanes")], target, pool)


@dataclass(frozen=True)
class _Build:
    """How the files of a library are compiled: for how many noisy inputs and numbers in a vector, by this system's compiler or
    the one `cross` for another."""

    pushes: int
    wide: int
    cross: tuple[str, ...] | None

    def link(self, texts: Mapping[str, str], others: Sequence[Future[Path]], target: Path, pool: ThreadPoolExecutor) -> None:
        """Generated C by name, and `others`, objects of files of `csrc`, as one library."""
        objects = [pool.submit(compiled, name, text, self._flags(name), self.cross) for name, text in texts.items()]
        compiler.compile_shared([o.result() for o in (*objects, *others)], target, (), self.cross)

    def by_hand(self, name: str) -> Path:
        """A file of `csrc`, compiled once for all libraries of as many noisy inputs, or for all where it asks for none."""
        if name not in OF_PUSHES and self.pushes:
            return replace(self, pushes=0).by_hand(name)

        def make(path: Path) -> None:
            header = path.with_name("coefficients.h")
            header.write_text(coefficients())
            flags = ["-include", str(header), f"-I{CSRC}", *self._flags(name)]
            compiler.compile_object(CSRC / f"{name}.c", path, flags, self.cross)

        return kept(_name(f"{name}-{self.pushes}-{self.wide}", ".o", self.cross), ".o", make)

    def _flags(self, name: str) -> list[str]:
        """How one of the files is compiled. Those of one chair, whose rows are short, need no long vectors; no number depends
        on it, as nothing is contracted."""
        longest = self.wide if name.endswith("lanes") else min(self.wide, SHORT)
        counts = [f"-DWC_PUSHES={self.pushes}", f"-DWC_LANES={self.wide}"]
        return ["-fvisibility=default", LEVELS[name], *counts, *VECTORS[longest]]


def _name(name: str, suffix: str, cross: tuple[str, ...] | None = None) -> str:
    """What a file of `csrc`, compiled, is called."""
    return f"{name}-{hashlib.sha256(f'{_toolchain(cross)} {suffix}'.encode()).hexdigest()[:24]}"


def _toolchain(cross: tuple[str, ...] | None = None) -> str:
    """What every native kernel depends on: `sources` and the compiler."""
    return f"{sources()} {compiler.version(cross)} {compiler.FLAGS}"


def _independent(words: str) -> str:
    """The key of what was compiled elsewhere from the same equations, whatever derived and compiled it there."""
    return hashlib.sha256(f"{equations()}\n{words}".encode()).hexdigest()[:24]


def sources() -> str:
    """What all generated code depends on: `equations` and CasADi."""
    return f"{equations()} {version('casadi')}"


@cache
def equations() -> str:
    """This package's equations, and a user's own."""
    files = sorted([*(PACKAGE / "model").rglob("*.py"), *(PACKAGE / "engine").rglob("*.[pch]*"), PACKAGE / "quantities.py"])
    files = [f for f in files if "__pycache__" not in f.parts]
    texts = hashlib.sha256(b"".join(f.read_bytes() for f in files)).hexdigest()
    return f"{texts} {digest(*OF_MODELS)}"


def effect_key(effect: Effect) -> str:
    """An effect by its files' content, its laws' code or expressions and what its records say of numbers' places, so that an
    edited file, or another effect of that name, is a new one."""
    of_rows = (law for r in effect.rows for law in r.laws)
    laws = [*(c.law for c in effect.contributions), *of_rows]
    said = [(law.expression, law.arguments) for law in laws if isinstance(law, ExpressionLaw)]
    functions = [law for law in laws if not isinstance(law, ExpressionLaw)]
    codes = [law.__code__ for law in functions]
    files = {c.co_filename: "".join(linecache.getlines(c.co_filename)) for c in codes}
    if effect.program and codes:  # as it ran; another file of that name may have been read since
        files[effect.program.file] = effect.program.text
    words = repr([(c.co_code, c.co_names, c.co_consts) for c in codes if not files[c.co_filename]] + said)
    targets = repr([(c.to, c.factor) for c in effect.contributions] + [(*r.coupled,) for r in effect.rows if r.coupled])
    texts = "".join(files[name] for name in sorted(files))
    return (
        f"{effect.id} {targets} {_records(effect)} {words} {_enclosed(functions)} {hashlib.sha256(texts.encode()).hexdigest()}"
    )


def _records(effect: Effect) -> str:
    """Which place in the vectors of parameters and states belongs to which symbol, and what a step's error is measured by."""
    parameters = [(p.symbol, p.off is None) for p in (*effect.parameters, *effect.constants)]
    states = [(s.symbol, s.components, s.nominal) for s in (r.state for r in effect.rows)]
    return repr((parameters, states))


def _enclosed(functions: Sequence[Law]) -> str:
    """What functions hold that stands in no text of theirs: numbers of the function that made them, and defaults."""
    cells = [[repr(c.cell_contents) for c in f.__closure__ or ()] for f in functions]
    return repr((cells, [repr(f.__defaults__) for f in functions]))
