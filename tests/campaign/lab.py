"""A small lab: rides recorded by several loggers, each started by hand, each with axes and signs of its own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from .loggers import smartwheel, trc
from .riding import ride

RADIUS = 0.3  # m
G = 9.80665
IMU = [f"{name} {axis}" for name in ("Gyroscope", "Accelerometer") for axis in "XYZ"]
UNITS = {"Gyroscope": "deg/s", "Accelerometer": "g"}
AS_ISO = np.eye(3)
BACKWARDS = np.array([[0.0, -1, 0], [-1, 0, 0], [0, 0, -1]])  # sensor x to the right, y backwards, z down


def rides(seed: int = 0, runs: int = 3, seconds: float = 12.0) -> list[dict[str, np.ndarray]]:
    """What really happened in each run."""
    rng = np.random.default_rng(seed)
    found = []
    for _ in range(runs):
        s = ride(rng, seconds, until=seconds - 4)
        step = np.diff(s["t"], prepend=s["t"][0])
        for side in "lr":
            s[f"angle_{side}"] = np.cumsum(s[f"wheel_speed_{side}"] * step) / RADIUS
        s["yaw"] = np.cumsum(s["yaw_rate"] * step)
        s["x"], s["y"] = np.cumsum(s["u"] * np.cos(s["yaw"]) * step), np.cumsum(s["u"] * np.sin(s["yaw"]) * step)
        found.append(s)
    return found


def seen(s: dict[str, np.ndarray], rate: float, late: float, *names: str) -> list[np.ndarray]:
    """A logger's own time from 0, and what it samples, started `late` s after the ride's beginning at -3 s."""
    time = np.arange(0, s["t"][-1] - s["t"][0] - late - 1.0, 1 / rate)
    return [time, *(np.interp(time + s["t"][0] + late, s["t"], s[name]) for name in names)]


def rim(path: Path, s, late: float, side: str, rng, mirrored: bool = False) -> None:
    _, push, angle = seen(s, 240, late, f"F_r{side}", f"angle_{side}")
    sign = -1 if mirrored else 1
    torque = RADIUS * push + 0.3 + rng.normal(0, 0.15, len(push))
    smartwheel(path, sign * torque, (sign * np.degrees(angle) + 50) % 360)


def frame(
    path: Path, s, late: float, rng, axes: np.ndarray = AS_ISO, columns: list[str] | None = None, units: bool = True
) -> None:
    """An IMU on the frame, its axes the rows of `axes` in those of ISO 8855."""
    time, yaw_rate, u, a_x = seen(s, 100, late, "yaw_rate", "u", "a_x")
    zero = np.zeros_like(time)
    gyro = axes @ np.stack([zero, zero, -np.degrees(yaw_rate)])
    acc = axes @ np.stack([a_x / G, -u * yaw_rate / G, zero + 1.0])
    write(
        path,
        time,
        np.concatenate([gyro + rng.normal(0, 0.3, gyro.shape), acc + rng.normal(0, 0.01, acc.shape)]),
        columns,
        units,
    )


def spoke(path: Path, s, late: float, side: str, sign: float, rng) -> None:
    """An IMU on the spokes, its y along the axle; forward is `sign`."""
    time, angle, speed = seen(s, 100, late, f"angle_{side}", f"wheel_speed_{side}")
    zero = np.zeros_like(time)
    gyro = np.stack([zero, sign * np.degrees(speed) / RADIUS, zero]) + rng.normal(0, 0.3, (3, len(time)))
    acc = np.stack([np.cos(angle + 1), zero, sign * np.sin(angle + 1)]) + rng.normal(0, 0.02, (3, len(time)))
    write(path, time, np.concatenate([gyro, acc]))


def markers(path: Path, s, late: float, rng, left: str = "LHUB", right: str = "RHUB", more: tuple = ()) -> None:
    """Two hubs and the breast bone, in mm, y up, z to the left, the lane along -x."""
    _, x, y, yaw = seen(s, 150, late, "x", "y", "yaw")
    found = {}
    for name, out, up in ((left, -0.33, 0.3), (right, 0.33, 0.3), ("STERNUM", 0.05, 1.05), *((m, 0.0, 1.6) for m in more)):
        place = np.stack([-(x - out * np.sin(yaw)), np.full_like(x, up), -(y + out * np.cos(yaw))], axis=1)
        found[name] = 1000 * place + rng.normal(0, 0.4, place.shape)
    trc(path, 150, found)


def write(path: Path, time, values, columns: list[str] | None = None, units: bool = True) -> None:
    headers = [f"{c} ({UNITS[c.split()[0]]})" if units else c for c in columns or IMU]
    frame = pd.DataFrame({"Time (s)": time} | dict(zip(headers, values, strict=True)))
    frame.round(4).to_csv(path, index=False)
