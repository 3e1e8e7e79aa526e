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
NONE = dict.fromkeys(QUANTITIES, nan)


def of_run(time: np.ndarray, inputs: Columns, y: Columns, *, held: bool, tread: float) -> dict[str, float]:
    """Numbers of one manoeuvre from its times (n,), inputs (n,) and results (n,) by FMI name.

    `held`: the speed is prescribed; `tread` is t_r [m].
    """
    last = float(y["chair.curvature"][-1])
    return {
        **NONE,
        "radius": 1 / last if abs(last) > 1 / STRAIGHT else inf,
        "curvature": last,
        "slip_peak_rl": float(np.abs(y["slip.rl"]).max()),
        "slip_peak_rr": float(np.abs(y["slip.rr"]).max()),
        "drift": float(y["chair.y"][-1] - y["chair.y"][0]),
        "speed_end": float(y["chair.u"][-1]),
        "push_work": _work(time, inputs, y, held, tread),
        "lifted": float(np.mean(y["load.lifted"])),
    }


def _work(time: np.ndarray, inputs: Columns, y: Columns, held: bool, tread: float) -> float:
    """∫ (F_rl v_rl + F_rr v_rr) dt with the wheels' speeds v = u ± ψ' t_r/2: total push times u and couple times ψ'."""
    left, right = inputs.get("push.F_rl", 0.0), inputs.get("push.F_rr", 0.0)
    total = y["push.total_needed"] if held else np.add(left, right)
    couple = np.subtract(left, right) * tread / 2
    return float(np.trapezoid(total * y["chair.u"] + couple * y["chair.psi_dot"], time))
