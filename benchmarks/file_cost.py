"""Files in: a campaign read with all its checks, a long recording imported, a rig's recordings identified."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from wheelchair_fmu.campaign import read
from wheelchair_fmu.tyres import identify
from wheelchair_fmu.tyres import read as read_rig

from .large import Cost, cost
from .rows import Row, timed

EXAMPLES = Path(__file__).parent.parent / "examples"
READ, IDENTIFIED, IMPORTED = 0.3, 5.0, 20.0  # s
LARGE, HALF = 62.0, 31.0  # MB of a recording
AS_MUCH = 2.0  # times the memory for twice the file, at most
COLUMNS = ("F_rl [N]", "F_rr [N]", "wheel_speed_l [m/s]", "wheel_speed_r [m/s]", "yaw_rate [rad/s]", "a_x [m/s2]", "a_y [m/s2]")


def rows() -> Iterator[Row]:
    sample, disc = EXAMPLES / "sample-campaign", EXAMPLES / "rotating-disc.csv"
    runs = read(sample).runs
    reading = [ms / 1e3 for ms in timed(lambda: read(sample), 5)]
    yield Row(f"reading a campaign of {len(runs)} runs", "s", reading, READ, note=f"{sum(len(r.time) for r in runs)} samples")
    whole, half = imported(LARGE), imported(HALF)
    note = f"{whole.gigabytes:.2f} GB; of {HALF:g} MB {half.seconds:.1f} s, {half.gigabytes:.2f} GB"
    yield Row(f"importing a recording of {LARGE:g} MB", "s", [whole.seconds], IMPORTED, note=note)
    yield Row("memory for twice the recording", "times", [whole.gigabytes / half.gigabytes], AS_MUCH)
    identifying = [ms / 1e3 for ms in timed(lambda: identify(read_rig(disc).sweeps), 3)]
    yield Row("identifying a rig's tyres", "s", identifying, IDENTIFIED, note=disc.name)


def imported(megabytes: float) -> Cost:
    """`wheelchair import` of one recording of that size."""
    with TemporaryDirectory() as folder:
        file = Path(folder, "ride.csv")
        recording(file, megabytes)
        words = (file, "-o", Path(folder, "campaign"), "--mass", 90, "--radius", 0.3, "--track", 0.55, "--link")
        return cost(["import", *words])


def recording(file: Path, megabytes: float) -> None:
    """A weaving ride at 100 Hz, as one CSV of about that size."""
    rng, fmt = np.random.default_rng(0), ",".join(["%.2f", *["%.6f"] * len(COLUMNS)])
    row = len(fmt % (1e4, *np.ones(len(COLUMNS)))) + 1
    t = np.arange(int(1e6 * megabytes / row)) / 100
    speed, rate = 1 + 0.3 * np.sin(0.5 * t), 0.3 * np.sin(0.8 * t)
    push = 10 + 5 * np.sin(2 * t)
    wheels = speed + 0.27 * rate, speed - 0.27 * rate
    true = (push, push, *wheels, rate, np.gradient(speed, t), speed * rate)
    noisy = [series + rng.normal(0, 0.01, len(t)) for series in true]
    np.savetxt(file, np.column_stack([t, *noisy]), fmt, header=",".join(["time [s]", *COLUMNS]), comments="")
