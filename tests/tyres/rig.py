"""A rig in few lines: tyres whose laws are known, measured with a curvature force and noise."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from wheelchair_fmu.tyres.records import CAMBER, SLIP, Condition, Sweep

SLIPS = np.array([0.25, 0.5, 0.75, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5])  # deg
LEANS = np.arange(1.0, 11.0)


def magic(x, B, C, D, E):
    """(1), written out once more."""
    return D * np.sin(C * np.arctan(B * x - E * (B * x - np.arctan(B * x))))


@dataclass
class Tyre:
    """Magic Formula for force and torque in the reference condition, camber linear; both scale with powers of p and N."""

    force: tuple = (8.4, 1.5, 400.0, 0.0)  # B, C, D, E: BCD = 5040 N/rad
    torque: tuple = (12.0, 2.2, -1.7, 0.2)  # BCD = −44.88 N m/rad
    C_phi: float = 464.0
    C_m_phi: float = 3.0
    pressure_F: float = 0.62
    pressure_M: float = -0.64
    load_F: float = 0.75
    load_M: float = 1.0
    curvature: float = 9.0
    rng: np.random.Generator = field(default_factory=lambda: np.random.default_rng(1))
    noise: tuple = (0.6, 0.02)  # N, N m

    def sweep(self, kind=SLIP, pressure=4.0, load=400.0, speed=4 / 3.6, angles=None, tyre="T"):
        sizes = (SLIPS if kind == SLIP else LEANS) if angles is None else np.asarray(angles, float)
        x = np.radians(np.r_[-sizes[::-1], 0, sizes])
        force, torque = self.curves(kind, x, pressure, load)
        n = self.rng.normal(size=(2, len(x)))
        return Sweep(
            Condition(tyre, pressure, load, speed),
            kind,
            x,
            force + self.curvature + self.noise[0] * n[0],
            torque - 0.12 + self.noise[1] * n[1],
        )

    def curves(self, kind, x, pressure=4.0, load=400.0):
        p, m = pressure / 4, load / 400
        if kind == CAMBER:
            return self.C_phi * m * x, self.C_m_phi * m * x
        B, C, D, E = self.force
        K = p**self.pressure_F * m**self.load_F
        F = magic(x, B * K / m, C, D * m, E)
        B, C, D, E = self.torque
        M = magic(x, B, C, D * p**self.pressure_M * m**self.load_M, E)
        return F, M
