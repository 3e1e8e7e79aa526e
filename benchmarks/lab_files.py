"""The raw files of the lab folders as signals: what a bench and tests need of them, not a reader for others."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.io import loadmat

from wheelchair_fmu.campaign.clocks.signals import Signal, rate

RADIUS, DEG = 0.306, np.pi / 180


def signals(folder: Path, run: str) -> list[Signal]:
    """All signals of one run, one device per file, named as the file."""
    return [s for file in sorted(folder.glob(f"{run}[._]*")) for s in _file(file)]


def angle(folder: Path, run: str, side: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Time, forward torque (N m) and wheel angle (rad, unwrapped, as the instrument counts it) of a push rim, (n,) each."""
    if folder.name == "lab-00":
        return _smartwheel(folder / f"{run}_SW{side[0].upper()}.csv")
    if folder.name == "lab-01" and side == "left":
        return _smartwheel(folder / f"{run}_smartwheel_left.csv")
    return _optipush(folder / f"{run}_optipush_right.txt")


def _file(file: Path) -> Iterator[Signal]:
    name = file.name
    if name.endswith(".trc"):
        yield from _markers(file)
    elif "SWL" in name or "SWR" in name or "smartwheel" in name or "optipush" in name:
        side = "l" if "SWL" in name or "left" in name else "r"
        time, torque, turned = _optipush(file) if "optipush" in name else _smartwheel(file)
        t, speed = rate(time, turned)
        yield Signal(name, f"wheel_speed_{side}", t, RADIUS * speed)
        yield Signal(name, f"M_r{side}", time, torque)
    elif name.endswith("_sensors.csv"):
        yield from _imu(file)
    elif name.endswith(".xlsx"):
        yield from _workbook(file)
    elif name.endswith("_Moment.csv"):
        table = pd.read_csv(file, sep=";", decimal=",", skiprows=2, encoding="cp1252").to_numpy(float)
        yield Signal(name, "M_rl", table[:, 0], table[:, 1])
        yield Signal(name, "M_rr", table[:, 0], table[:, 2])
    elif name.endswith(".mat"):
        rec = loadmat(file, squeeze_me=True)["rec"].item()
        named = dict(zip(loadmat(file, squeeze_me=True)["rec"].dtype.names, rec, strict=True))
        columns = {str(n): named["data"][:, i] for i, n in enumerate(named["names"])}
        yield Signal(name, "yaw_rate", named["time"], -DEG * columns["omega_z"])
        yield Signal(name, "a_x", named["time"], columns["acc_x"])


def _smartwheel(file: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    table = pd.read_csv(file, header=None).to_numpy(float)
    side = -1.0 if "SWR" in file.name else 1.0  # the mirror image
    return (table[:, 0] - table[0, 0]) / 240.0, side * table[:, 23], side * _turned(DEG * table[:, 3])


def _turned(angle: np.ndarray) -> np.ndarray:
    """Unwrapped; a reading that the instrument averaged over a wrap stands between 360 and 0 degrees, and is none."""
    before, after = (np.angle(np.exp(1j * (b - a))) for a, b in ((angle[:-2], angle[1:-1]), (angle[1:-1], angle[2:])))
    alone = 1 + np.flatnonzero((np.abs(before) > 0.1) & (np.abs(after) > 0.1) & (np.abs(before - after) > 0.1))
    good = np.setdiff1d(np.arange(len(angle)), alone)
    return np.interp(np.arange(len(angle)), good, np.unwrap(angle[good]))


def _optipush(file: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    table = pd.read_csv(file, sep="\t", skiprows=12, header=None).to_numpy(float)
    return table[:, 0], table[:, 8], _turned(DEG * table[:, 9])


def _markers(file: Path) -> Iterator[Signal]:
    head = file.read_text().splitlines()[3].split("\t")
    table = pd.read_csv(file, sep="\t", skiprows=5, header=None)
    at = {name.strip(): i for i, name in enumerate(head) if name.strip()}
    time = table[1].to_numpy(float)
    right, left = (table.loc[:, at[m] : at[m] + 2].to_numpy(float) / 1000 for m in ("RHUB", "LHUB"))
    middle, axle = 0.5 * (right + left), right - left
    yaw = np.arctan2(-axle[:, 0], axle[:, 2])
    yield from (Signal(file.name, q, time, v) for q, v in (("x", middle[:, 0]), ("y", middle[:, 2]), ("yaw", yaw)))


def _imu(file: Path) -> Iterator[Signal]:
    table = pd.read_csv(file)
    time = table.iloc[:, 0].to_numpy(float)
    if "frame" in file.name:
        yield Signal(file.name, "yaw_rate", time, -DEG * table["Gyroscope Z (deg/s)"].to_numpy())
        yield Signal(file.name, "a_x", time, 9.81 * table["Accelerometer X (g)"].to_numpy())
    else:
        side, sign = ("l", 1.0) if "left" in file.name else ("r", -1.0)
        spin = sign * DEG * table["Gyroscope Y (deg/s)"].to_numpy()
        yield Signal(file.name, f"wheel_speed_{side}", time, RADIUS * spin)


def _workbook(file: Path) -> Iterator[Signal]:
    table = pd.read_excel(file, header=None).iloc[2:].apply(pd.to_numeric, errors="coerce").to_numpy(float)
    time = table[:, 0] / 1000
    named = (("wheel_speed_l", 1 / 3.6), ("wheel_speed_r", 1 / 3.6), ("a_x", 9.81))
    yield from (Signal(file.name, q, time, k * table[:, i]) for i, (q, k) in enumerate(named, 1))
