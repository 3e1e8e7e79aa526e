"""Whiten residuals, and sensitivities with them, by a Kalman filter along a simulated run.

Noise of the recorded pushes is integrated by the chair into its speed, heading and position, so far
from the start residuals are large and strongly correlated although nothing is wrong. What is new in
each reading, given all before, is not: innovations in units of their own standard deviation are
independent with variance 1 if the model and the noise are right.
"""

from __future__ import annotations

import ctypes
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np

from .cache import helper, width
from .sensitivities import Linearised

MOST = 64  # states, pushes and readings together, as in innovations.c


class FilterRecord(ctypes.Structure):
    """`filter` of innovations.h."""

    _fields_ = (
        *((name, ctypes.c_int) for name in ("nx", "nq", "nz")),
        *(
            (name, ctypes.c_void_p)
            for name in ("A", "B", "C", "H", "D", "input_sd", "input_phi", "sd", "phi", "start_cov", "present", "common")
        ),
    )


class NoiseRecord(ctypes.Structure):
    """`wc_noise` of innovations.h."""

    _fields_ = (
        *((name, ctypes.c_int) for name in ("nq", "nz", "nd")),
        *((name, ctypes.c_void_p) for name in ("time", "pushes", "which", "push_sd", "push_ar", "push_step")),
        *(
            (name, ctypes.c_void_p)
            for name in ("sd", "ar", "step", "unknown_sd", "lasting", "together", "as_push", "as_reading")
        ),
    )


class _Slopes(ctypes.Structure):
    _fields_ = (
        *((name, ctypes.c_int) for name in ("columns", "sensors")),
        *((name, ctypes.c_void_p) for name in ("push_before", "push_after", "by_state", "by_push")),
    )


@dataclass(frozen=True)
class Noise:
    """What is known of the noise: standard deviations of pushes (nq,) and readings (nz,), the AR(1) coefficients of each
    (nq,) and (nz,), from one of its own samples to the next, and the covariance of the start (nx, nx).

    `push_step` (nq,) is the time between samples of each recorded push, in s; without it, that of the run.
    """

    pushes: np.ndarray
    push_colour: np.ndarray
    readings: np.ndarray
    colour: np.ndarray
    start: np.ndarray
    push_step: np.ndarray | None = None


@dataclass(frozen=True)
class Disturbance:
    """Forces that nobody recorded: each a first-order Gauss–Markov process with a standard deviation (d,) and a time (d,) in s
    over which it is forgotten, either of them (n, d) where that changes from moment to moment. `as_push` (nq, d) says as what
    change of the recorded pushes one unit of each acts, `common` (d, d) how they are correlated at one moment: two that one
    white noise drives, without a mean, have 2 √(T₁ T₂) / (T₁ + T₂). Without it, each is on its own. `as_reading` (nz, d) is
    what a unit of each adds to each reading besides what it does to the chair: nothing, without it."""

    sd: np.ndarray
    lasting: np.ndarray
    as_push: np.ndarray
    common: np.ndarray | None = None
    as_reading: np.ndarray | None = None

    @property
    def count(self) -> int:
        """How many there are, d."""
        return self.as_push.shape[1]

    def pushed(self, path: np.ndarray) -> np.ndarray:
        """What change of the recorded pushes (n, nq) they are along a `path` (n, d)."""
        return np.asarray(path @ self.as_push.T)

    def felt(self, path: np.ndarray) -> np.ndarray | float:
        """What readings (n, nz) have of them there besides what they do to the chair."""
        return 0.0 if self.as_reading is None else np.asarray(path @ self.as_reading.T)


@cache
def _library() -> ctypes.CDLL:
    library = helper("innovations", width())
    library.wc_design.restype = library.wc_deviance.restype = ctypes.c_double
    return library


