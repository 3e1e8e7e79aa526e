"""Many chairs of one variant through the same inputs, several in one instruction where the compiler has vectors."""

from __future__ import annotations

import ctypes
import logging
from collections.abc import Sequence
from dataclasses import dataclass
from math import prod
from threading import RLock

import numpy as np

from ..errors import BuildError, SimulationError
from . import cache
from .kernel import seldom
from .simulate import Simulator, stopped

log = logging.getLogger(__name__)
making = RLock()  # so that threads which ask for the same wait for one of them


@dataclass(frozen=True)
class Runs:
    """Results (chairs, wanted, n); for each chair why it has none, or None."""

    results: np.ndarray
    errors: list[str | None]

    def put(self, chairs: np.ndarray, runs: Runs) -> None:
        """These chairs' runs in their places."""
        self.results[chairs] = runs.results
        for chair, error in zip(chairs, runs.errors, strict=True):
            self.errors[chair] = error


class Ensemble:
    """A variant, ready to run with many parameters; `results` are those wanted of it, by name.

    What a chair gives does not depend on which chairs are beside it, nor on how many numbers a vector holds, and is
    `Simulator.run`'s but for rounding: sines and arctangents are not the C library's. Instances are made one at a time
    (`making`), and may run in parallel threads.
    """

    def __init__(self, simulator: Simulator, results: Sequence[str]):
        self.simulator, self.results = simulator, tuple(results)
        self._seldom = seldom(simulator.model)
        self._rest = np.array([simulator.model.inputs[i].start for i in self._seldom])
        self._libraries: dict[str, ctypes.CDLL | None] = {}

    def run(
        self,
        time: np.ndarray,
        inputs: np.ndarray,
        parameters: np.ndarray,
        *,
        tolerance: float = 1e-6,
        memory: np.ndarray | None = None,
    ) -> Runs:
        """Simulate over `time` (n,) with inputs (n, nw) linear between samples, with each row of `parameters` (chairs, np).

        `memory`: numbers at least as many as the results, which are put there; new memory is half of what a chair costs.
        """
        t, w, p = (np.ascontiguousarray(a, float) for a in (time, inputs, parameters))
        shape = len(p), len(self.results), len(t)
        results = np.empty(shape) if memory is None else memory[: prod(shape)].reshape(shape)
        runs = Runs(results, [None] * len(p))
        rests = self._seldom and not np.any(w[:, self._seldom] != self._rest)
        library = self._library("plain" if rests else "step") if len(t) > 1 else None
        if library is None:
            self._one_by_one(t, w, p, tolerance, runs)
        else:
            self._side_by_side(library, t, w, p, tolerance, runs)
        return runs

    def _library(self, step: str) -> ctypes.CDLL | None:
        with making:
            if step not in self._libraries:
                self._libraries[step] = self._compiled(step)
            return self._libraries[step]

    def _compiled(self, step: str) -> ctypes.CDLL | None:
        variant = self.simulator.variant
        try:
            library = cache.lanes(variant.choice, variant.active(), step, self.results)
        except BuildError as error:
            log.info("chairs are simulated one by one: %s", error)
            return None
        library.wc_lanes_work.restype = ctypes.c_long
        return library

    def _one_by_one(self, t: np.ndarray, w: np.ndarray, p: np.ndarray, tolerance: float, runs: Runs) -> None:
        for i, own in enumerate(p):
            try:
                trajectory = self.simulator.run(t, w, own, tolerance=tolerance)
                runs.results[i] = [trajectory[name] for name in self.results]
            except SimulationError as error:
                runs.errors[i], runs.results[i] = str(error), np.nan

    def _side_by_side(
        self, library: ctypes.CDLL, t: np.ndarray, w: np.ndarray, p: np.ndarray, tolerance: float, runs: Runs
    ) -> None:
        kernel, n = self.simulator.kernel, ctypes.c_long(len(t))
        status, reached = np.zeros(len(p), np.intc), np.zeros(len(p), np.dtype("long"))
        work = np.empty(library.wc_lanes_work(kernel, n))
        library.wc_lanes_run(
            kernel,
            len(self.results),
            ctypes.c_double(tolerance),
            ctypes.c_long(len(p)),
            _of(p),
            n,
            *map(_of, (t, w, runs.results, status, reached, work)),
        )
        for i in np.flatnonzero(status):
            runs.errors[i] = stopped(int(status[i]), t, int(reached[i]))
            runs.results[i] = np.nan


def _of(array: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)
