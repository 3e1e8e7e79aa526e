"""What is fed to an archive, as CSV files, and what it should give at the end: by the engine, not through FMI."""

from __future__ import annotations

import csv
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from wheelchair_fmu.engine.simulate import Simulator, Trajectory
from wheelchair_fmu.fmu.build import with_chosen_effects
from wheelchair_fmu.fmu.reference import OUTPUTS
from wheelchair_fmu.fmu.variables import GRID, TOLERANCE
from wheelchair_fmu.model.choice import Choice
from wheelchair_fmu.model.variant import Variant

from .rows import BOUND, REFERENCE, SLIDES, TWO

STEP = 0.01  # s
WET = Variant(Choice(wheel="spinning")).with_values({"tyre.mu": 0.4})
RIMS = ("sensor.wheel_speed_l", "sensor.wheel_speed_r")
LEAVES = -1e-12  # of a brake that is meant to be 0, as an interpolation leaves it


@dataclass(frozen=True)
class Case:
    """Inputs, results (whose head names what is looked at) and the right values at the end."""

    inputs: Path
    results: Path
    expected: dict[str, float]


def cases(archive: Path, folder: Path) -> dict[str, Case]:
    """Every case that needs files, by what was run, for one archive."""
    with zipfile.ZipFile(archive) as z:
        for name in ("reference_in.csv", "reference.csv"):
            inside = next(n for n in z.namelist() if n.rpartition("/")[2] == name)
            (folder / name).write_bytes(z.read(inside))
    with open(folder / "reference.csv") as file:
        rows = list(csv.DictReader(file))
    end = {name: float(value) for name, value in rows[-1].items() if name != "time"}
    given = Case(folder / "reference_in.csv", folder / "reference.csv", end)
    two = Case(given.inputs, given.results, coupled())
    return {REFERENCE: given, TWO: two, BOUND: at_bound(folder), SLIDES: on_a_wet_floor(folder)}


def coupled() -> dict[str, float]:
    """The second chair's end: the first needs a constant push, and it gets that on each side."""
    simulator, time = _simulator(), np.arange(301) * STEP
    needed = _run(simulator, time, {})["push.total_needed"]
    run = _run(simulator, time, {"push.F_rl": needed, "push.F_rr": needed})
    return {name: float(run[name][-1]) for name in ("chair.u", "chair.x")}


def at_bound(folder: Path) -> Case:
    """A pushed chair whose brake, from 0, goes a rounding error below its lower bound: as if it stayed at 0."""
    time = np.arange(101) * STEP
    pushes = {"push.F_rl": np.full(101, 12.0), "push.F_rr": np.full(101, 10.0)}
    run = _run(_simulator(), time, pushes)
    case = Case(folder / "bound_in.csv", folder / "bound.csv", {name: float(run[name][-1]) for name in OUTPUTS})
    _write(case.inputs, {"time": time, **pushes, "brake.rl": LEAVES * time / time[-1]})
    _write(case.results, {"time": time, **{name: run[name] for name in OUTPUTS}})
    return case


def on_a_wet_floor(folder: Path) -> Case:
    """A push that spins both wheels, the left one faster; then brakes that lock the right one first."""
    time = np.arange(201) * STEP
    inputs = {"push.F_rl": np.where(time < 0.5, 140.0, 0.0), "push.F_rr": np.where(time < 0.5, 120.0, 0.0)}
    inputs |= {"brake.rl": np.where(time < 1.4, 0.0, 0.8), "brake.rr": np.where(time < 1.2, 0.0, 0.8)}
    run = _run(Simulator(with_chosen_effects(WET)), time, inputs)
    names = (*OUTPUTS, *RIMS)
    case = Case(folder / "wet_in.csv", folder / "wet.csv", {name: float(run[name][-1]) for name in names})
    _write(case.inputs, {"time": time, **inputs})
    _write(case.results, {"time": time, **{name: run[name] for name in names}})
    return case


def strokes() -> tuple[tuple[str, ...], dict[str, float]]:
    """What trajectory.c does: names of outputs, and their values at the end."""
    i = np.arange(401)
    phase, more = (i * STEP) % 1, np.where((i * STEP) % 2 < 1, 4.0, -6.0)
    both = np.where(phase < 0.5, 640 * phase * (0.5 - phase), 0.0)
    run = _run(_simulator(), i * STEP, {"push.F_rl": both + more, "push.F_rr": both - more})
    names = ("chair.x", "chair.y", "chair.psi", "chair.u", "slip.rl", "sensor.a_y")
    return names, {name: float(run[name][-1]) for name in names}


def _simulator() -> Simulator:
    return Simulator(with_chosen_effects(Variant()))


def _run(simulator: Simulator, time: np.ndarray, inputs: dict[str, np.ndarray]) -> Trajectory:
    """Inputs held over each step, as a master of Co-Simulation holds them."""
    return simulator.run(time, simulator.inputs(len(time), inputs), tolerance=TOLERANCE, grid=GRID, hold=True)


def _write(path: Path, columns: dict[str, np.ndarray]) -> None:
    with open(path, "w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(columns)
        rows.writerows(map(repr, map(float, row)) for row in zip(*columns.values(), strict=True))