class Whitener:
    """The filter of one run: `run` its linearisation, `which` the places of its readings that were measured, `pushes` those of
    the recorded pushes, the first if not given; `present` (n, nz) False in gaps. `logdet` is Σ log of the innovations'
    variances.

    Readings about the moment a chair comes to rest, which no slope foretells (`kinks`; see wc_drop_kinks in innovations.c),
    tell nothing: they are 0, and in `logdet` as if they were as expected. `speeds` are the places of u and v among the states.
    A `disturbance` goes through the filter as further pushes, whose record is zero.
    """

    def __init__(
        self,
        run: Linearised,
        which: list[int],
        noise: Noise,
        present: np.ndarray,
        speeds: Sequence[int] = (),
        pushes: Sequence[int] | None = None,
        disturbance: Disturbance | None = None,
    ):
        self.present, self.noise, self.time = present, noise, run.time
        at = list(range(len(noise.pushes)) if pushes is None else pushes)
        self.recorded = len(at)
        self._at, self._which = np.array(at, np.intc), np.array(which, np.intc)
        self._slopes = {
            name: np.ascontiguousarray(getattr(run, name), float)
            for name in ("push_before", "push_after", "by_state", "by_push")
        }
        self.arrays = {
            "A": np.ascontiguousarray(run.transition, float),
            "sd": np.ascontiguousarray(noise.readings, float),
            "start_cov": np.ascontiguousarray(noise.start, float),
            "present": np.ascontiguousarray(present, np.int8),
        }
        self._compose(disturbance)
        if speeds:
            dt = float(np.median(np.diff(run.time)))
            _library().wc_drop_kinks(ctypes.byref(self._filter), ctypes.c_long(len(present)), ctypes.c_double(dt), *speeds)
        self.kinks = present & (self.arrays["present"] == 0)
        self._design()

    @classmethod
    def of(
        cls,
        time: np.ndarray,
        noise: Noise,
        present: np.ndarray,
        arrays: dict[str, np.ndarray],
        recorded: int,
        gain: np.ndarray,
        scale: np.ndarray,
        logdet: float,
    ) -> Whitener:
        """The filter of a run that is made already: its `arrays` as innovations.h has them, gains (n, nz, size) and scales (n,
        nz); `recorded` of its pushes have a record."""
        self = object.__new__(cls)
        self.time, self.noise, self.present, self.arrays, self.recorded = time, noise, present, arrays, recorded
        self.size = (arrays["A"].shape[1], arrays["common"].shape[0], present.shape[1])
        self.kinks = present & (arrays["present"] == 0)
        self._gain, self._scale, self.logdet = gain, scale, logdet
        self._keep()
        return self

    def _keep(self) -> None:
        """Of slopes what was measured, which is all that is needed from now on."""
        kept = {"push_before": "B", "push_after": "C", "by_state": "H", "by_push": "D"}
        self._slopes = {name: self.arrays[part] for name, part in kept.items()}
        self._at, self._which = np.arange(self.recorded, dtype=np.intc), np.arange(self.size[2], dtype=np.intc)

    def _compose(self, unknown: Disturbance | None) -> None:
        """What the filter has of its inputs and readings, with these forces acting that nobody recorded."""
        n, nz = self.present.shape
        nx, nd = self.arrays["A"].shape[1], 0 if unknown is None else unknown.count
        nq = self.recorded + nd
        self.size = (nx, nq, nz)
        if sum(self.size) > MOST:
            raise ValueError(f"{nx} states, {self.recorded} pushes, {nd} disturbances and {nz} readings are more than {MOST}")
        shapes = {"B": (n - 1, nx, nq), "C": (n - 1, nx, nq), "H": (n, nz, nx), "D": (n, nz, nq), "input_sd": (n, nq)}
        shapes |= {"input_phi": (n - 1, nq), "phi": (n - 1, nz), "common": (nq, nq)}
        self.arrays |= {name: np.empty(shape) for name, shape in shapes.items()}
        self.__dict__.pop("_filter", None)  # which is of the arrays that were
        said = noise_arrays(self.time, self.noise, self._steps, unknown)
        given = {"pushes": self._at, "which": self._which, **said}
        record = NoiseRecord(self.recorded, nz, nd, **{name: a.ctypes.data for name, a in given.items()})
        by = self._slopes
        slopes = _Slopes(by["by_push"].shape[2], by["by_state"].shape[1], **{name: a.ctypes.data for name, a in by.items()})
        filter_ = self._filter
        _library().wc_compose(ctypes.byref(record), ctypes.byref(slopes), ctypes.c_long(n), ctypes.byref(filter_))
        filter_.sd = self.arrays["sd"].ctypes.data  # what was said is gone after this
        self._keep()

    def _design(self) -> None:
        n, nz = self.present.shape
        self._gain, self._scale = np.empty((n, nz, sum(self.size))), np.empty((n, nz))
        self.logdet: float = _library().wc_design(
            ctypes.byref(self._filter), ctypes.c_long(n), _of(self._gain), _of(self._scale)
        )
        self.logdet += self._of_kinks

    @cached_property
    def _of_kinks(self) -> float:
        """What readings about a rest are worth, as if they were as expected."""
        return float(self.kinks.sum(axis=0) @ (1 + 2 * np.log(self.noise.readings)))

    @cached_property
    def _steps(self) -> np.ndarray:
        return steps(self.time, self.present)

    def disturbed(self, disturbance: Disturbance) -> Whitener:
        """The filter of the same run where other forces act that nobody recorded."""
        other = self._composed(disturbance)
        other._design()
        return other

    def _composed(self, disturbance: Disturbance) -> Whitener:
        """The same but for its gains, which are those of the forces that were."""
        steps, of_kinks = self._steps, self._of_kinks  # which both have
        other = object.__new__(Whitener)
        other.__dict__ = {**self.__dict__, "arrays": dict(self.arrays), "_steps": steps, "_of_kinks": of_kinks}
        other.__dict__.pop("spread", None)
        other._compose(disturbance)
        return other

    def __getstate__(self) -> dict[str, object]:
        return {name: value for name, value in self.__dict__.items() if name != "_filter"}  # addresses are of this process

    @cached_property
    def _filter(self) -> FilterRecord:
        return FilterRecord(*self.size, **{name: a.ctypes.data for name, a in self.arrays.items()})

    def __call__(self, signals: np.ndarray, start_mean: np.ndarray, *, in_place: bool = False) -> np.ndarray:
        """Innovations (n, nz, m) of signals (n, nz, m), which they may replace.

        The first signal is the residual, measured less simulated, and comes out NaN in gaps; the others are
        sensitivities, 0 there. `start_mean` (nx,) is where the true start is expected, less the simulated one.
        """
        out = np.asarray(signals, float, order="C") if in_place else np.array(signals, float, order="C")
        m = out.shape[2]
        mean = np.ascontiguousarray(start_mean, float)
        _library().wc_whiten(
            ctypes.byref(self._filter),
            ctypes.c_long(len(out)),
            _of(self._gain),
            _of(self._scale),
            _of(mean),
            ctypes.c_int(m),
            _of(out),
        )
        out.reshape(-1, m)[self._gaps, 0] = np.nan
        return out

    @cached_property
    def _gaps(self) -> np.ndarray:
        """Where among all readings none was taken."""
        return np.flatnonzero(~self.present)

    def response(self, change: np.ndarray) -> np.ndarray:
        """Readings (n, nz) that recorded pushes (n, nq) add if they are larger by `change`, to first order."""
        return self._responses(change)[1]

    def states(self, change: np.ndarray) -> np.ndarray:
        """What such a `change` adds to the states (n, nx)."""
        return self._responses(change)[0]

    def _responses(self, change: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        n, (nx, nq, nz) = len(change), self.size
        pushed, states, readings = np.zeros((n, nq)), np.empty((n, nx)), np.empty((n, nz))
        pushed[:, : self.recorded] = change
        _library().wc_respond(ctypes.byref(self._filter), ctypes.c_long(n), *map(_of, (pushed, states, readings)))
        return states, readings

    def smoothed(self, innovations: np.ndarray) -> np.ndarray:
        """A disturbance's forces (n, d), as all readings have them, from the innovations (n, nz) of residuals."""
        return self._noise(innovations)[:, self.recorded :]

    def _noise(self, innovations: np.ndarray) -> np.ndarray:
        """Errors of the recorded pushes, and forces, together (n, nq)."""
        told = np.ascontiguousarray(np.nan_to_num(innovations), float)
        noise = np.empty((len(told), self.size[1]))
        _library().wc_smooth(
            ctypes.byref(self._filter), ctypes.c_long(len(told)), _of(self._gain), _of(self._scale), _of(told), _of(noise)
        )
        return noise

    @cached_property
    def spread(self) -> np.ndarray:
        """(n, nz) one over the standard deviation of each reading round a simulation from the right start: sensor noise,
        and push noise as it adds up. A body that swings at the start is as far off then as later: the simulation, which does
        not know it, begins at the speed of both."""
        certain, scale = np.zeros_like(self.noise.start), np.empty(self.present.shape)
        from_there = FilterRecord.from_buffer_copy(self._filter)
        from_there.start_cov = certain.ctypes.data
        _library().wc_spread(ctypes.byref(from_there), ctypes.c_long(len(scale)), _of(scale))
        return scale


class ByForces:
    """−2 log likelihood, but for a constant, of a residual (n, nz) of a filter's run by how strong forces are that nobody
    recorded; `start_mean` as in a call of the filter. To ask this needs no gains, which are most of what a filter is, and what
    `forces` do to the run is found once."""

    def __init__(self, filter_: Whitener, forces: Disturbance, residual: np.ndarray, start_mean: np.ndarray):
        self._composed = filter_._composed(forces)
        self._residual, self._start_mean = (np.ascontiguousarray(a, float) for a in (residual, start_mean))
        self._gap = np.diff(filter_.time)[:, None]

    def __call__(self, sd: np.ndarray, lasting: np.ndarray) -> float:
        """With forces of these standard deviations and times, as in a `Disturbance`."""
        sds, kept = (self._composed.arrays[name].copy() for name in ("input_sd", "input_phi"))
        unknown = slice(self._composed.recorded, None)
        sds[:, unknown] = sd
        kept[:, unknown] = np.exp(-self._gap / np.broadcast_to(lasting, sds[:, unknown].shape)[:-1])
        filter_ = FilterRecord.from_buffer_copy(self._composed._filter)
        filter_.input_sd, filter_.input_phi = sds.ctypes.data, kept.ctypes.data
        given = map(_of, (self._start_mean, self._residual))
        told = _library().wc_deviance(ctypes.byref(filter_), ctypes.c_long(len(sds)), *given)
        return float(told) + self._composed._of_kinks


def steps(time: np.ndarray, present: np.ndarray) -> np.ndarray:
    """Usual time (nz,) between the samples of each reading, from times (n,) and where each is `present` (n, nz)."""
    usual = float(np.median(np.diff(time)))
    own = (time[there] for there in present.T)
    return np.array([float(np.median(np.diff(t))) if len(t) > 1 else usual for t in own])


def noise_arrays(time: np.ndarray, noise: Noise, step: np.ndarray, unknown: Disturbance | None) -> dict[str, np.ndarray]:
    """What a `NoiseRecord` points to, but for places; `step` (nz,) is the time between the samples of each reading."""
    none = Disturbance(np.empty(0), np.empty(0), np.empty((len(noise.pushes), 0)))
    forces = none if unknown is None else unknown
    push_step = noise.push_step if noise.push_step is not None else np.full(len(noise.pushes), np.median(np.diff(time)))
    arrays = {
        "time": time,
        "push_sd": noise.pushes,
        "push_ar": noise.push_colour,
        "push_step": push_step,
        "sd": noise.readings,
        "ar": noise.colour,
        "step": step,
        "unknown_sd": np.broadcast_to(forces.sd, (len(time), forces.count)),
        "lasting": np.broadcast_to(forces.lasting, (len(time), forces.count)),
        "together": np.eye(forces.count) if forces.common is None else forces.common,
        "as_push": forces.as_push,
        "as_reading": np.zeros((len(noise.readings), forces.count)) if forces.as_reading is None else forces.as_reading,
    }
    return {name: np.ascontiguousarray(a, float) for name, a in arrays.items()}


def _of(array: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)
