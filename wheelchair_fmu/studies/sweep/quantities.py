"""What a sweep keeps of a run: a handful of numbers, SI units."""

from __future__ import annotations

from collections.abc import Mapping
from math import inf, nan

import numpy as np

from ...handling.key_numbers import STRAIGHT

Columns = Mapping[str, np.ndarray]

QUANTITIES: dict[str, tuple[str, str]] = {  # name: unit, meaning
    "radius": ("m", "radius of curvature R_c at the end, positive to the right; infinite where straight"),
    "curvature": ("1/m", "1/R_c at the end"),
    "slip_peak_rl": ("rad", "greatest size of the slip angle, left rear tyre"),
    "slip_peak_rr": ("rad", "greatest size of the slip angle, right rear tyre"),
    "drift": ("m", "y at the end less y at the start: how far the chair went to the right"),
    "speed_end": ("m/s", "forward speed at the end"),
    "push_work": ("J", "work of the pushes on the wheels, with the total push that a held speed needs"),
    "lifted": ("1", "share of the samples at which a wheel has left the ground"),
    "rms": ("1", "whitened RMS error against the campaign; 1 is the noise floor"),
    "rms_fit": ("1", "the same over its fitted runs"),
    "rms_holdout": ("1", "the same over its held-out runs"),
}
READS = ("chair.y", "chair.u", "chair.psi_dot", "chair.curvature", "slip.rl", "slip.rr", "push.total_needed", "load.lifted")


def none(chairs: int) -> dict[str, np.ndarray]:
    """Each quantity of chairs that have none, (chairs,)."""
    return {name: np.full(chairs, nan) for name in QUANTITIES}


def of_runs(
    time: np.ndarray, inputs: Columns, results: np.ndarray, *, held: np.ndarray, tread: np.ndarray
) -> dict[str, np.ndarray]:
    """Numbers (chairs,) of one manoeuvre from its times (n,), inputs (n,) by FMI name and results (chairs, READS, n).

    `held` (chairs,): the speed is prescribed; `tread` (chairs,) is t_r [m].
    """
    y = dict(zip(READS, np.moveaxis(results, 1, 0), strict=True))
    last = y["chair.curvature"][:, -1].copy()  # what the results stand in serves the next runs, too
    bent = np.abs(last) > 1 / STRAIGHT
    return {
        **none(len(results)),
        "radius": np.divide(1, last, out=np.where(np.isnan(last), nan, inf), where=bent),
        "curvature": last,
        "slip_peak_rl": _greatest(y["slip.rl"]),
        "slip_peak_rr": _greatest(y["slip.rr"]),
        "drift": y["chair.y"][:, -1] - y["chair.y"][:, 0],
        "speed_end": y["chair.u"][:, -1].copy(),
        "push_work": _work(time, inputs, y, held, tread),
        "lifted": np.mean(y["load.lifted"], axis=1),
    }


def _greatest(y: np.ndarray) -> np.ndarray:
    """Size, of each row."""
    return np.maximum(y.max(axis=1), -y.min(axis=1))


def _work(time: np.ndarray, inputs: Columns, y: Columns, held: np.ndarray, tread: np.ndarray) -> np.ndarray:
    """∫ (F_rl v_rl + F_rr v_rr) dt with the wheels' speeds v = u ± ψ' t_r/2: total push times u and couple times ψ'."""
    left, right = inputs.get("push.F_rl", 0.0), inputs.get("push.F_rr", 0.0)
    total = np.where(held[:, None], y["push.total_needed"], np.add(left, right))
    couple = np.multiply.outer(tread / 2, np.subtract(left, right))
    couple = couple if couple.ndim == 2 else couple[:, None]
    return np.trapezoid(total * y["chair.u"] + couple * y["chair.psi_dot"], time, axis=1)
