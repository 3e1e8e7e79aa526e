"""What a chair of a sweep costs, beside fmpy's own loop on the same cores.

A steady turn of 10 s at 100 Hz, a random design over three parameters: 10 000 chairs by `wheelchair sweep` with all that it
does (results written, parts put together), fewer by `fmpy.simulate_fmu`, for its time grows with their
number alone. fmpy gets what makes it fastest: the FMU unpacked once in each process, one instance that is reset, only the
outputs that the quantities need, and as many processes. Its time counts from when the processes are ready.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import redirect_stdout
from io import StringIO
from multiprocessing import get_context
from os import cpu_count
from pathlib import Path
from time import perf_counter
from typing import Any

import fmpy
import numpy as np
import pyarrow.parquet as pq
from fmpy.simulation import instantiate_fmu

from wheelchair_fmu.chunks import complete, here
from wheelchair_fmu.engine.kernel import kernel
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.handling.manoeuvres import Manoeuvre, manoeuvre
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies import fmu_of
from wheelchair_fmu.studies.sweep import Job, Plan, prepare
from wheelchair_fmu.studies.sweep.design import Axis, Design
from wheelchair_fmu.studies.sweep.engines import encoded
from wheelchair_fmu.studies.sweep.plan import Chair, Course
from wheelchair_fmu.studies.sweep.quantities import READS

from . import limits
from .rows import Row

CHAIRS, FEWER, REPEATS, TARGET = 10_000, 64, 3, 150.0
OUTPUTS = [
    "chair.x",
    "chair.y",
    "chair.u",
    "chair.psi_dot",
    "chair.curvature",
    "slip.rl",
    "slip.rr",
    "push.total_needed",
    "load.lifted",
]
AXES = (
    Axis("tyre.C_lambda", lower=2500, upper=10_000),
    Axis("chair.m", lower=60, upper=100),
    Axis("tyre.C_m_lambda", lower=50, upper=200),
)


def job() -> Job:
    return Job(Plan(Design("random", AXES, CHAIRS, 1), (Course("steady-turn", "steady-turn", ()),), (Chair(),)))


class _Loop:
    """fmpy's loop, ready to run in one process."""

    def __init__(self, path: str):
        self.folder = fmpy.extract(path)
        self.description = fmpy.read_model_description(self.folder)
        self.instance = instantiate_fmu(self.folder, self.description, "CoSimulation")
        self.course: Manoeuvre = manoeuvre("steady-turn")
        self.values = encoded(Variant(), self.course.values)
        self.signals = np.rec.fromarrays([self.course.time, *self.course.inputs.values()], names=["time", *self.course.inputs])

    def run(self, values: dict[str, float]) -> float:
        """The curvature at the end."""
        self.instance.reset()
        done = fmpy.simulate_fmu(
            self.folder,
            stop_time=self.course.time[-1],
            output_interval=0.01,
            start_values={**self.values, **values},
            input=self.signals,
            output=OUTPUTS,
            model_description=self.description,
            fmu_instance=self.instance,
        )
        return float(done["chair.curvature"][-1])


_loop: Any = None


def _begin(path: str) -> None:
    global _loop
    _loop = _Loop(path)


def _some(chairs: list[dict[str, float]]) -> list[float]:
    with redirect_stdout(StringIO()):  # fmpy says each time which inputs are left at their start values
        return [_loop.run(values) for values in chairs]


def _theirs(points: np.ndarray, workers: int) -> tuple[list[float], np.ndarray]:
    """Seconds of each repeat, and curvatures (n,)."""
    chairs = [dict(zip((axis.name for axis in AXES), map(float, row), strict=True)) for row in points]
    chunks = [chairs[i::workers] for i in range(workers)]
    seconds = []
    with ProcessPoolExecutor(workers, get_context("spawn"), _begin, (str(fmu_of(Variant())),)) as pool:
        list(pool.map(_some, [chunk[:2] for chunk in chunks]))  # starts the processes, loads the FMU
        for _ in range(REPEATS):
            start = perf_counter()
            found = list(pool.map(_some, chunks))
            seconds.append(perf_counter() - start)
    curvature = np.empty(len(points))
    for i, part in enumerate(found):
        curvature[i::workers] = part
    return seconds, curvature


def work_of() -> tuple[limits.Work, int]:
    """What the arithmetic of one chair takes, and its steps."""
    simulator, course = Simulator(Variant()), manoeuvre("steady-turn")
    p = simulator.variant.vector()
    for name, value in encoded(simulator.variant, course.values).items():
        p[[q.name for q in simulator.model.parameters].index(name)] = value
    steps = simulator.run(course.time, simulator.inputs(len(course.time), course.inputs), p).steps
    step, row = kernel(simulator.model).functions["plain"], limits.results(simulator.model, READS)
    return limits.of(step) * steps + limits.of(row) * len(course.time), steps


def rows() -> Iterator[Row]:
    workers = cpu_count() or 1
    ours = job()
    prepare(ours)
    seconds = []
    with tempfile.TemporaryDirectory() as place:
        for i in range(REPEATS):
            out = Path(place) / f"{i}.parquet"
            start = perf_counter()
            complete(ours, out, here(workers))
            seconds.append(perf_counter() - start)
        curvature = pq.read_table(out, columns=["curvature"]).column(0).to_numpy()[:FEWER]
    theirs, reference = _theirs(ours.plan.design.points(0, FEWER), workers)
    off = float(np.abs(curvature / reference - 1).max())
    per_chair = [1e3 * s / FEWER for s in theirs]
    work, steps = work_of()
    core = limits.widest()
    yield Row(
        f"a chair of a sweep of {CHAIRS}",
        "ms",
        [1e3 * s / CHAIRS for s in seconds],
        TARGET,
        float(np.median(per_chair)),
        f"beside fmpy's loop on {workers} cores; curvatures agree to {off:.0e}",
        1e3 * work.seconds(core) / workers,
        f"{steps} steps and 1001 sets of results on one of {workers} cores, {work.operations / 1e6:.2f} million operations, "
        f"{core.lanes} at once; the rest is waiting for operands, parts that are written, and Python",
    )
    yield Row(f"a chair by fmpy's loop, of {FEWER}", "ms", per_chair)
