"""Runs against their readings, by `csrc/evaluation.c`, which the report's page runs too: simulated, linearised, filtered, and
started where their readings want it."""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import prod

import numpy as np

from ..errors import SimulationError
from .innovations import MOST, Disturbance, FilterRecord, Noise, NoiseRecord, Whitener, noise_arrays, steps
from .sensitivities import DerivativesRecord, Sensitivities
from .simulate import stopped

KINDS = {"clock": 0, "baseline": 1}
UNBOUNDED = 5  # status: see evaluation.h


def _pointers(*names: str) -> tuple[tuple[str, type], ...]:
    return tuple((name, ctypes.c_void_p) for name in names)


def _whole(*names: str) -> tuple[tuple[str, type], ...]:
    return tuple((name, ctypes.c_int) for name in names)


class _Simulated(ctypes.Structure):
    _fields_ = _pointers("start", "results", "predicted", "foretold", "r")


class _Recording(ctypes.Structure):
    _fields_ = (
        *_pointers("kernel", "tangent"),
        ("n", ctypes.c_long),
        *_pointers("time", "inputs", "recorded", "late", "drifts", "usual"),
        ("speeds", ctypes.c_int * 2),
        ("noise", NoiseRecord),
        *_whole("active", "forced"),
        *_pointers("columns"),
        *_whole("starts"),
        *_pointers("start_places", "start_set"),
        *_whole("forward"),
        *_pointers("start_prior", "start_sd"),
        *_whole("constants"),
        *_pointers("constant_kind", "constant_inputs", "constant_readings", "constant_shape", "constant_sd"),
        *_whole("leads"),
    )


_NAMES = tuple(field[0] for field in _Recording._fields_ if field[1] is ctypes.c_void_p)


class _Values(ctypes.Structure):
    _fields_ = _pointers("p", "offsets", "numbers")


class _Evaluation(ctypes.Structure):
    _fields_ = (
        ("own", _Simulated),
        *_pointers("path", "told", "spread", "measured", "added"),
        ("by", DerivativesRecord),
        ("f", FilterRecord),
        *_pointers("gain", "scale", "offset", "by_start", "slopes", "constant", "less", "as_push"),
        *_pointers("x", "y", "driven", "p", "w", "column", "busy", "innovations", "added_again"),
        *_pointers("before", "step", "noise", "none", "errors", "trial", "reached", "pushed", "silent"),
    )


@dataclass(frozen=True)
class Constant:
    """What is uncertain of one run only, a clock or the `shape` (n,) of a baseline: its standard deviation, and which inputs
    (nw,) and readings (nz,) it is of."""

    kind: str
    sd: float
    inputs: np.ndarray
    readings: np.ndarray
    shape: np.ndarray | None = None


@dataclass(frozen=True)
class Recording:
    """One run, whatever the model's values are.

    inputs (n, nw) as recorded, and which of them (nw,) a delay of the record moves; readings (n, nz), NaN in gaps, which of a
    model's sensors they are, and which (nz,) drift; where the recorded pushes stand among the inputs; noise, but for its start;
    forces that nobody recorded, for a chair of 1 m track and the mass they were found for, along which a run may be led; where
    it starts, by names of parameters (m,): prior and standard deviation, and what the run itself sets.
    """

    time: np.ndarray
    inputs: np.ndarray
    late: np.ndarray
    readings: np.ndarray
    which: Sequence[int]
    drifts: np.ndarray
    pushes: Sequence[int]
    noise: Noise
    unknown: Disturbance | None
    leads: bool
    starts: Sequence[str]
    prior: np.ndarray
    sd: np.ndarray
    set: np.ndarray
    constants: Sequence[Constant]

    @cached_property
    def said(self) -> dict[str, np.ndarray]:
        """Of its noise, what a `NoiseRecord` points to, but for places."""
        return noise_arrays(self.time, self.noise, steps(self.time, np.isfinite(self.readings)), self.unknown)

    @cached_property
    def arrays(self) -> dict[str, np.ndarray]:
        """All that evaluations of it point to, whatever the model."""
        shapes = [np.zeros(len(self.time)) if c.shape is None else c.shape for c in self.constants]
        whole = {
            "pushes": self.pushes,
            "which": self.which,
            "late": self.late,
            "drifts": self.drifts,
            "start_set": self.set,
            "constant_kind": [KINDS[c.kind] for c in self.constants],
            "constant_inputs": [c.inputs for c in self.constants],
            "constant_readings": [c.readings for c in self.constants],
        }
        real = {
            "inputs": self.inputs,
            "recorded": self.readings,
            "usual": [np.median(np.diff(self.time))],
            "start_prior": self.prior,
            "start_sd": self.sd,
            "constant_shape": shapes,
            "constant_sd": [c.sd for c in self.constants],
        }
        given = {name: np.ascontiguousarray(a, np.intc) for name, a in whole.items()}
        return given | {name: np.ascontiguousarray(a, float) for name, a in real.items()} | self.said


