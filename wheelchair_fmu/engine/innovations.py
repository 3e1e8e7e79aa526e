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
        *(
            (name, ctypes.c_void_p)
            for name in ("A", "B", "C", "H", "D", "input_sd", "input_phi", "sd", "phi", "start_cov", "present", "common")
        ),
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
    over which it is forgotten. `as_push` (nq, d) says as what change of the recorded pushes one unit of each acts, `common`
    (d, d) how they are correlated at one moment: two that one white noise drives have 2 √(T₁ T₂) / (T₁ + T₂). Without it, each
    is on its own."""

    sd: np.ndarray
    lasting: np.ndarray
    as_push: np.ndarray
    common: np.ndarray | None = None


@cache
def _library() -> ctypes.CDLL:
    library = helper("innovations")
    library.wc_design.restype = ctypes.c_double
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
        self.present, self.noise = present, noise
        n, nz = present.shape
        at = list(range(len(noise.pushes)) if pushes is None else pushes)
        nx, nq = run.transition.shape[1], len(at)
        self.time = run.time
        if nx + nq + nz > MOST:
            raise ValueError(f"{nx} states, {nq} pushes and {nz} readings are more than {MOST}")
        push_sd, push_phi = _by_push(run.time, noise)
        arrays = {
            "A": run.transition,
            "B": run.push_before[:, :, at],
            "C": run.push_after[:, :, at],
            "H": run.by_state[:, which],
            "D": run.by_push[:, which][:, :, at],
            "input_sd": push_sd,
            "input_phi": push_phi,
            "sd": noise.readings,
            "phi": _by_interval(run.time, noise.colour, steps(run.time, present)),
            "start_cov": noise.start,
            "common": np.eye(nq),
        }
        self.arrays = {name: np.ascontiguousarray(a, float) for name, a in arrays.items()}
        self.arrays["present"] = np.ascontiguousarray(present, np.int8)
        self.size, self.recorded = (nx, nq, nz), nq
        if speeds:
            dt = float(np.median(np.diff(run.time)))
            _library().wc_drop_kinks(ctypes.byref(self._filter), ctypes.c_long(n), ctypes.c_double(dt), *speeds)
        self.kinks = present & (self.arrays["present"] == 0)
        if disturbance is not None:
            self._disturb(disturbance)
        self._design()

    def _design(self) -> None:
        n, nz = self.present.shape
        self._gain, self._scale = np.empty((n, nz, sum(self.size))), np.empty((n, nz))
        self.logdet: float = _library().wc_design(
            ctypes.byref(self._filter), ctypes.c_long(n), _of(self._gain), _of(self._scale)
        )
        self.logdet += float(self.kinks.sum(axis=0) @ (1 + 2 * np.log(self.noise.readings)))

    def _disturb(self, unknown: Disturbance) -> None:
        """Let forces act that nobody recorded, in the place of any that did before."""
        recorded = {name: self.arrays[name][..., : self.recorded] for name in ("B", "C", "D", "input_sd", "input_phi")}
        further = {name: recorded[name] @ unknown.as_push for name in ("B", "C", "D")}
        further["input_sd"] = np.tile(unknown.sd, (len(self.time), 1))
        further["input_phi"] = np.exp(-np.diff(self.time)[:, None] / unknown.lasting)
        both = {name: np.concatenate((recorded[name], further[name]), axis=-1) for name in recorded}
        both["common"] = np.eye(self.recorded + len(unknown.sd))
        both["common"][self.recorded :, self.recorded :] = np.eye(len(unknown.sd)) if unknown.common is None else unknown.common
        self.arrays |= {name: np.ascontiguousarray(a) for name, a in both.items()}
        self.size = (self.size[0], self.recorded + len(unknown.sd), self.size[2])
        if sum(self.size) > MOST:
            raise ValueError(f"{sum(self.size)} states, pushes, disturbances and readings are more than {MOST}")

    def disturbed(self, disturbance: Disturbance) -> Whitener:
        """The filter of the same run where other forces act that nobody recorded."""
        other = object.__new__(Whitener)
        other.__dict__ = {**self.__dict__, "arrays": dict(self.arrays)}
        other.__dict__.pop("spread", None)
        other._disturb(disturbance)
        other._design()
        return other

    @property
    def _filter(self) -> _Filter:
        return _Filter(*self.size, **{name: a.ctypes.data for name, a in self.arrays.items()})

    def __call__(self, signals: np.ndarray, start_mean: np.ndarray, *, in_place: bool = False) -> np.ndarray:
        """Innovations (n, nz, m) of signals (n, nz, m), which they may replace.

        The first signal is the residual, measured less simulated, and comes out NaN in gaps; the others are
        sensitivities, 0 there. `start_mean` (nx,) is where the true start is expected, less the simulated one.
        """
        out = np.asarray(signals, float, order="C") if in_place else np.array(signals, float, order="C")
        m = out.shape[2]
        mean, work = np.ascontiguousarray(start_mean, float), np.empty(2 * self._gain.shape[2] * m)
        _library().wc_whiten(
            ctypes.byref(self._filter),
            ctypes.c_long(len(out)),
            _of(self._gain),
            _of(self._scale),
            _of(mean),
            ctypes.c_int(m),
            _of(out),
            _of(work),
        )
        out[~self.present, 0] = np.nan
        return out

    def response(self, change: np.ndarray) -> np.ndarray:
        """Readings (n, nz) that recorded pushes (n, nq) add if they are larger by `change`, to first order."""
        pushed, out = np.zeros((len(change), self.size[1])), np.empty(self.present.shape)
        pushed[:, : self.recorded] = change
        _library().wc_respond(ctypes.byref(self._filter), ctypes.c_long(len(out)), _of(pushed), _of(out))
        return out

    def smoothed(self, innovations: np.ndarray) -> np.ndarray:
        """A disturbance's forces (n, d), as all readings have them, from the innovations (n, nz) of residuals."""
        return self._smoothed(innovations)[:, self.recorded :]

    def smoothed_pushes(self, innovations: np.ndarray) -> np.ndarray:
        """The errors (n, nq) of the recorded pushes, likewise."""
        return self._smoothed(innovations)[:, : self.recorded]

    def _smoothed(self, innovations: np.ndarray) -> np.ndarray:
        told = np.ascontiguousarray(np.nan_to_num(innovations), float)
        noise = np.empty((len(told), self.size[1]))
        _library().wc_smooth(
            ctypes.byref(self._filter), ctypes.c_long(len(told)), _of(self._gain), _of(self._scale), _of(told), _of(noise)
        )
        return noise

    def unlikely(self, off: np.ndarray, pushed: np.ndarray) -> float:
        """−2 log probability, but for a constant, that readings are `off` (n, nz) by their own noise and the recorded pushes by
        `pushed` (n, nq)."""
        readings = np.where(self.arrays["present"] > 0, off / self.noise.readings, np.nan)
        pushes = pushed / self.arrays["input_sd"][:, : self.recorded]
        return _fresh(readings, self.arrays["phi"]) + _fresh(pushes, self.arrays["input_phi"][:, : self.recorded])

    @cached_property
    def spread(self) -> np.ndarray:
        """(n, nz) one over the standard deviation of each reading round a simulation from the right start: sensor noise,
        and push noise as it adds up."""
        certain, scale = np.zeros_like(self.noise.start), np.empty(self.present.shape)
        from_there = self._filter
        from_there.start_cov = certain.ctypes.data
        _library().wc_spread(ctypes.byref(from_there), ctypes.c_long(len(scale)), _of(scale))
        return scale


