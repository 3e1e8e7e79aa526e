"""Run one row: a driver in the environment that has its importer, or the plain C host."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import fmpy

from wheelchair_fmu.engine import compiler
from wheelchair_fmu.fmu.build import build_each
from wheelchair_fmu.fmu.native import headers
from wheelchair_fmu.studies.ssp import sources
from wheelchair_fmu.studies.ssp.building import build
from wheelchair_fmu.studies.ssp.running import run

from .cases import WET, Case, cases, strokes
from .rows import SLIDES, STROKES, SYSTEMS, TWO, Result, Row, fmu_rows, ssp_rows

HERE = Path(__file__).parent
HOST = HERE.parents[1] / "tests" / "fmu" / "trajectory.c"
OTHERS = os.environ.get("IMPORTERS_PYTHON", "")
WATCHED = ("Chair.chair.x", "Chair.chair.y", "Chair.chair.psi", "Chair.chair.u")


def fmu_results() -> Iterator[Result]:
    with TemporaryDirectory() as place:
        folder = Path(place)
        archives = build_each({"2": folder / "chair.fmu", "3": folder / "chair.fmi3.fmu"})
        wet = build_each({"2": folder / "wet.fmu", "3": folder / "wet.fmi3.fmu"}, WET)
        for fmi, archive, spinning in zip(("2", "3"), archives, wet, strict=True):
            known = cases(archive, folder)
            for row in fmu_rows(fmi):
                if row.reason:
                    yield Result(row, trouble=row.reason)
                elif row.run == STROKES:
                    yield plain_host(row, archive, folder)
                else:
                    yield on_fmu(row, spinning if row.run == SLIDES else archive, known[row.run])


def ssp_results() -> Iterator[Result]:
    with TemporaryDirectory() as folder:
        archives = {name: build(name, Path(folder) / f"{name}.ssp") for name in SYSTEMS}
        for row in ssp_rows():
            yield Result(row, trouble=row.reason) if row.reason else on_ssp(row, archives[row.run])


def on_fmu(row: Row, archive: Path, case: Case) -> Result:
    words = [str(archive), row.interface, str(case.inputs), str(case.results), *(["two"] if row.run == TWO else [])]
    return _drive(row, words, case.expected)


def on_ssp(row: Row, archive: Path) -> Result:
    """Against our own run of the same archive with the same step."""
    stop, step = SYSTEMS[row.run], sources.system(row.run).step
    trace = run(archive, stop=stop, step=step)
    return _drive(row, [str(archive), str(stop), str(step), *WATCHED], {name: float(trace[name][-1]) for name in WATCHED})


def plain_host(row: Row, archive: Path, folder: Path) -> Result:
    program, unpacked = folder / "trajectory", folder / f"unpacked{row.fmi}"
    words = [*compiler.command(), "-std=gnu11", "-O2", f"-I{headers()}", str(HOST), "-o", str(program), "-lm", "-ldl"]
    subprocess.run(words, check=True)
    fmpy.extract(str(archive), str(unpacked))
    description = fmpy.read_model_description(str(archive))
    at = {v.name: str(v.valueReference) for v in description.modelVariables}
    names, expected = strokes()
    library = next((unpacked / "binaries").glob(f"*/*{compiler.SUFFIX}"))
    references = [at[n] for n in ("push.F_rl", "push.F_rr", *names)]
    done = subprocess.run(
        [str(program), str(library), description.guid, row.fmi, "400", "0.01", *references],
        capture_output=True,
        text=True,
        check=True,
    )
    end = dict(zip(names, map(float, done.stdout.splitlines()[-1].split()), strict=True))
    return Result(row, compiler.version().split()[0], deviation(end, expected))


def deviation(found: dict[str, float], expected: dict[str, float]) -> float:
    return max(abs(found[name] - value) / (1 + abs(value)) for name, value in expected.items())


def _drive(row: Row, words: list[str], expected: dict[str, float]) -> Result:
    python = sys.executable if row.here else OTHERS
    if not python:
        return Result(row, trouble="not run: no $IMPORTERS_PYTHON")
    clean = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    done = subprocess.run(
        [python, str(HERE / f"drive_{row.script}.py"), *words],
        capture_output=True,
        text=True,
        env=clean,
        timeout=300,
        check=False,
    )
    lines = [line for line in done.stdout.splitlines() if line.startswith('{"tool"')]
    if not lines:
        said = done.stderr.strip().splitlines() or ["no word"]
        ended = f"signal {-done.returncode}" if done.returncode < 0 else f"exit code {done.returncode}"
        return Result(row, trouble=f"does not run: {ended}: {said[-1][-100:]}")
    answer = json.loads(lines[0])
    return Result(row, answer["version"], deviation(answer["end"], expected))