@dataclass(frozen=True)
class Values:
    """Parameters (np,) of a model, offsets of readings (nz,), and what is not a parameter: s by which the record of pushes is
    early, times the forces along the heading that act on this chair, and its mass in kg."""

    parameters: np.ndarray
    offsets: np.ndarray
    delay: float
    along: float
    mass: float


@dataclass(frozen=True)
class Evaluation:
    """What `evaluate` finds: see evaluation.h. `start` (m + l,) and `path` (n, d) are where all is linearised, `by_parameter`
    (n, ns, k) by the parameters that were asked for and the start's, `offset` (nx,), `pushed` (n, nq) the errors of the pushes
    about which all is linearised."""

    start: np.ndarray
    path: np.ndarray
    results: np.ndarray
    predicted: np.ndarray
    driven: np.ndarray
    added: np.ndarray
    measured: np.ndarray
    r: np.ndarray
    by_start: np.ndarray
    slopes: np.ndarray
    by_parameter: np.ndarray
    offset: np.ndarray
    whitener: Whitener
    pushed: np.ndarray | None


class Evaluator:
    """A model with its derivatives, against recordings of its inputs. May run in parallel threads."""

    def __init__(self, sensitivities: Sensitivities, tolerance: float):
        self.of, self.tolerance = sensitivities, tolerance
        self._speeds = [i for i, s in enumerate(sensitivities.model.states) if s.name in ("u", "v")]
        self._names = [p.name for p in sensitivities.model.parameters]
        self._states, self._results = sensitivities.model.x.numel(), sensitivities.model.y.numel()

    def evaluate(
        self,
        run: Recording,
        values: Values,
        by: Sequence[str],
        start: np.ndarray,
        path: np.ndarray | None,
        rounds: int,
        pushed: np.ndarray | None = None,
        follows: bool = False,
        silent: np.ndarray | None = None,
    ) -> Evaluation:
        """The run from `start` (m + l,) along `path` (n, d), with pushes larger than their record by `pushed` (n, nq), without
        the readings that are `silent` (n, nz), and with derivatives `by` these parameters besides the start's.

        Its start is moved `rounds` times at most to where its readings want it; a run that is led goes where forces lead it, if
        that is not 0. One that `follows` is linearised about the likeliest errors of its pushes, where slopes do not hold
        as far as these lead. Raises SimulationError where the model cannot go on.
        """
        self.of.rest.refuse_unrest(run.inputs)
        place = _Place(self, run, values, by)
        place.view("start", (len(start),), "own")[:] = start
        place.view("path", place.path)[:] = 0.0 if path is None else path
        place.push(pushed)
        place.silence(silent)
        status = self.of.library.wc_evaluate(*place.records, ctypes.c_int(rounds)) or (place.follow() if follows else 0)
        if status == UNBOUNDED:
            raise SimulationError("what a clock or a baseline would do grows beyond all numbers; try other parameters")
        if status:
            raise SimulationError(stopped(status, run.time, ctypes.c_long.from_address(place.record.reached).value))
        found = place.evaluation()
        if not np.isfinite(found.whitener.logdet):  # a covariance that is none any more: readings drop out, and all seems well
            raise SimulationError("slopes along it grow beyond what a filter can follow; try other parameters")
        return found