def _fresh(noise: np.ndarray, phi: np.ndarray) -> float:
    """Σ of squares of what is new in AR(1) noise (n, m) of unit variance, with NaN in gaps, after which all counts as new."""
    before = np.nan_to_num(noise[:-1])
    again = np.where(np.isfinite(noise[:-1]), phi, 0.0)
    new = (noise[1:] - again * before) / np.sqrt(1 - again**2)
    return float(np.nansum(noise[0] ** 2) + np.nansum(new**2))


def steps(time: np.ndarray, present: np.ndarray) -> np.ndarray:
    """Usual time (nz,) between the samples of each reading, from times (n,) and where each is `present` (n, nz)."""
    usual = float(np.median(np.diff(time)))
    own = (time[there] for there in present.T)
    return np.array([float(np.median(np.diff(t))) if len(t) > 1 else usual for t in own])


def _by_interval(time: np.ndarray, colour: np.ndarray, step: np.ndarray) -> np.ndarray:
    """AR(1) coefficients (n−1, m) over each interval between rows, from those over each series' own step (m,).

    Rows belong to several loggers, so most intervals are shorter than a series' own step.
    """
    return np.where(colour > 0, np.maximum(colour, 1e-300) ** (np.diff(time)[:, None] / step), 0.0)


def _by_push(time: np.ndarray, noise: Noise) -> tuple[np.ndarray, np.ndarray]:
    """Standard deviations (n, nq) of recorded pushes at each row, and their coefficients (n−1, nq) over each interval.

    What noise adds to the chair's momentum must not depend on how many rows lie between two samples of a push. In a time T
    that has a variance of σ² T h (1 + φ)/(1 − φ) for rows h apart, so σ goes with the rows' distance.
    """
    gaps = np.diff(time)
    around = np.concatenate((gaps[:1], (gaps[1:] + gaps[:-1]) / 2, gaps[-1:]))
    usual = np.full(len(noise.pushes), float(np.median(gaps)))
    own = usual if noise.push_step is None else noise.push_step
    phi = _by_interval(time, noise.push_colour, own)
    there = np.maximum(noise.push_colour, 0.0) ** (around[:, None] / own)
    lasting = own * (1 + noise.push_colour) / (1 - noise.push_colour)
    return noise.pushes * np.sqrt(lasting / (around[:, None] * (1 + there) / (1 - there))), phi


def _of(array: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)
