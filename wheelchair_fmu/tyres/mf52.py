"""The Magic Formula as tyre property files have it: MF 5.2 (PAC2002, FITTYP 6), steady pure side slip with camber.

Equations after Pacejka, Tire and Vehicle Dynamics, section 4.3, with the coefficients' names in the files. Axes are those of
the file: ISO's W-axes where PKY1 is negative. A coefficient that a file leaves out is zero, a scaling factor one.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

NEEDED = ("FNOMIN", "UNLOADED_RADIUS", "PCY1", "PDY1", "PKY1", "PKY2")
ALIGNING = ("QBZ1", "QCZ1", "QDZ1")  # without them a file has no torque
SHAPED = ("LFZO", "LCY", "LMUY", "LEY", "LKY", "LHY", "LVY", "LGAY", "LTR", "LRES", "LGAZ")


class Mf52:
    """A tyre by its coefficients."""

    def __init__(self, coefficients: Mapping[str, float]):
        self.c = {**dict.fromkeys(SHAPED, 1.0), **coefficients}

    def __getitem__(self, name: str) -> float:
        return self.c.get(name, 0.0)

    def _dfz(self, Fz: np.ndarray) -> np.ndarray:
        nominal = self["FNOMIN"] * self["LFZO"]
        return (Fz - nominal) / nominal

    def stiffness(self, Fz: np.ndarray, gamma: np.ndarray) -> np.ndarray:
        """Cornering stiffness dF_y/dα [N/rad] at loads [N] and camber angles [rad]."""
        rise = np.sin(2 * np.arctan(Fz / (self["PKY2"] * self["FNOMIN"] * self["LFZO"])))
        return self["PKY1"] * self["FNOMIN"] * rise * (1 - self["PKY3"] * np.abs(gamma)) * self["LFZO"] * self["LKY"]

    def forces(self, alpha: np.ndarray, gamma: np.ndarray, Fz: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """F_y [N] and M_z [N m], (n,) each, at slip and camber angles (n,) rad and loads (n,) N."""
        d, K = self._dfz(Fz), self.stiffness(Fz, gamma)
        leaned = gamma * self["LGAY"]
        SH = (self["PHY1"] + self["PHY2"] * d) * self["LHY"] + self["PHY3"] * leaned
        SV = Fz * ((self["PVY1"] + self["PVY2"] * d) * self["LVY"] + (self["PVY3"] + self["PVY4"] * d) * leaned) * self["LMUY"]
        a = alpha + SH
        C = self["PCY1"] * self["LCY"]
        D = (self["PDY1"] + self["PDY2"] * d) * (1 - self["PDY3"] * leaned**2) * self["LMUY"] * Fz
        E = (self["PEY1"] + self["PEY2"] * d) * (1 - (self["PEY3"] + self["PEY4"] * leaned) * np.sign(a)) * self["LEY"]
        B = K / (C * D)
        Fy = D * np.sin(C * np.arctan(_bent(B * a, np.minimum(E, 1)))) + SV
        residual = self._residual(alpha + SH + SV / K, gamma, Fz, d, B * C) * np.cos(alpha)
        return Fy, -self.trail(alpha, gamma, Fz) * Fy + residual

    def trail(self, alpha: np.ndarray, gamma: np.ndarray, Fz: np.ndarray) -> np.ndarray:
        """Pneumatic trail t [m]."""
        d, leaned = self._dfz(Fz), gamma * self["LGAZ"]
        a = alpha + self["QHZ1"] + self["QHZ2"] * d + (self["QHZ3"] + self["QHZ4"] * d) * leaned
        B = (self["QBZ1"] + self["QBZ2"] * d + self["QBZ3"] * d**2) * self["LKY"] / self["LMUY"]
        B = B * (1 + self["QBZ4"] * leaned + self["QBZ5"] * np.abs(leaned))
        C = self["QCZ1"]
        peak = (self["QDZ1"] + self["QDZ2"] * d) * (1 + self["QDZ3"] * leaned + self["QDZ4"] * leaned**2) * self["LTR"]
        D = Fz * peak * self["UNLOADED_RADIUS"] / self["FNOMIN"]
        skew = 1 + (self["QEZ4"] + self["QEZ5"] * leaned) * 2 / np.pi * np.arctan(B * C * a)
        E = (self["QEZ1"] + self["QEZ2"] * d + self["QEZ3"] * d**2) * skew
        return D * np.cos(C * np.arctan(_bent(B * a, np.minimum(E, 1)))) * np.cos(alpha)

    def _residual(self, a: np.ndarray, gamma: np.ndarray, Fz: np.ndarray, d: np.ndarray, BC: np.ndarray) -> np.ndarray:
        leaned = gamma * self["LGAZ"]
        D = (self["QDZ6"] + self["QDZ7"] * d) * self["LRES"] + (self["QDZ8"] + self["QDZ9"] * d) * leaned
        B = self["QBZ9"] * self["LKY"] / self["LMUY"] + self["QBZ10"] * BC
        return Fz * D * self["UNLOADED_RADIUS"] * self["LMUY"] * np.cos(np.arctan(B * a))


def _bent(z: np.ndarray, E: np.ndarray) -> np.ndarray:
    return z - E * (z - np.arctan(z))