class _Place:
    """The memory of one evaluation, and the records that point into it."""

    def __init__(self, of: Evaluator, run: Recording, values: Values, by: Sequence[str]):
        self.run, self.n, self.nz = run, len(run.time), run.readings.shape[1]
        self.library = of.of.library
        names = of._names
        self.nx, self.ny, self.ns, self.k = of._states, of._results, len(of.of.sensors), len(by) + len(run.starts)
        self.nd, self.l = 0 if run.unknown is None else run.unknown.count, len(run.constants)
        size = self.nx + len(run.pushes) + self.nd + self.nz
        if size > MOST:
            raise ValueError(f"{size} states, pushes, disturbances and readings are more than {MOST}")
        self.path = (self.n, self.nd)
        whole = {
            "columns": [of.of.columns.index(n) for n in (*by, *run.starts)],
            "start_places": [names.index(n) for n in run.starts],
        }
        real = {
            "p": values.parameters,
            "offsets": values.offsets,
            "numbers": [of.tolerance, values.delay, values.along, values.mass],
        }
        self.given = {name: np.ascontiguousarray(a, np.intc) for name, a in whole.items()}
        self.given |= {name: np.ascontiguousarray(a, float) for name, a in real.items()} | run.arrays
        at = {name: a.ctypes.data for name, a in self.given.items()}
        noise = NoiseRecord(len(run.pushes), self.nz, self.nd, **{n: at[n] for n in ("pushes", "which", *run.said)})
        recording = _Recording(
            of.of.simulator.kernel,
            of.of.tangent,
            self.n,
            noise=noise,
            speeds=(ctypes.c_int * 2)(*of._speeds),
            active=self.k,
            forced=any(not name.startswith("start.") for name in by),
            starts=len(run.starts),
            forward=run.starts.index("start.u"),
            constants=self.l,
            leads=run.leads,
            **{n: at[n] for n in _NAMES if n in at},
        )
        self._values = _Values(*(at[n] for n in ("p", "offsets", "numbers")))
        self.record, self._recording, rooms = _Evaluation(), recording, (ctypes.c_long * 2)()
        lay = self.library.wc_evaluation_room
        lay(ctypes.byref(recording), ctypes.byref(self.record), None, None, rooms)
        self.kept, self.work = (np.empty(room) for room in rooms)
        self._blocks = [(b, b.ctypes.data) for b in (self.kept, self.work)]
        lay(ctypes.byref(recording), ctypes.byref(self.record), *(ctypes.c_void_p(at) for _, at in self._blocks), rooms)

    @property
    def records(self) -> tuple[object, ...]:
        return tuple(ctypes.byref(r) for r in (self._recording, self._values, self.record))

    def view(self, name: str, shape: tuple[int, ...], of: str = "") -> np.ndarray:
        """An array of the evaluation, or of a record in it, where it lies."""
        address, count = getattr(getattr(self.record, of) if of else self.record, name), prod(shape)
        for block, at in self._blocks:
            first = (address - at) // 8
            if first >= 0 and first + count <= len(block):
                return block[first : first + count].reshape(shape)
        raise AssertionError(f"{name} is nowhere")

    def push(self, errors: np.ndarray | None) -> None:
        """Has pushes act that are larger than their record by `errors` (n, nq)."""
        self.pushed = None if errors is None else np.ascontiguousarray(errors, float)
        if self.pushed is not None and self.pushed.shape != (self.n, len(self.run.pushes)):
            raise ValueError(f"errors of {len(self.run.pushes)} pushes at {self.n} moments have the shape {self.pushed.shape}")
        self.record.pushed = None if self.pushed is None else self.pushed.ctypes.data

    def silence(self, which: np.ndarray | None) -> None:
        """Asks none of these readings (n, nz)."""
        self._silent = None if which is None else np.ascontiguousarray(which, np.int8)
        if self._silent is not None and self._silent.shape != (self.n, self.nz):
            raise ValueError(f"of {self.nz} readings at {self.n} moments, those of the shape {self._silent.shape} are silent")
        self.record.silent = None if self._silent is None else self._silent.ctypes.data

    def follow(self) -> int:
        """Goes on to where errors of the pushes lead, about which it is linearised then; a status."""
        room = self.library.wc_pushes_room
        room.restype = ctypes.c_long
        shape = (self.n, len(self.run.pushes))
        errors = np.zeros(shape) if self.pushed is None else self.pushed.copy()
        work = np.empty(room(self.records[0]))
        at = errors.ctypes.data
        status: int = self.library.wc_follow_pushes(*self.records, ctypes.c_void_p(at), ctypes.c_void_p(work.ctypes.data))
        if self.record.pushed == at:
            self.pushed = errors
        return status

    def evaluation(self) -> Evaluation:
        """Copies of what is told, and of the filter, each to be forgotten by itself: the rest is needed no more."""
        n, nz, u, told = self.n, self.nz, len(self.run.starts) + self.l, self._told
        readings = {name: told(name, n, nz, of="own") for name in ("predicted", "r")}
        return Evaluation(
            start=told("start", u, of="own"),
            path=told("path", *self.path),
            results=told("results", n, self.ny, of="own"),
            **readings,
            **{name: told(name, n, nz) for name in ("driven", "added", "measured")},
            by_start=told("by_start", n, nz, u),
            slopes=told("slopes", n, nz, u),
            by_parameter=self.view("by_parameter", (n, self.ns, self.k), "by"),
            offset=told("offset", self.nx),
            whitener=self._whitener(),
            pushed=self.pushed,
        )

    def _told(self, name: str, *shape: int, of: str = "") -> np.ndarray:
        """A copy of what is told there."""
        return self.view(name, shape, of).copy()

    def _whitener(self) -> Whitener:
        n, nz, nx, nq = self.n, self.nz, self.nx, len(self.run.pushes) + self.nd
        shapes = {"B": (n - 1, nx, nq), "C": (n - 1, nx, nq), "H": (n, nz, nx), "D": (n, nz, nq), "input_sd": (n, nq)}
        shapes |= {"input_phi": (n - 1, nq), "phi": (n - 1, nz), "start_cov": (nx, nx), "common": (nq, nq)}
        arrays = {name: self._told(name, *shape, of="f") for name, shape in shapes.items()}
        arrays["A"] = self._told("transition", n - 1, nx, nx, of="by")
        arrays["sd"] = self.given["sd"]
        flags = self.view("present", (n * nz // 8 + 1,), "f").view(np.int8)[: n * nz].reshape(n, nz).copy()
        gain, scale = self._told("gain", n, nz, nx + nq + nz), self._told("scale", n, nz)
        logdet = float(self.view("told", (2,))[0])
        present, noise = np.isfinite(self.run.readings), replace(self.run.noise, start=arrays["start_cov"])
        return Whitener.of(
            self.run.time, noise, present, {**arrays, "present": flags}, len(self.run.pushes), gain, scale, logdet
        )
