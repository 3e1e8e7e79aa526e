"""What a large campaign costs:  python -m benchmarks.large make|compare|diagnose FOLDER [--runs N] [--minutes M]

`make` writes a campaign of N runs of M minutes at 100 Hz with eight channels, three quarters of the runs to be fitted, driven
on the project's own kernel with more drag on the left wheel hidden in it; the other words are the commands, run
in a process of their own, with the seconds they take and the most memory they hold. As a group of `benchmarks.bench` it is
twenty runs of an hour, and 500 of a quarter of a minute.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np
import pandas as pd

from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.model.variant import Variant

from .independent.campaigns import NOISE
from .rows import Row

RATE, HOLD = 100.0, 0.8  # Hz; s between levels of the pushes
HIDDEN = {"effect.rolling_resistance_asymmetry.D": 1.6}  # N
HOURS, MANY = (20, 60.0), (500, 0.25)  # runs, and minutes of each
COMPARED, DIAGNOSED, GIGABYTES = 5.0, 2.0, 2.0  # min, min
SPEED, LOOKS = 1.0, 8.0  # m/s that the person keeps, by a look at the speed every so many seconds
SENSORS = {
    "wheel_speed_l": "sensor.wheel_speed_l",
    "wheel_speed_r": "sensor.wheel_speed_r",
    "yaw_rate": "sensor.yaw_rate",
    "a_x": "sensor.a_x",
    "a_y": "sensor.a_y",
    "x": "sensor.x",
    "y": "sensor.y",
    "yaw": "sensor.yaw",
}
UNITS = {
    "wheel_speed_l": "m/s",
    "wheel_speed_r": "m/s",
    "yaw_rate": "rad/s",
    "a_x": "m/s2",
    "a_y": "m/s2",
    "x": "m",
    "y": "m",
    "yaw": "rad",
    "F_rl": "N",
    "F_rr": "N",
    "time": "s",
}


@dataclass(frozen=True)
class Cost:
    """What a command took, by the clock and of processors, and the most memory it held at once."""

    seconds: float
    processor: float
    gigabytes: float
    output: str


def rows() -> Iterator[Row]:
    with TemporaryDirectory() as place:
        hours, many = (make(Path(place) / f"{runs}", runs, minutes) for runs, minutes in (HOURS, MANY))
        for what, minutes in (("compare", COMPARED), ("diagnose", DIAGNOSED)):
            found = cost([what, hours])
            yield Row(
                f"{what}, {HOURS[0]} runs of an hour",
                "min",
                [found.seconds / 60],
                minutes,
                note=f"{found.processor:.0f} s of processor time",
            )
            yield Row(f"{what}, {HOURS[0]} runs of an hour: memory", "GB", [found.gigabytes], GIGABYTES)
        for what in ("check", "compare", "diagnose"):
            found = cost([what, many])
            note = f"{found.gigabytes:.2f} GB, {found.processor:.0f} s of processor time"
            yield Row(f"{what}, {MANY[0]} runs of {60 * MANY[1]:g} s", "s", [found.seconds], note=note)


def make(
    folder: Path, runs: int, minutes: float, ending: str = ".parquet", seed: int = 0, hidden: Mapping[str, float] = HIDDEN
) -> Path:
    """Write the campaign; recordings are Parquet or CSV by their `ending`."""
    simulator = Simulator(Variant().with_values(hidden))
    (folder / "runs").mkdir(parents=True, exist_ok=True)
    lines = ["[campaign]", 'axes = "SAE-J670"', "[noise]", *(f"{name} = {NOISE[name]}" for name in ("F_rl", "F_rr", *SENSORS))]
    for n in range(runs):
        table = _recorded(simulator, minutes * 60, np.random.default_rng([seed, n]))
        file = f"runs/run-{n:02d}{ending}"
        if ending == ".csv":
            table.to_csv(folder / file, index=False, float_format="%.6g")
        else:
            table.to_parquet(folder / file, index=False)
        role = "holdout" if n % 4 == 3 else "fit"
        lines += ["[[run]]", f'file = "{file}"', 'manoeuvre = "everyday"', f'role = "{role}"', "u0 = 1.0"]
    (folder / "campaign.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return folder


def _recorded(simulator: Simulator, seconds: float, rng: np.random.Generator) -> pd.DataFrame:
    """What the sensors read while a person keeps about one speed, and turns at random."""
    p = simulator.variant.with_values({"start.u": SPEED}).vector()
    names = [s.name for s in simulator.model.states]
    mass = dict(zip((q.name for q in simulator.variant.parameters()), p, strict=True))["chair.m"]
    piece = np.arange(round(LOOKS * RATE) + 1) / RATE
    levels = np.arange(0, LOOKS + HOLD, HOLD)
    state, parts, begin, drag = None, [], 0.0, 11.0
    while begin < seconds:
        slow = 0.0 if state is None else SPEED - state[names.index("u")]
        mean = (drag + mass * slow / LOOKS) / 2
        both, turn = (np.interp(piece, levels, rng.uniform(-a, a, len(levels))) for a in (6.0, 7.0))
        true = {"F_rl": mean + both + turn, "F_rr": mean + both - turn}
        w = simulator.inputs(len(piece), {f"push.{name}": push for name, push in true.items()})
        run = simulator.run(piece, w, p, start=state)
        true |= {name: run[fmu] for name, fmu in SENSORS.items()}
        state = run.states[-1]
        parts.append({"time": begin + piece[:-1]} | {name: v[:-1] for name, v in true.items()})
        begin += LOOKS
    columns = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    return pd.DataFrame(
        {f"{name} [{UNITS[name]}]": v + NOISE.get(name, 0.0) * rng.standard_normal(len(v)) for name, v in columns.items()}
    )


def cost(words: Sequence[str | Path]) -> Cost:
    """Run the `wheelchair` command in a process of its own (POSIX)."""
    start = perf_counter()
    process = subprocess.Popen([sys.executable, "-m", "wheelchair_fmu", *map(str, words)], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    output = process.stdout.read()
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, process.args, output)
    unit = 1 if sys.platform == "darwin" else 1024  # bytes of ru_maxrss
    return Cost(perf_counter() - start, used.ru_utime + used.ru_stime, used.ru_maxrss * unit / 1e9, output)


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.large", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("what", choices=("make", "check", "compare", "diagnose"))
    parser.add_argument("folder", type=Path)
    parser.add_argument("--runs", type=int, default=20)
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--csv", action="store_true", help="recordings as CSV, not Parquet")
    chosen = parser.parse_args()
    if chosen.what == "make":
        print(make(chosen.folder, chosen.runs, chosen.minutes, ".csv" if chosen.csv else ".parquet"))
        return 0
    load = os.getloadavg()[0]
    found = cost([chosen.what, chosen.folder])
    print(found.output)
    print(
        f"{chosen.what}: {found.seconds:.0f} s, {found.processor:.0f} s of processor time, {found.gigabytes:.2f} GB, "
        f"at a load of {load:.1f} on {os.cpu_count()} cores"
    )
    return 0


if __name__ == "__main__":
    sys.exit(main())
