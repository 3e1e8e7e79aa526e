"""Whiten residuals, and sensitivities with them, by a Kalman filter along a simulated run.

Noise of the recorded pushes is integrated by the chair into its speed, heading and position, so far
from the start residuals are large and strongly correlated although nothing is wrong. What is new in
each reading, given all before, is not: innovations in units of their own standard deviation are
independent with variance 1 if the model and the noise are right.
"""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from functools import cache

import numpy as np

from .cache import helper
from .sensitivities import Linearised

MOST = 64  # states, pushes and readings together, as in innovations.c


class _Filter(ctypes.Structure):
    _fields_ = (
        *((name, ctypes.c_int) for name in ("nx", "nq", "nz", "m")),
        *((name, ctypes.c_void_p)
          for name in ("A", "B", "C", "H", "D", "input_sd", "sd", "phi", "start_cov", "start_mean")),
        ("blind", ctypes.c_int),
    )  # fmt: skip


@dataclass(frozen=True)
class Noise:
    """What is known of the noise: standard deviations of pushes (nq,), readings (nz,) with the AR(1) coefficient
    of each (nz,), and the covariance of the start (nx, nx)."""

    pushes: np.ndarray
    readings: np.ndarray
    colour: np.ndarray
    start: np.ndarray


@cache
def _library() -> ctypes.CDLL:
    library = helper("innovations")
    library.wc_innovations.restype = ctypes.c_double
    return library


def whiten(
    signals: np.ndarray, run: Linearised, which: list[int], noise: Noise, start_mean: np.ndarray, *, blind: bool = False
) -> tuple[np.ndarray, float]:
    """Innovations (n, nz, m) of signals (n, nz, m), and Σ log of their variances.

    `run` is a `Linearised` run, `which` the places of its readings that were measured. The first signal is the
    residual, measured less simulated, NaN in gaps; the others are sensitivities. `start_mean` (nx,) is where the
    true start is expected, less the simulated one. `blind`: nothing is learnt from the readings, so that what comes out is
    each reading's own deviation in units of its standard deviation, far from the start as near it. Gaps
    come out as NaN in the first signal and 0 in the others.
    """
    n, nz, m = signals.shape
    nx, nq = run.transition.shape[1], len(noise.pushes)
    arrays = {"A": run.transition, "B": run.push_before[:, :, :nq], "C": run.push_after[:, :, :nq],
              "H": run.by_state[:, which], "D": run.by_push[:, which, :nq], "input_sd": noise.pushes,
              "sd": noise.readings, "phi": noise.colour, "start_cov": noise.start, "start_mean": start_mean}  # fmt: skip
    arrays = {name: np.ascontiguousarray(a, float) for name, a in arrays.items()}
    if nx + nq + nz > MOST:
        raise ValueError(f"{nx} states, {nq} pushes and {nz} readings are more than {MOST}")
    out = np.array(signals, float, order="C")
    gaps = np.isnan(out[:, :, 0])
    out[gaps, 1:] = 0
    work = np.empty(MOST * m)
    given = _Filter(nx, nq, nz, m, *(a.ctypes.data for a in arrays.values()), int(blind))
    total = _library().wc_innovations(ctypes.byref(given), ctypes.c_long(n), ctypes.c_void_p(out.ctypes.data),
                                      ctypes.c_void_p(work.ctypes.data))  # fmt: skip
    return out, total
