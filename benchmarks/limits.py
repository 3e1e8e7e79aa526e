"""What the arithmetic of the model alone would take a core that is never kept waiting:  python -m benchmarks.limits

A core's rates are measured by `core.c`: sums and products, quotients, roots, of single numbers and of vectors of them. Products
are not contracted with sums, as in the kernels. Operations are counted in the functions that kernels are made of; sines,
arctangents, exponentials and logarithms count as what `lanes.h` makes of them, about. Quotients and roots go on beside sums and
products, so the slower of the two decides. Memory, branches and what waits for its operands stand between this and what is
measured.
"""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import casadi as cs
import numpy as np

from wheelchair_fmu.engine import cache as compiled
from wheelchair_fmu.engine import compiler
from wheelchair_fmu.engine.inverses import dividing_once
from wheelchair_fmu.engine.source import CSRC
from wheelchair_fmu.model.wheelchair import Model

SINGLY = ("-DALONE", "-DWC_LANES=2", "-fno-tree-vectorize", "-fno-tree-slp-vectorize")
CHAINS, ROUNDS, REPEATS = 12, 20_000, 200  # rounds shorter than what interrupts them
SUMS = ("ADD", "SUB", "MUL", "SQ", "TWICE", "FMAX", "FMIN", "LT", "LE", "EQ", "NE", "IF_ELSE_ZERO")
QUOTIENTS, ROOTS = ("DIV", "INV"), ("SQRT",)
FUNCTIONS = {"SIN": (55, 0), "COS": (55, 0), "ATAN": (45, 1), "ATAN2": (45, 1), "EXP": (40, 0), "LOG": (35, 1)}


@dataclass(frozen=True)
class Core:
    """Operations a second, and how many numbers one instruction takes."""

    lanes: int
    sums: float
    quotients: float
    roots: float

    def __str__(self) -> str:
        what = "one by one" if self.lanes == 1 else f"{self.lanes} at once"
        return (
            f"{what}: {self.sums / 1e9:.1f} GFLOP/s, {self.quotients / 1e9:.2f} G quotients/s, {self.roots / 1e9:.2f} G roots/s"
        )


@dataclass(frozen=True)
class Work:
    """Operations, of each kind."""

    sums: float = 0.0
    quotients: float = 0.0
    roots: float = 0.0

    def __add__(self, other: Work) -> Work:
        return Work(self.sums + other.sums, self.quotients + other.quotients, self.roots + other.roots)

    def __mul__(self, times: float) -> Work:
        return Work(self.sums * times, self.quotients * times, self.roots * times)

    @property
    def operations(self) -> float:
        return self.sums + self.quotients + self.roots

    def seconds(self, core: Core) -> float:
        """What a core takes at the least."""
        return max(self.sums / core.sums, self.quotients / core.quotients + self.roots / core.roots)


def of(function: cs.Function) -> Work:
    """What one call of a kernel's function takes."""
    names = {getattr(cs, name): name[3:] for name in dir(cs) if name.startswith("OP_")}
    f, work = dividing_once(function, "f"), Work()
    for k in range(f.n_instructions()):
        op = names[f.instruction_id(k)]
        sums, quotients = FUNCTIONS.get(op, (int(op in SUMS), int(op in QUOTIENTS)))
        work += Work(sums, quotients, int(op in ROOTS))
    return work


def results(model: Model, names: Sequence[str]) -> cs.Function:
    """Some of a model's results, as `Ensemble` has them."""
    places = {o.name: i for i, o in enumerate(model.outputs)}
    wanted = cs.densify(model.y[[places[name] for name in names]])
    return cs.Function("output", [model.x, model.w, model.p], [cs.cse(wanted)])


@cache
def core(lanes: int) -> Core:
    """This machine's core with so many numbers in a vector; 1 for single ones."""
    flags = SINGLY if lanes == 1 else (f"-DWC_LANES={lanes}", *compiled.VECTORS[lanes])
    with TemporaryDirectory() as folder:
        target = Path(folder) / f"core{compiler.SUFFIX}"
        compiler.compile_shared([Path(__file__).with_name("core.c")], target, [f"-I{CSRC}", "-fvisibility=default", *flags])
        library = ctypes.CDLL(str(target))
        per_round = {name: _fastest(getattr(library, name)) / (CHAINS * lanes) for name in ("sums", "quotients", "roots")}
    return Core(lanes, 2 / per_round["sums"], 1 / per_round["quotients"], 1 / per_round["roots"])


def _fastest(call: ctypes._FuncPointer) -> float:
    """Seconds of a round."""
    memory = np.empty(16)
    at = memory[-(memory.ctypes.data // 8) % 8 :]  # vectors stand on whole ones
    begin, seconds = np.linspace(1, 2, CHAINS), []  # equal ones would be made one of
    for _ in range(REPEATS):
        start = perf_counter()
        call(ctypes.c_long(ROUNDS), ctypes.c_void_p(begin.ctypes.data), ctypes.c_void_p(at.ctypes.data))
        seconds.append(perf_counter() - start)
    return min(seconds) / ROUNDS


def widest() -> Core:
    return core(compiled.width())


if __name__ == "__main__":
    print(core(1))
    print(widest())
    sys.exit(0)
