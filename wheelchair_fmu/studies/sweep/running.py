"""The runs of a sweep, chunk by chunk: each chunk is a table that depends on nothing but the job and its number."""

from __future__ import annotations

import hashlib
import threading
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import pyarrow as pa

from ... import __version__
from ...chunks import ERROR
from ...configuration import MANOEUVRES, digest
from ...engine.cache import sources
from ...errors import WheelchairError
from ...handling.manoeuvres import Manoeuvre
from .engines import ENGINES, Engine, encoded
from .plan import Chair, Plan
from .quantities import NONE, QUANTITIES, of_run

if TYPE_CHECKING:
    from .yardstick import Yardstick

CHUNK = 256  # runs, about: what is lost when a sweep is killed, and what a worker holds in memory


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
        axes = self.plan.design.axes
        start, stop = self.bounds(chunk)
        points = self.plan.design.points(start, stop)
        shown = [axis.shown(points[:, i]) for i, axis in enumerate(axes)]
        rows = []
        for i in range(stop - start):
            values = {axis.name: float(points[i, k]) for k, axis in enumerate(axes)}
            about = {"chair": start + i, **{axis.name: shown[k][i] for k, axis in enumerate(axes)}}
            rows += [{**about, **row} for row in _of_chair(self, values)]
        return pa.Table.from_pylist(rows, schema=self.schema())


def prepare(job: Job) -> None:
    """Compile or build what the runs need, once for all processes that share the cache."""
    for chair in job.plan.chairs:
        _bench(job, chair)


def _of_chair(job: Job, values: Mapping[str, float]) -> Iterator[dict[str, Any]]:
    for chair in job.plan.chairs:
        bench = _bench(job, chair)
        for course in job.plan.courses:
            options = {f"manoeuvre.{name}": value for name, value in course.options}
            yield {"variant": chair.label, "manoeuvre": course.label, **options, **bench.manoeuvre(course.label, values)}
        if job.yardsticks:
            yield {"variant": chair.label, "manoeuvre": f"campaign {job.campaign}", **bench.campaign(values)}


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

    def manoeuvre(self, label: str, values: Mapping[str, float]) -> dict[str, Any]:
        m, given = self.courses[label]
        given = {**given, **values}
        try:
            results = self.engine.run(m.time, m.inputs, given)
        except WheelchairError as error:
            return {**NONE, ERROR: str(error)}
        held = given["speed.mode"] == 2
        return of_run(m.time, m.inputs, results, held=held, tread=given.get("chair.t_r", self.own["chair.t_r"]))

    def campaign(self, values: Mapping[str, float]) -> dict[str, Any]:
        from .yardstick import whitened  # brings what reads campaigns along, which most sweeps do without

        try:
            return {**NONE, **whitened(self.engine, self.variant, self.yardsticks, values)}
        except WheelchairError as error:
            return {**NONE, ERROR: str(error)}


_benches = threading.local()  # an FMU serves one thread


def _bench(job: Job, chair: Chair) -> _Bench:
    known: dict[tuple[str, str], _Bench] = _benches.__dict__.setdefault("known", {})
    key = (job.fingerprint, chair.label)
    if key not in known:
        if any(other != job.fingerprint for other, _ in known):
            known.clear()  # a worker that lives on serves one sweep at a time
        known[key] = _Bench(job, chair)
    return known[key]
