"""What a rig measures: sweeps of one angle, all else held."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SLIP, CAMBER = "side slip", "camber"
KINDS = (SLIP, CAMBER)
SAE, ISO = "sae", "iso"  # y to the right, z down | y to the left, z up
KM_H = 1 / 3.6  # m/s


@dataclass(frozen=True, order=True)
class Condition:
    """One tyre as it was tested: inflation pressure [bar], vertical load [N], speed of the disc [m/s]."""

    tyre: str
    pressure: float
    load: float
    speed: float

    def __str__(self) -> str:
        return f"tyre {self.tyre}, {self.pressure:g} bar, {self.load:g} N, {self.speed / KM_H:.3g} km/h"


@dataclass(frozen=True, eq=False)
class Sweep:
    """Steady lateral force and torque about the vertical over an angle, as the rig gives them.

    `angle` (n,) rad is the slip angle λ or the camber angle φ, after `kind`; `force` (n,) N; `torque` (n,) N m.
    """

    condition: Condition
    kind: str
    angle: np.ndarray
    force: np.ndarray
    torque: np.ndarray
