"""The runs of a sweep, chunk by chunk: each chunk is a table that depends on nothing but the job and its number."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import pyarrow as pa

from ... import __version__
from ...chunks import ERROR
from ...configuration import MANOEUVRES, digest
from ...engine.cache import sources
from ...engine.ensemble import making
from ...handling.manoeuvres import Manoeuvre
from .columns import column, woven
from .engines import ENGINES, Engine, encoded
from .plan import Chair, Plan
from .quantities import QUANTITIES, READS, none, of_runs

if TYPE_CHECKING:
    from .yardstick import Yardstick

CHUNK = 256  # runs, about: what is lost when a sweep is killed, and what a worker holds in memory
NUMBERS = 500_000  # results of chairs that run side by side, about: what a processor keeps at hand
LEAST = 16  # chairs, so that no lane waits for long at the end


@dataclass(frozen=True)
class Job:
    """Everything a worker needs; it can be pickled. `yardsticks` has the campaign's runs for each variant by label."""

    plan: Plan
    engine: str = "kernel"
    yardsticks: Mapping[str, tuple[Yardstick, ...]] = field(default_factory=dict)
    campaign: str = ""
    measured: str = ""  # the campaign's fingerprint: with the plan it decides the yardsticks
    chunk: int = CHUNK
    what: ClassVar[str] = "plan, effects, engine or version"

    @cached_property
    def fingerprint(self) -> str:
        """Two jobs with the same one have the same result."""
        words = (__version__, sources(), digest(MANOEUVRES), str(self.chunk), repr(self.plan), self.engine, self.measured)
        return hashlib.sha256("\n".join(words).encode()).hexdigest()

    @property
    def by_threads(self) -> bool:
        return self.engine == "kernel" and not self.yardsticks

    @property
    def stride(self) -> int:
        """Chairs in a chunk: a power of two, as pieces of a Sobol' sequence should be."""
        return 1 << (max(1, self.chunk // self.plan.cases).bit_length() - 1)

    @property
    def chunks(self) -> int:
        return -(-self.plan.design.chairs // self.stride)

    @property
    def total(self) -> int:
        return self.plan.runs

    def rows(self, chunk: int) -> int:
        """Runs in a chunk."""
        start, stop = self.bounds(chunk)
        return (stop - start) * self.plan.cases

    def bounds(self, chunk: int) -> tuple[int, int]:
        return chunk * self.stride, min((chunk + 1) * self.stride, self.plan.design.chairs)

    def schema(self) -> pa.Schema:
        """Columns of the result, with units in their metadata."""
        units = {p.name: p.unit.name for p in self.plan.chairs[0].variant().parameters()}
        options = dict.fromkeys(name for course in self.plan.courses for name, _ in course.options)
        return pa.schema(
            [
                pa.field("chair", pa.int64(), metadata={"meaning": "number of the point in the plan's design"}),
                pa.field("variant", pa.string()),
                pa.field("manoeuvre", pa.string()),
                *(pa.field(f"manoeuvre.{name}", pa.float64()) for name in options),
                *(
                    pa.field(axis.name, pa.string() if axis.choices else pa.float64(), metadata={"unit": units[axis.name]})
                    for axis in self.plan.design.axes
                ),
                *(
                    pa.field(name, pa.float64(), metadata={"unit": unit, "meaning": meaning})
                    for name, (unit, meaning) in QUANTITIES.items()
                ),
                pa.field(ERROR, pa.string(), metadata={"meaning": "why this run gave nothing; empty where it did"}),
            ],
            metadata={"wheelchair-fmu": __version__, "fingerprint": self.fingerprint},
        )

    def table(self, chunk: int) -> pa.Table:
        """The runs of one chunk: chairs in order, of each chair every variant, of each variant every manoeuvre."""
        start, stop = self.bounds(chunk)
        cases = list(_cases(self, self.plan.design.points(start, stop)))
        columns = {
            "chair": np.repeat(np.arange(start, stop), len(cases)),
            **{name: woven([case[name] for case in cases]) for name in cases[0]},
        }
        schema = self.schema()
        return pa.table([column(columns[name], schema.field(name).type) for name in schema.names], schema=schema)


def prepare(job: Job) -> None:
    """Compile or build what the runs need, once for all processes that share the cache: the first chair needs it."""
    for _ in _cases(job, job.plan.design.points(0, 1)):
        pass


def _cases(job: Job, points: np.ndarray) -> Iterator[dict[str, Any]]:
    """Of each variant each manoeuvre: the columns of the chairs at these points."""
    axes, chairs = job.plan.design.axes, len(points)
    shown = {axis.name: axis.shown(points[:, i]) for i, axis in enumerate(axes)}
    values = [dict(zip((axis.name for axis in axes), map(float, point), strict=True)) for point in points]
    options = dict.fromkeys(f"manoeuvre.{name}" for course in job.plan.courses for name, _ in course.options)
    for chair in job.plan.chairs:
        bench = _bench(job, chair)
        for course in job.plan.courses:
            own = {**options, **{f"manoeuvre.{name}": value for name, value in course.options}}
            same = {"variant": chair.label, "manoeuvre": course.label, **own}
            yield {**_alike(same, chairs), **shown, **bench.manoeuvre(course.label, values)}
        if job.yardsticks:
            same = {"variant": chair.label, "manoeuvre": f"campaign {job.campaign}", **options}
            yield {**_alike(same, chairs), **shown, **bench.campaign(values)}


def _alike(values: Mapping[str, Any], rows: int) -> dict[str, list[Any]]:
    return {name: [value] * rows for name, value in values.items()}


class _Bench:
    """One variant's engine with what never changes from chair to chair."""

    def __init__(self, job: Job, chair: Chair):
        self.variant = chair.variant()
        laws = {int(v) for axis in job.plan.design.axes if axis.name == "tyre.law" for v in axis.values}
        self.engine: Engine = ENGINES[job.engine](self.variant, laws)
        self.own = dict(zip((p.name for p in self.variant.parameters()), self.variant.vector(), strict=True))
        self.yardsticks = job.yardsticks.get(chair.label, ())
        self.courses: dict[str, tuple[Manoeuvre, dict[str, float]]] = {}
        for course in job.plan.courses:
            m = course.manoeuvre()
            self.courses[course.label] = m, encoded(self.variant, m.values)

    def manoeuvre(self, label: str, chairs: Sequence[Mapping[str, float]]) -> dict[str, Any]:
        """Columns of the chairs with these values."""
        m, own = self.courses[label]
        at_once = max(LEAST, NUMBERS // (len(READS) * len(m.time)))
        given = [{**own, **values} for values in chairs]
        parts = [self._some(m, given[i : i + at_once]) for i in range(0, len(given), at_once)]
        return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}

    def _some(self, m: Manoeuvre, given: Sequence[Mapping[str, float]]) -> dict[str, np.ndarray]:
        runs = self.engine.run(m.time, m.inputs, given, READS)
        held = np.array([values["speed.mode"] == 2 for values in given])
        tread = np.array([values.get("chair.t_r", self.own["chair.t_r"]) for values in given])
        return {**of_runs(m.time, m.inputs, runs.results, held=held, tread=tread), ERROR: np.array(runs.errors, object)}

    def campaign(self, chairs: Sequence[Mapping[str, float]]) -> dict[str, Any]:
        from .yardstick import whitened  # brings what reads campaigns along, which most sweeps do without

        found, why = whitened(self.engine, self.variant, self.yardsticks, chairs)
        return {**none(len(chairs)), **found, ERROR: np.array(why, object)}


_benches: dict[tuple[str, str], _Bench] = {}


def _bench(job: Job, chair: Chair) -> _Bench:
    """The same for all threads."""
    key = (job.fingerprint, chair.label)
    with making:
        if key not in _benches:
            if any(other != job.fingerprint for other, _ in _benches):
                _benches.clear()  # a worker that lives on serves one sweep at a time
            _benches[key] = _Bench(job, chair)
        return _benches[key]
