"""The archives in other people's importers, as a Markdown table:  python -m benchmarks.importers

FMPy and the plain C host run here. libcosimpy and CoFMUPy run where $IMPORTERS_PYTHON points (`make importers` sets it up).
"""

from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import fmpy
import numpy as np

from wheelchair_fmu.engine import compiler
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.fmu.build import build_each, with_chosen_effects
from wheelchair_fmu.fmu.native import headers
from wheelchair_fmu.fmu.variables import GRID, TOLERANCE
from wheelchair_fmu.model.variant import Variant

HERE = Path(__file__).parent
HOST = HERE.parents[1] / "tests" / "fmu" / "trajectory.c"
OTHERS = os.environ.get("IMPORTERS_PYTHON", "")
REFERENCE = "the archive's reference inputs, 5 s"
TWO = "two chairs in one process, coupled, 3 s"
STROKES = "strokes that turn right and left, 4 s"
ALLOWED = 1e-5  # of any output at the end, relative to 1 + its size


@dataclass(frozen=True)
class Result:
    """One importer on one archive: `deviation` from what is right at the end, or why there is none."""

    tool: str
    fmi: str
    interface: str
    run: str
    deviation: float | None = None
    trouble: str = ""

    @property
    def good(self) -> bool:
        return self.deviation is not None and self.deviation <= ALLOWED

    @property
    def verdict(self) -> str:
        if self.deviation is None:
            return self.trouble
        size = f"to {self.deviation:.0e}" if self.deviation else "to the last bit"
        return f"{'agrees' if self.good else 'differs'}, {size}"


def deviation(found: dict[str, float], expected: dict[str, float]) -> float:
    return max(abs(found[name] - value) / (1 + abs(value)) for name, value in expected.items())


def drive(python: str, script: str, archive: Path, folder: Path, fmi: str, interface: str, run: str,
          expected: dict[str, float]) -> Result:  # fmt: skip
    """Run a driver in the environment that has its importer."""
    words = [python, str(HERE / f"drive_{script}.py"), str(archive), interface, *(str(folder / n) for n in NAMES)]
    if not python:
        return Result(script, fmi, interface, run, trouble="not run: no $IMPORTERS_PYTHON")
    clean = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    done = subprocess.run([*words, *(["two"] if run == TWO else [])], capture_output=True, text=True, env=clean, timeout=300,
                          check=False)  # fmt: skip
    lines = [line for line in done.stdout.splitlines() if line.startswith('{"tool"')]
    if not lines:
        last = (done.stderr.strip().splitlines() or ["no word"])[-1]
        ended = f"signal {-done.returncode}" if done.returncode < 0 else f"exit code {done.returncode}"
        return Result(script, fmi, interface, run, trouble=f"does not run: {ended}: {last[-100:]}")
    said = json.loads(lines[0])
    return Result(f"{said['tool']} {said['version']}", fmi, interface, run, deviation(said["end"], expected))


NAMES = ("reference_in.csv", "reference.csv")


def reference(archive: Path, folder: Path) -> dict[str, float]:
    """Unpacks the reference results and returns their last row."""
    with zipfile.ZipFile(archive) as z:
        for name in NAMES:
            (folder / name).write_bytes(z.read(f"documentation/{name}"))
    with open(folder / NAMES[1]) as file:
        rows = list(csv.DictReader(file))
    return {name: float(value) for name, value in rows[-1].items() if name != "time"}


def coupled() -> dict[str, float]:
    """The second chair's end by the engine: the first needs a constant push, and it gets that on each side."""
    simulator = Simulator(with_chosen_effects(Variant()))
    time = np.arange(301) * 0.01
    needed = simulator.run(time, simulator.inputs(301, {}), tolerance=TOLERANCE, grid=GRID, hold=True)["push.total_needed"]
    inputs = simulator.inputs(301, {"push.F_rl": needed, "push.F_rr": needed})
    run = simulator.run(time, inputs, tolerance=TOLERANCE, grid=GRID, hold=True)
    return {name: float(run[name][-1]) for name in ("chair.u", "chair.x")}


def strokes() -> tuple[tuple[str, ...], dict[str, float]]:
    """What trajectory.c does, by the engine: names of outputs, and their values at the end."""
    i = np.arange(401)
    phase, more = (i * 0.01) % 1, np.where((i * 0.01) % 2 < 1, 4.0, -6.0)
    both = np.where(phase < 0.5, 640 * phase * (0.5 - phase), 0.0)
    simulator = Simulator(with_chosen_effects(Variant()))
    inputs = simulator.inputs(401, {"push.F_rl": both + more, "push.F_rr": both - more})
    run = simulator.run(i * 0.01, inputs, tolerance=TOLERANCE, grid=GRID, hold=True)
    names = ("chair.x", "chair.y", "chair.psi", "chair.u", "slip.rl", "sensor.a_y")
    return names, {name: float(run[name][-1]) for name in names}


def plain_host(archive: Path, fmi: str, folder: Path) -> Result:
    program, unpacked = folder / "trajectory", folder / f"unpacked{fmi}"
    words = [*compiler.command(), "-std=gnu11", "-O2", f"-I{headers()}", str(HOST), "-o", str(program), "-lm", "-ldl"]
    subprocess.run(words, check=True)
    fmpy.extract(str(archive), str(unpacked))
    description = fmpy.read_model_description(str(archive))
    at = {v.name: str(v.valueReference) for v in description.modelVariables}
    names, expected = strokes()
    library = next((unpacked / "binaries").glob(f"*/*{compiler.SUFFIX}"))
    references = [at[n] for n in ("push.F_rl", "push.F_rr", *names)]
    done = subprocess.run([str(program), str(library), description.guid, fmi, "400", "0.01", *references],
                          capture_output=True, text=True, check=True)  # fmt: skip
    end = dict(zip(names, map(float, done.stdout.splitlines()[-1].split()), strict=True))
    return Result(f"plain C host, {compiler.version().split(' ')[0]}", fmi, "CoSimulation", STROKES, deviation(end, expected))


def results() -> Iterator[Result]:
    with TemporaryDirectory() as place:
        folder = Path(place)
        archives = build_each({"2": folder / "chair.fmu", "3": folder / "chair.fmi3.fmu"})
        for fmi, archive in zip(("2", "3"), archives, strict=True):
            expected = reference(archive, folder)
            for interface in ("CoSimulation", "ModelExchange"):
                yield drive(sys.executable, "fmpy", archive, folder, fmi, interface, REFERENCE, expected)
            yield plain_host(archive, fmi, folder)
            for script in ("libcosimpy", "cofmupy"):
                yield drive(OTHERS, script, archive, folder, fmi, "CoSimulation", REFERENCE, expected)
                yield drive(OTHERS, script, archive, folder, fmi, "CoSimulation", TWO, coupled())


def main() -> int:
    print("| importer | FMI | interface | what was run | result |\n|---|---|---|---|---|")
    for r in results():
        print(f"| {r.tool} | {r.fmi}.0 | {r.interface} | {r.run} | {r.verdict} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
