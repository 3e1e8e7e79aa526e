"""What one step of the native FMU costs a host without Python: set two inputs, doStep(1 ms), get eight outputs.

The host is the one of the tests, compiled here. It times each of 2 000 steps in five repeats, keeps each step's least, and
prints median and worst of these; it is run five times. As FMUs are built their effects are off, for which there is a
shorter step; further rows have an effect on, and wheels whose spin is a state.
"""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import fmpy

from wheelchair_fmu.engine import compiler
from wheelchair_fmu.engine.kernel import kernel
from wheelchair_fmu.fmu.build import with_chosen_effects
from wheelchair_fmu.fmu.native import headers
from wheelchair_fmu.model.choice import Choice
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies import fmu_of

from . import limits
from .rows import Row

HOST = Path(__file__).parent.parent / "tests" / "fmu" / "host.c"
INPUTS = ("push.F_rl", "push.F_rr")
OUTPUTS = ("chair.x", "chair.y", "chair.psi", "chair.u", "chair.v", "chair.psi_dot", "slip.rl", "slip.rr")
STEPS, LENGTH, RUNS = 2000, 1e-3, 5
MEDIAN_TARGETS = {"default": 2.0, "all": 4.0}  # µs
WORST_TARGET = 10.0  # µs
LEAST = "of each step the least of five repeats, without what else the machine was doing"
OTHERS = {
    "one of them on": Variant().with_values({"effect.rolling_resistance_asymmetry.D": 1.0}),
    'wheel = "spinning"': Variant(Choice(wheel="spinning")),
    'caster = "slipping"': Variant(Choice(caster="slipping")),
}


def rows() -> Iterator[Row]:
    with TemporaryDirectory() as folder:
        host = host_program(Path(folder))
        for effects, target in MEDIAN_TARGETS.items():
            medians, worsts = zip(*(_run(host, Path(folder), effects) for _ in range(RUNS)), strict=True)
            functions = kernel(with_chosen_effects(Variant(), effects).model()).functions
            work = limits.of(functions["bare"]) + limits.of(functions["bare_output"])
            yield Row(
                f"FMU step, --effects {effects}: median",
                "µs",
                medians,
                target,
                limit=1e6 * work.seconds(limits.core(1)),
                why=f"one step and one set of results, {work.operations:.0f} operations one by one; the rest is waiting for "
                "operands, the C library's functions, and FMI's calls",
            )
            yield Row(f"FMU step, --effects {effects}: worst", "µs", worsts, WORST_TARGET, note=LEAST)
        for what, variant in OTHERS.items():
            medians = [run_host(host, Path(folder), "default", "time", STEPS, variant)[0] / 1e3 for _ in range(RUNS)]
            yield Row(f"FMU step, --effects default, {what}: median", "µs", medians)


def host_program(folder: Path) -> Path:
    program = folder / "host"
    words = [*compiler.command(), "-O2", f"-I{headers()}", str(HOST), "-o", str(program), "-ldl", "-lm"]
    subprocess.run(words, check=True)
    return program


def _run(host: Path, folder: Path, effects: str) -> tuple[float, float]:
    """Median and worst of the steps' costs [µs]."""
    median, worst = run_host(host, folder, effects, "time", STEPS)
    return median / 1e3, worst / 1e3


def run_host(host: Path, folder: Path, effects: str, mode: str, steps: int, variant: Variant = Variant()) -> list[float]:
    """What the host prints in this mode, over so many steps of a variant's FMU with these effects."""
    archive = fmu_of(variant, effects, with_starts=True)
    place = folder / archive.stem
    if not place.exists():
        fmpy.extract(str(archive), str(place))
    description = fmpy.read_model_description(str(archive))
    at = {v.name: str(v.valueReference) for v in description.modelVariables}
    library = next((place / "binaries").glob(f"*/*{compiler.SUFFIX}"))
    words = [str(host), str(library), description.guid, mode, str(steps), str(LENGTH), *(at[n] for n in INPUTS + OUTPUTS)]
    done = subprocess.run(words, check=True, capture_output=True, text=True)
    return [float(word) for word in done.stdout.split()]
