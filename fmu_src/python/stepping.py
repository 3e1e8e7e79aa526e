"""The steps of advance.c in Python, on a model's functions as CasADi evaluates them: readable, and 20 times slower."""

from __future__ import annotations

from math import floor, isfinite, sqrt

import casadi as cs
import numpy as np

from .engine.kernel import kernel
from .model.wheelchair import Model

SHORTEST = 1e-11  # s; a step shorter than this means the model cannot go on
SNAP = 1e-6  # of the grid: communication points this near a grid point are on it
NEWTON = 25
NOTHING = 1e-35  # a state smaller than this is zero


class CannotGoOn(Exception):
    """The equations have no next state; the message is the reason."""


class Compiled:
    """A CasADi function without the cost of its usual call. Its results are overwritten by the next call."""

    def __init__(self, function: cs.Function):
        self.buffer, self.evaluate = function.buffer()
        self.arguments = [np.zeros(function.numel_in(i)) for i in range(function.n_in())]
        self.results = [np.zeros(function.nnz_out(i)) for i in range(function.n_out())]
        for i, a in enumerate(self.arguments):
            self.buffer.set_arg(i, memoryview(a))
        for i, r in enumerate(self.results):
            self.buffer.set_res(i, memoryview(r))

    def __call__(self, *values) -> list[np.ndarray]:
        for a, v in zip(self.arguments, values, strict=True):
            a[:] = v
        self.evaluate()
        return self.results


class Stepper:
    """One model and its way through time; the inputs are w, the parameters p, the states x, all arrays."""

    def __init__(self, model: Model):
        functions = kernel(model).functions
        self._start, self._project, self._step, self._output, self._mass = (
            Compiled(functions[name]) for name in ("start", "project", "step", "output", "mass")
        )
        self.nominal = np.array([s.nominal for s in model.states for _ in s.names])

    def start(self, p: np.ndarray, w: np.ndarray) -> np.ndarray:
        """States at the start, algebraic ones in place."""
        return self.project(self._start(p, w)[0].copy(), p, w)

    def project(self, x: np.ndarray, p: np.ndarray, w: np.ndarray) -> np.ndarray:
        """The states with their algebraic rows right after a jump."""
        for count in range(NEWTON):
            following = self._project(x, w, p)[0].copy()
            change = np.max(np.abs(following - x) / (self.nominal + np.abs(following)))
            if not isfinite(change):
                raise CannotGoOn("the equations give NaN or infinity")
            x = following
            if change < 1e-14 or (count > 4 and change < 1e-10):
                return x
        raise CannotGoOn("the algebraic equations have no solution nearby")

    def output(self, x: np.ndarray, p: np.ndarray, w: np.ndarray) -> np.ndarray:
        return self._output(x, w, p)[0].copy()

    def advance(
        self, x: np.ndarray, p: np.ndarray, w: np.ndarray, t0: float, t1: float, tolerance: float, grid: float
    ) -> np.ndarray:
        """The states at t1; no step crosses a multiple of the grid, and none remembers the last."""
        cell = floor(t0 / grid + SNAP)
        begin = 0.0 if abs(t0 / grid - cell) < SNAP else t0 - cell * grid
        last = t1 / grid
        while True:
            end = grid if cell + 1 <= last + SNAP else t1 - cell * grid
            x = self._go(x, p, w, end - begin, tolerance)
            if cell + 1 >= last - SNAP:
                return x
            cell, begin = cell + 1, 0.0

    def _go(self, x: np.ndarray, p: np.ndarray, w: np.ndarray, length: float, tolerance: float) -> np.ndarray:
        """A stretch in steps of the size that the error allows, of the integrated states only where one step is too long."""
        done, h, tested = 0.0, length, None
        while done < length:
            left = length - done
            now = h if h < left * (1 - 1e-9) else left
            x1, e = self._step(x, w, w, now, p)[:2]
            with np.errstate(invalid="ignore", over="ignore"):
                errors = np.abs(e) / (tolerance * (self.nominal + np.maximum(np.abs(x), np.abs(x1))))
            if tested is None and not np.max(errors) <= 1:
                tested = self._mass(p)[0] != 0
            error = float(np.max(errors if tested is None else errors[tested]))
            factor = 6.0 if error == 0 else 0.9 / sqrt(sqrt(error))
            if error <= 1:
                x = np.where(np.abs(x1) < NOTHING, 0.0, x1)
                done = length if now == left else done + now
                factor = min(max(factor, 0.2), 6.0)
                if now == h or factor < 1:
                    h = now * factor
            else:
                h = now * (factor if factor > 0.1 else 0.1)
                if h < SHORTEST:
                    raise CannotGoOn(
                        "no internal step is short enough for the tolerance"
                        if isfinite(error)
                        else "the equations give NaN or infinity"
                    )
        return x if tested is None else self.project(x, p, w)
