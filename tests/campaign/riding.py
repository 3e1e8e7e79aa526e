"""A chair on a straight lane or in turns, simulated as a rigid body, and noise that hangs together, for tests of clocks."""

from __future__ import annotations

import numpy as np
from scipy.signal import lfilter

STEP = 0.002  # s
MASS, INERTIA, TRACK, AHEAD = 90.0, 5.0, 0.56, 0.1


def coloured(rng: np.random.Generator, n: int, sd: float, a: float) -> np.ndarray:
    """First-order autoregressive noise (n,)."""
    white = rng.normal(size=n + 300) * sd * np.sqrt(1 - a * a)
    return lfilter([1.0], [1.0, -a], white)[300:]


def strokes(
    rng: np.random.Generator, seconds: float, regular: bool = False, start: float = 1.2
) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) from −3 s on and a push force (n,), N, first from a standstill; irregular as people are, or all alike."""
    t = np.arange(-3.0, seconds + 3.0, STEP)
    force = np.zeros(len(t))
    at = -3.0 if regular else start
    while at < seconds + 3:
        drawn = rng.uniform(0.25, 0.45), rng.uniform(35, 70), rng.uniform(0.8, 1.3)
        width, size, pause = (0.4, 60.0, 1.0) if regular else drawn
        on = (t > at) & (t < at + width)
        force[on] += size * np.sin(np.pi * (t[on] - at) / width)
        at += pause
    return t, force


def ride(rng: np.random.Generator, seconds: float, until: float = np.inf) -> dict[str, np.ndarray]:
    """True signals by quantity, and `t`: pushes on both sides that differ, the speed and the yaw rate that they make."""
    t, left = strokes(rng, seconds)
    share = 1 + 0.4 * np.sin(2 * np.pi * t / 5 + rng.uniform(0, 6))
    left, right = left * share * (t < until), left * (2 - share) * (t < until)
    u, r = np.zeros(len(t)), np.zeros(len(t))
    for i in range(len(t) - 1):
        drag = 10 * np.tanh(u[i] / 0.02) + 6 * u[i]
        u[i + 1] = u[i] + STEP * (left[i] + right[i] - drag) / MASS
        r[i + 1] = r[i] + STEP * (TRACK / 2 * (left[i] - right[i]) - 8 * r[i] - MASS * AHEAD * u[i] * r[i]) / INERTIA
    return {
        "t": t,
        "F_rl": left,
        "F_rr": right,
        "u": u,
        "yaw_rate": r,
        "wheel_speed_l": u + TRACK / 2 * r,
        "wheel_speed_r": u - TRACK / 2 * r,
        "a_x": np.gradient(u, t),
    }
