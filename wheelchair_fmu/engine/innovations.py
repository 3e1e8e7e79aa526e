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

from .cache import helper
from .sensitivities import Linearised

MOST = 64  # states, pushes and readings together, as in innovations.c


class _Filter(ctypes.Structure):
    _fields_ = (
        *((name, ctypes.c_int) for name in ("nx", "nq", "nz")),
        *((name, ctypes.c_void_p)
          for name in ("A", "B", "C", "H", "D", "input_sd", "input_phi", "sd", "phi", "start_cov", "present")),
    )  # fmt: skip


@dataclass(frozen=True)
class Noise:
    """What is known of the noise: standard deviations of pushes (nq,) and readings (nz,), the AR(1) coefficients of each
    (nq,) and (nz,), and the covariance of the start (nx, nx)."""

    pushes: np.ndarray
    push_colour: np.ndarray
    readings: np.ndarray
    colour: np.ndarray
    start: np.ndarray


@cache
def _library() -> ctypes.CDLL:
    library = helper("innovations")
    library.wc_design.restype = ctypes.c_double
    return library


class Whitener:
    """The filter of one run: `run` its linearisation, `which` the places of its readings that were measured,
    `present` (n, nz) False in gaps. `logdet` is Σ log of the innovations' variances.

    Readings about the moment a chair comes to rest, which no slope foretells (`kinks`; see wc_drop_kinks in innovations.c),
    tell nothing: they are 0, and in `logdet` as if they were as expected. `speeds` are the places of u and v among the states.
    """

    def __init__(self, run: Linearised, which: list[int], noise: Noise, present: np.ndarray, speeds: Sequence[int] = ()):
        self.present, self.noise = present, noise
        n, nz = present.shape
        nx, nq = run.transition.shape[1], len(noise.pushes)
        if nx + nq + nz > MOST:
            raise ValueError(f"{nx} states, {nq} pushes and {nz} readings are more than {MOST}")
        arrays = {"A": run.transition, "B": run.push_before[:, :, :nq], "C": run.push_after[:, :, :nq],
                  "H": run.by_state[:, which], "D": run.by_push[:, which, :nq],
                  "input_sd": noise.pushes, "input_phi": noise.push_colour, "sd": noise.readings, "phi": noise.colour,
                  "start_cov": noise.start}  # fmt: skip
        self._arrays = {name: np.ascontiguousarray(a, float) for name, a in arrays.items()}
        self._arrays["present"] = np.ascontiguousarray(present, np.int8)
        self._size = (nx, nq, nz)
        if speeds:
            dt = float(np.median(np.diff(run.time)))
            _library().wc_drop_kinks(ctypes.byref(self._filter), ctypes.c_long(n), ctypes.c_double(dt), *speeds)
        self.kinks = present & (self._arrays["present"] == 0)
        self._gain, self._scale = np.empty((n, nz, nx + nq + nz)), np.empty((n, nz))
        self.logdet: float = _library().wc_design(ctypes.byref(self._filter), ctypes.c_long(n), _of(self._gain),
                                                  _of(self._scale))  # fmt: skip
        self.logdet += float(self.kinks.sum(axis=0) @ (1 + 2 * np.log(noise.readings)))

    @property
    def _filter(self) -> _Filter:
        return _Filter(*self._size, **{name: a.ctypes.data for name, a in self._arrays.items()})

    def __call__(self, signals: np.ndarray, start_mean: np.ndarray, *, in_place: bool = False) -> np.ndarray:
        """Innovations (n, nz, m) of signals (n, nz, m), which they may replace.

        The first signal is the residual, measured less simulated, and comes out NaN in gaps; the others are
        sensitivities, 0 there. `start_mean` (nx,) is where the true start is expected, less the simulated one.
        """
        out = np.asarray(signals, float, order="C") if in_place else np.array(signals, float, order="C")
        m = out.shape[2]
        mean, work = np.ascontiguousarray(start_mean, float), np.empty(2 * self._gain.shape[2] * m)
        _library().wc_whiten(ctypes.byref(self._filter), ctypes.c_long(len(out)), _of(self._gain), _of(self._scale),
                             _of(mean), ctypes.c_int(m), _of(out), _of(work))  # fmt: skip
        out[~self.present, 0] = np.nan
        return out

    def response(self, change: np.ndarray) -> np.ndarray:
        """Readings (n, nz) that recorded pushes (n, nq) add if they are larger by `change`, to first order."""
        pushed, out = np.ascontiguousarray(change, float), np.empty(self.present.shape)
        _library().wc_respond(ctypes.byref(self._filter), ctypes.c_long(len(out)), _of(pushed), _of(out))
        return out

    @cached_property
    def spread(self) -> np.ndarray:
        """(n, nz) one over the standard deviation of each reading round a simulation from the right start: sensor noise,
        and push noise as it adds up."""
        certain, scale = np.zeros_like(self.noise.start), np.empty(self.present.shape)
        from_there = self._filter
        from_there.start_cov = certain.ctypes.data
        _library().wc_spread(ctypes.byref(from_there), ctypes.c_long(len(scale)), _of(scale))
        return scale


def _of(array: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)
