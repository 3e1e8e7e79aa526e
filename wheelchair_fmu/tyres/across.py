"""One law across load and pressure:  K = K₀ (p / p₀)^n (N / N₀)^m  for each stiffness of a tyre.

n feeds `tyre.pressure_F` and `tyre.pressure_M`, which the effect `inflation_pressure` reads, and m the exponents of the effect
`load_sensitivity`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..model.effects.load_sensitivity import REFERENCE
from ..model.tyre.common import RATED
from .fitting import Estimate, estimate, positive
from .records import CAMBER, KM_H, SLIP

if TYPE_CHECKING:
    from .identify import ConditionFit

STIFFNESSES = {
    "C_lambda": (SLIP, "force", 1.0),
    "C_m_lambda": (SLIP, "torque", -1.0),  # (15): M = −C_mλ λ
    "C_phi": (CAMBER, "force", 1.0),
    "C_m_phi": (CAMBER, "torque", 1.0),
}
REFERENCES = {"pressure": RATED, "load": REFERENCE.default, "speed": 4 * KM_H}  # bar, N, m/s
ENOUGH = 1000  # degrees of freedom of the noise are many: each stiffness brings its own error


@dataclass(frozen=True)
class PowerLaw:
    """K₀ in SI units, an exponent for each of the REFERENCES that the tests varied, and where K₀ holds.

    `at` are the REFERENCES for what was varied, and else what was tested.
    """

    K: Estimate
    exponents: Mapping[str, Estimate]
    at: Mapping[str, float]


@dataclass(frozen=True)
class Across:
    """The laws of one tyre by stiffness, and by how much speed mattered: its exponents, which the laws leave out."""

    laws: Mapping[str, PowerLaw]
    speed: Mapping[str, Estimate]


def stiffness(fit: ConditionFit, name: str) -> Estimate | None:
    """A stiffness with the sign that (13)–(16) give it."""
    kind, channel, sign = STIFFNESSES[name]
    K = fit.K(kind, channel)
    return None if K is None else K.scaled(sign)


def across(fits: Sequence[ConditionFit]) -> dict[str, Across]:
    """The laws of every tyre that was tested."""
    found = {}
    for tyre in dict.fromkeys(f.condition.tyre for f in fits):
        own = [f for f in fits if f.condition.tyre == tyre]
        laws, speed = {}, {}
        for name in STIFFNESSES:
            if (law := _law(own, name, ("pressure", "load"))) is not None:
                laws[name] = law
            fast = _law(own, name, ("pressure", "load", "speed"))
            if fast is not None and "speed" in fast.exponents:
                speed[name] = fast.exponents["speed"]
        found[tyre] = Across(laws, speed)
    return found


def _law(fits: Sequence[ConditionFit], name: str, over: Sequence[str]) -> PowerLaw | None:
    """ln K = ln K₀ + Σ exponent · ln ratio, by weighted least squares; None where no slope is told from zero."""
    rows = [(f.condition, K) for f in fits if (K := stiffness(f, name)) and K.low is not None and K.low > 0]
    if not rows:
        return None
    logs = {w: np.log([getattr(c, w) / REFERENCES[w] for c, _ in rows]) for w in over}
    varied = [w for w in over if np.ptp(logs[w]) > 1e-9]
    A = np.column_stack([np.ones(len(rows)), *(logs[w] for w in varied)])
    if np.linalg.matrix_rank(A) < A.shape[1]:
        return None
    values = np.array([k.value for _, k in rows])
    weight = values / np.array([float(k.se or np.inf) for _, k in rows])
    z, *_ = np.linalg.lstsq(A * weight[:, None], np.log(values) * weight, rcond=None)
    spare = len(rows) - A.shape[1]
    left = float(np.sum(((A @ z - np.log(values)) * weight) ** 2))
    S = np.linalg.inv((A * weight[:, None]).T @ (A * weight[:, None])) * max(1.0, left / spare if spare else 1.0)
    exponents = {w: estimate(float(z[i]), float(S[i, i]), ENOUGH) for i, w in enumerate(varied, start=1)}
    at = {w: REFERENCES[w] if w in varied else getattr(rows[0][0], w) for w in over}
    return PowerLaw(positive(float(z[0]), float(S[0, 0]), ENOUGH), exponents, at)
