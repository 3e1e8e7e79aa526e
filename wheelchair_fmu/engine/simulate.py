"""Drive a compiled model from Python over a run with sampled inputs."""

from __future__ import annotations

import ctypes
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..errors import SimulationError
from ..model.variant import Variant
from ..model.wheelchair import Model
from . import cache

WHY = {
    1: "the equations gave NaN or infinity",
    2: "no step was short enough for the tolerance, or too many would have been needed",
    3: "the algebraic equations have no solution nearby",
}


class Accuracy(ctypes.Structure):
    _fields_ = (("tolerance", ctypes.c_double), ("grid", ctypes.c_double))


@dataclass(frozen=True)
class Trajectory:
    """Times (n,), states (n, nx) and results (n, ny) of a run, SI units; `trajectory["chair.u"]` is one column."""

    time: np.ndarray
    states: np.ndarray
    results: np.ndarray
    names: tuple[str, ...]
    steps: int

    def __getitem__(self, name: str) -> np.ndarray:
        return self.results[:, self.names.index(name)]


class Simulator:
    """A variant, compiled when it is first run. Instances share nothing and may run in parallel threads.

    `columns`: use the library that also has the model's derivatives by these parameters, where that is at hand anyway.
    `moving`: the only inputs that may brake, slope or change the floor, and `run` raises ValueError for others; all may if it
    is not given.
    """

    def __init__(
        self, variant: Variant = Variant(), columns: Sequence[str] | None = None, moving: Collection[str] | None = None
    ):
        self.variant, self._columns, self._moving = variant, columns, moving
        self._compiled: ctypes.CDLL | None = None

    @property
    def library(self) -> ctypes.CDLL:
        """What it is compiled to."""
        if self._compiled is None:  # a cached_property of Python 3.11 would compile one model at a time
            self._compiled = cache.library(self.variant.choice, self.variant.active(), self._columns, self._moving)
        return self._compiled

    @cached_property
    def model(self) -> Model:
        return self.variant.model()

    @cached_property
    def _sizes(self) -> tuple[int, ...]:
        """How many states, inputs, parameters and results there are, which an expression takes its time to tell."""
        m = self.model
        return m.x.numel(), m.w.numel(), m.p.numel(), m.y.numel()

    @cached_property
    def _names(self) -> tuple[str, ...]:
        return tuple(o.name for o in self.model.outputs)

    @cached_property
    def _rest(self) -> Rest | None:
        return None if self._moving is None else Rest(self.model, self._moving)

    def inputs(self, n: int, values: Mapping[str, np.ndarray | float]) -> np.ndarray:
        """Inputs (n, nw) from arrays (n,) or numbers by FMI name; the rest stay at their start values."""
        names = [i.name for i in self.model.inputs]
        w = np.tile([i.start for i in self.model.inputs], (n, 1))
        for name, value in values.items():
            w[:, names.index(name)] = value
        return w

    def run(
        self,
        time: np.ndarray,
        inputs: np.ndarray,
        parameters: np.ndarray | None = None,
        *,
        tolerance: float = 1e-6,
        grid: float = 0.0,
        hold: bool = False,
        start: np.ndarray | None = None,
    ) -> Trajectory:
        """Simulate over `time` (n,), with inputs (n, nw) linear between samples (or held, as an FMU master holds them).

        `parameters` (np,) default to the variant's; `start` (nx,) to the start parameters. `tolerance` bounds each
        step's error relative to 1 + |x|. `grid` > 0 makes the steps those of the FMU: none crosses a multiple of it.

        Raises SimulationError, naming the time, where the model cannot go on.
        """
        t = np.ascontiguousarray(time, float)
        w = np.ascontiguousarray(inputs, float)
        p = np.ascontiguousarray(self.variant.vector() if parameters is None else parameters, float)
        nx, nw, parameters_, ny = self._sizes
        x, y = np.empty((len(t), nx)), np.empty((len(t), ny))
        if w.shape != (len(t), nw) or p.shape != (parameters_,):
            raise ValueError(f"inputs {w.shape} and parameters {p.shape} do not fit {len(t)} times and this model")
        if self._rest:
            self._rest.refuse_unrest(w)
        reached, steps = ctypes.c_long(), ctypes.c_long()
        status = self._start(p, w, x) if start is None else self._given(start, x)
        if not status:
            status = self.library.wc_run(
                self.kernel,
                _of(p),
                Accuracy(tolerance, grid),
                ctypes.c_long(len(t)),
                _of(t),
                _of(w),
                int(hold),
                _of(x),
                _of(y),
                ctypes.byref(reached),
                ctypes.byref(steps),
            )
        if status:
            raise SimulationError(stopped(status, t, reached.value))
        return Trajectory(t, x, y, self._names, steps.value)

    def _start(self, p: np.ndarray, w: np.ndarray, x: np.ndarray) -> int:
        return self.library.wc_start(self.kernel, _of(p), _of(w), _of(x))

    @property
    def kernel(self) -> ctypes.c_void_p:
        """Where the model's `wc_kernel` is."""
        return address(self.library, "model_kernel")

    @staticmethod
    def _given(start: np.ndarray, x: np.ndarray) -> int:
        x[0] = start
        return 0


def address(library: ctypes.CDLL, name: str) -> ctypes.c_void_p:
    """Where a library has a record of this name."""
    return ctypes.c_void_p(ctypes.addressof(ctypes.c_char.in_dll(library, name)))


def stopped(status: int, time: np.ndarray, reached: int) -> str:
    """What is told of a run over `time` that has reached so many of its samples."""
    when = time[min(max(reached, 1), len(time)) - 1]
    return f"the simulation stops at t = {when:.6g} s: {WHY[status]}; check the inputs and parameters there"


class Rest:
    """The inputs that brake, slope or change the floor, and stay at their start unless they are among the `moving`."""

    def __init__(self, model: Model, moving: Collection[str]):
        resting = {i: u for i, u in enumerate(model.inputs) if u.seldom and u.name not in moving}
        self._names, self._starts = [u.name for u in resting.values()], np.array([u.start for u in resting.values()])
        self._at = np.array([*resting], np.intp)

    def refuse_unrest(self, inputs: np.ndarray) -> None:
        """Raise ValueError where one of them moves among `inputs` (n, nw)."""
        unrest = inputs.take(self._at, axis=1) != self._starts
        if unrest.any():
            moved = [name for name, moves in zip(self._names, unrest.any(axis=0), strict=True) if moves]
            raise ValueError(
                f"this model has a level floor and open brakes; leave {', '.join(moved)} at rest, or name it as moving"
            )


def _of(array: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)
