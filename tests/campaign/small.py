"""Parts of small campaigns: what they say, how they move, how they are written down."""

from __future__ import annotations

import numpy as np

SI = ("time [s]", "F_rl [N]", "F_rr [N]", "wheel_speed_l [m/s]", "wheel_speed_r [m/s]", "yaw_rate [rad/s]", "a_y [m/s2]")
HEAD = '[campaign]\nname = "small"\naxes = "SAE-J670"\n[chair]\nm = 80.0\n'
NOISE = "[noise]\nF_rl = 0.4\nF_rr = 0.4\nwheel_speed_l = 0.01\nwheel_speed_r = 0.01\nyaw_rate = 0.006\na_y = 0.05\n"
RUNS = (
    '[[run]]\nfile = "a.csv"\nmanoeuvre = "slalom"\nrole = "fit"\nu0 = 1.0\n'
    '[[run]]\nfile = "b.csv"\nmanoeuvre = "slalom"\nrole = "holdout"\nu0 = 1.0\n'
)


def motion(n: int = 200, seed: int = 0) -> np.ndarray:
    """A smooth invented motion with noise, (n, 7), in the order of SI."""
    t = np.arange(n) * 0.01
    rng = np.random.default_rng(seed)
    push, yaw_rate = 5 + 3 * np.sin(2 * t), 0.3 * np.sin(2 * t)
    clean = [push, push, 1 + 0.25 * yaw_rate, 1 - 0.25 * yaw_rate, yaw_rate, yaw_rate]
    sd = (0.4, 0.4, 0.01, 0.01, 0.006, 0.05)
    return np.column_stack([t, *(c + s * rng.standard_normal(n) for c, s in zip(clean, sd, strict=True))]).round(6)


def rows(data: np.ndarray) -> list[list[str]]:
    return [[f"{value:.10g}" for value in row] for row in data]


def csv_text(headers: tuple[str, ...] | list[str], cells: list[list[str]], separator: str = ",") -> str:
    return "\n".join(separator.join(row) for row in [list(headers), *cells]) + "\n"
