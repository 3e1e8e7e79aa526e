"""Runs with their derivatives: readings by parameters, states and recorded pushes, exact for the steps taken."""

from __future__ import annotations

import ctypes
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from ..errors import SimulationError
from ..model.variant import Variant
from .simulate import Rest, Simulator, address, stopped
from .tangent import differentiable, noisy, sensed


class DerivativesRecord(ctypes.Structure):
    """`wc_derivatives` of tangent.h."""

    _fields_ = (
        ("active", ctypes.c_int),
        ("which", ctypes.c_void_p),
        ("forced", ctypes.c_int),
        *(
            (name, ctypes.c_void_p)
            for name in ("transition", "push_before", "push_after", "by_state", "by_push", "start", "by_parameter")
        ),
    )


@dataclass(frozen=True)
class Linearised:
    """A run of n samples and its derivatives, SI units.

    readings (n, ns); by_parameter (n, ns, k): readings by the parameters asked for, through all that went before;
    transition (n−1, nx, nx): states by the states a sample earlier; push_before and push_after (n−1, nx, q): by the
    recorded pushes at both ends of the interval (q = 4, or 5 where the rider's momentum is recorded too); by_state (n, ns, nx)
    and by_push (n, ns, q): readings at a sample;
    start (nx, k): the states at the start by the parameters asked for.
    """

    time: np.ndarray
    states: np.ndarray
    results: np.ndarray
    readings: np.ndarray
    by_parameter: np.ndarray
    transition: np.ndarray
    push_before: np.ndarray
    push_after: np.ndarray
    by_state: np.ndarray
    by_push: np.ndarray
    start: np.ndarray


class Sensitivities:
    """A variant with its derivatives by all parameters that a fit may touch, or by some `columns` of them: the fewer, the
    faster; with none, only its `simulator` runs. It is compiled when it is first run. Of brakes, slopes and floors only those
    named as `moving` may leave their start. Instances may run in parallel threads."""

    def __init__(self, variant: Variant, columns: Sequence[str] | None = None, moving: Collection[str] = ()):
        self.variant, self.model = variant, variant.model()
        self.columns = tuple(p.name for p in differentiable(self.model, columns))
        self.simulator, self.moving = Simulator(variant, self.columns or None, moving), moving
        self.pushes, self.rest = noisy(moving), Rest(self.model, moving)
        self.simulator.model = self.model  # which takes as long to assemble as ten runs
        self.rows = sensed(self.model)
        self.sensors = tuple(self.model.outputs[i].name for i in self.rows)
        self.results = tuple(o.name for o in self.model.outputs)

    @property
    def library(self) -> ctypes.CDLL:
        """What it is compiled to."""
        return self.simulator.library

    @property
    def tangent(self) -> ctypes.c_void_p:
        """Where the model's `wc_tangent` is."""
        return address(self.library, "tangent_tangent")

    def run(
        self, time: np.ndarray, inputs: np.ndarray, parameters: np.ndarray, by: Sequence[str] = (), *, tolerance: float = 1e-6
    ) -> Linearised:
        """Simulate over `time` (n,) with inputs (n, nw) linear between samples; derivatives `by` these parameters.

        Raises SimulationError, naming the time, where the model cannot go on, and ValueError for inputs that move
        without being `moving`.
        """
        t, w, p = (np.ascontiguousarray(a, float) for a in (time, inputs, parameters))
        self.rest.refuse_unrest(w)
        which = np.array([self.columns.index(name) for name in by], dtype=np.intc)
        n, nx, ny, ns, k = len(t), self.model.x.numel(), self.model.y.numel(), len(self.sensors), len(by)
        x, y = np.empty((n, nx)), np.empty((n, ny))
        out = {
            "transition": np.empty((n - 1, nx, nx)),
            "push_before": np.empty((n - 1, nx, self.pushes)),
            "push_after": np.empty((n - 1, nx, self.pushes)),
            "by_state": np.empty((n, ns, nx)),
            "by_push": np.empty((n, ns, self.pushes)),
            "start": np.empty((nx, k)),
            "by_parameter": np.empty((n, ns, k)),
        }
        forced = any(not name.startswith("start.") for name in by)
        wanted = DerivativesRecord(k, which.ctypes.data, forced, *(a.ctypes.data for a in out.values()))
        kernel, tangent, room = self.simulator.kernel, self.tangent, self.library.wc_tangent_work
        room.restype = ctypes.c_long
        work = np.empty(room(kernel, tangent, ctypes.c_int(k)))
        reached = ctypes.c_long()
        status = self.library.wc_tangent_run(
            kernel,
            tangent,
            ctypes.c_void_p(p.ctypes.data),
            ctypes.c_double(tolerance),
            ctypes.c_long(n),
            *(ctypes.c_void_p(a.ctypes.data) for a in (t, w, x, y)),
            ctypes.byref(wanted),
            ctypes.c_void_p(work.ctypes.data),
            ctypes.byref(reached),
        )
        if status:
            raise SimulationError(stopped(status, t, reached.value))
        return Linearised(t, x, y, y[:, list(self.rows)], **out)
