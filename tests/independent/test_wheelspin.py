"""Spinning wheels against Coulomb's friction to the letter: a wheel rolls or it slides, and never both, straight ahead."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.model.choice import Choice
from wheelchair_fmu.model.variant import Variant

M, G, A, B, R, INERTIA = 80.0, 9.81, 0.25, 0.20, 0.31, 0.14
AXLE, SPUN = M * G * A / (A + B), 2 * INERTIA / R**2  # load and spin, as mass, of both rear wheels together
TIME = np.linspace(0, 4, 401)
STILL = {"resistance.f_r": 0.0, "resistance.f_f": 0.0, "tyre.C_kappa": 1e6}


def coulomb(push: np.ndarray, brake: np.ndarray, mu: float, u: float, h: float = 1e-5) -> tuple[np.ndarray, np.ndarray]:
    """Speeds of the chair and of its rims, by impulses: each short while the patch, then the brake, takes away the whole of the
    speed at which it slides, or as much as its friction can."""
    rim, told = u, []
    every = round((TIME[1] - TIME[0]) / h)
    for now, then, on, off in zip(push[:-1], push[1:], brake[:-1], brake[1:], strict=True):
        told.append((u, rim))
        for i in range(every):
            share = (i + 0.5) / every
            rim += h * (now + share * (then - now)) / SPUN
            most = h * (on + share * (off - on)) / SPUN
            rim -= min(max(rim, -most), most) if most else 0.0
            impulse = (rim - u) / (1 / M + 1 / SPUN)
            impulse = min(max(impulse, -mu * AXLE * h), mu * AXLE * h)
            u, rim = u + impulse / M, rim - impulse / SPUN
    told.append((u, rim))
    u_told, rim_told = np.array(told).T
    return u_told, rim_told


CASES = {
    "spun up and let go": (np.interp(TIME, [0, 0.5, 1.5, 1.6], [0, 300, 300, 0]), 0 * TIME, 0.3),
    "to and fro on ice": (250 * np.sin(3 * TIME), 0 * TIME, 0.15),
    "locked and let go": (0 * TIME, np.interp(TIME, [0.5, 0.6, 1.0, 1.1], [0, 600, 600, 0]), 0.3),
    "pushed on its brakes": (np.interp(TIME, [0, 2, 4], [0, 260, 0]), 0 * TIME + 120, 0.25),
}


@pytest.mark.parametrize(("push", "brake", "mu"), CASES.values(), ids=CASES)
def test_chair_and_rims_go_as_coulomb_says(push, brake, mu):
    chair = Simulator(Variant(Choice(wheel="spinning")).with_values({**STILL, "tyre.mu": mu, "brake.F_max": 1000.0}))
    halves = {f"push.F_r{side}": push / 2 for side in "lr"} | {f"brake.r{side}": brake / 2000 for side in "lr"}
    found = chair.run(TIME, chair.inputs(len(TIME), halves), tolerance=1e-8)
    u, rim = coulomb(push, brake, mu, 1.0)
    assert np.abs(rim - u).max() > 0.5  # it slides
    np.testing.assert_allclose(found["chair.u"], u, atol=0.01 * np.ptp(u))
    np.testing.assert_allclose(found["sensor.wheel_speed_l"], rim, atol=0.02 * np.ptp(rim))
