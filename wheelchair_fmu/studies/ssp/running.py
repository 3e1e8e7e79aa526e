"""Run a system of FMUs by fmpy.

Coupling is Jacobi's: all components step by themselves over one communication step, with inputs held, and then exchange
values. In initialization mode values go round as often as there are components. This is what libcosim's fixed-step algorithm
does, so both give the same numbers; what a component reads is one step old, and results are of first order in the step.
"""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from fmpy.model_description import ScalarVariable

from ...errors import SimulationError, SystemStructureError, UsageError, unknown
from ..driving import WARNING
from ..loading import loaded
from .binding import Values, converted, put_set
from .checking import check_system
from .reading import Archive, Fmu, opened
from .records import MAIN, System

MOST_STEPS = 10_000_000
SHOWN = ("Real", "Boolean")  # what is recorded


@dataclass(frozen=True, eq=False)
class Trace:
    """Times (n,) in s and every output (n,) as `Component.variable`, in the FMUs' units; `parameters` likewise."""

    system: System
    time: np.ndarray
    columns: Mapping[str, np.ndarray]
    units: Mapping[str, str]
    parameters: Mapping[str, float]
    warnings: tuple[str, ...] = ()

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self.columns:
            raise unknown("output", name, self.columns)
        return self.columns[name]


def run(
    path: Path, *, step: float | None = None, stop: float | None = None, description: str = MAIN, parameters: Sequence[str] = ()
) -> Trace:
    """Run a system of an archive; `step` and `stop` [s] are its own unless given, `description` says which .ssd.

    `parameters` are sets in the archive's resources that go on top of what is bound, each to the one component that has
    all its parameters. Raises SystemStructureError with every fault, UsageError for an unknown name or an impossible time,
    and SimulationError, with the FMU's own sentence, where a component cannot go on.
    """
    with opened(path) as archive:
        file = _description(archive, description)
        system, fmus, values = check_system(archive, file)
        for name in parameters:
            _put_named(archive, values, fmus, name)
        if archive.faults or system is None:
            raise SystemStructureError(archive.faults)
        times = _times(system, step, stop)
        with _slaves(fmus) as slaves:
            return _run(system, times, slaves, values)


def _description(archive: Archive, name: str) -> str:
    file = name if name.endswith(".ssd") else f"{name}.ssd"
    if file not in archive.systems():
        raise unknown(f"description in {archive.path}", file, archive.systems())
    return file


def _put_named(archive: Archive, values: Values, fmus: Mapping[str, Fmu], name: str) -> None:
    there = {f.stem: f.relative_to(archive.folder).as_posix() for f in archive.folder.glob("resources/*.ssv")}
    if name not in there:
        raise unknown(f"parameter set in {archive.path}", name, there)
    found = archive.parameter_set(there[name])
    if found is None:
        return  # why, the archive's faults say
    fits = {c: sum(p in fmu.variables for p in found.settings) for c, fmu in fmus.items()}
    put_set(archive, values, fmus, max(fits, key=lambda c: fits[c]), there[name])


def _times(system: System, step: float | None, stop: float | None) -> np.ndarray:
    """Communication points; the last step is shorter where the time is no multiple of the step."""
    h = step if step is not None else system.step if system.step is not None else 0.01
    end = stop if stop is not None else system.stop
    if end is None:
        raise UsageError("the system says no stopTime; give one with --time")
    if not 0 < h < np.inf:
        raise UsageError(f"--step {h:g} s is impossible; give a time above 0, such as 0.01")
    if not system.start < end < np.inf:
        raise UsageError(f"--time {end:g} s is not after the start at {system.start:g} s; give a later one")
    if (end - system.start) / h > MOST_STEPS:
        raise UsageError(f"--step {h:g} s makes more than {MOST_STEPS} steps; give a longer one")
    n = int((end - system.start) / h + 1e-9)
    times = system.start + h * np.arange(n + 1)
    return times if end - times[-1] <= 1e-9 * max(1.0, abs(end)) else np.append(times, end)


class _Slave:
    """One component, loaded: values by variable."""

    def __init__(self, name: str, fmu: Fmu, folder: str):
        self.name, self.fmu, self.said = name, fmu, list[tuple[int, str]]()
        try:
            fmpy.extract(str(fmu.path), folder)
            self.call: FMU2Slave = loaded(folder, fmu.description, self._log)
        except Exception as error:  # fmpy raises OSError, FMICallException or a bare Exception
            raise SimulationError(f"{name}: cannot be loaded: {self.last_words() or error}") from error
        shown = [v for v in fmu.description.modelVariables if v.causality == "output" and v.type in SHOWN]
        self.outputs = sorted(shown, key=lambda v: SHOWN.index(v.type))
        self._references = [[v.valueReference for v in shown if v.type == kind] for kind in SHOWN]

    def _log(self, environment: Any, instance: bytes, status: int, category: bytes, text: bytes, *rest: Any) -> None:
        self.said.append((status, text.decode(errors="replace")))

    def last_words(self) -> str:
        return next((text for status, text in reversed(self.said) if status > WARNING), "")

    def read(self) -> list[float]:
        """All `outputs`."""
        calls = zip((self.call.getReal, self.call.getBoolean), self._references, strict=True)
        return [float(value) for call, references in calls if references for value in call(references)]

    def get(self, v: ScalarVariable) -> float:
        read = {"Real": self.call.getReal, "Boolean": self.call.getBoolean}.get(v.type, self.call.getInteger)
        return float(read([v.valueReference])[0])

    def set(self, v: ScalarVariable, value: float) -> None:
        if v.type == "Real":
            self.call.setReal([v.valueReference], [value])
        elif v.type == "Boolean":
            self.call.setBoolean([v.valueReference], [bool(value)])
        else:
            self.call.setInteger([v.valueReference], [int(value)])


@contextmanager
def _slaves(fmus: Mapping[str, Fmu]) -> Iterator[dict[str, _Slave]]:
    with ExitStack() as stack:
        made = {}
        for name, fmu in fmus.items():
            folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="wheelchair-"))
            made[name] = _Slave(name, fmu, folder)
            stack.callback(made[name].call.freeInstance)
        yield made


@dataclass(frozen=True)
class _Wire:
    """A connection between components, looked up once."""

    start: _Slave
    output: ScalarVariable
    end: _Slave
    input: ScalarVariable
    factor: float
    offset: float

    def transfer(self, value: float) -> None:
        self.end.set(self.input, self.factor * value + self.offset)


def _wires(system: System, slaves: Mapping[str, _Slave]) -> list[_Wire]:
    wires = []
    for c in system.connections:
        if c.start_element and c.end_element:
            start, end = slaves[c.start_element], slaves[c.end_element]
            output, input_ = start.fmu.variables[c.start_connector], end.fmu.variables[c.end_connector]
            own, other = (s.fmu.units.get(v.unit or "") for s, v in ((start, output), (end, input_)))
            factor, offset = c.scaling.factor, c.scaling.offset
            if own and other and not c.scaling.suppress_units:
                zero = converted(0.0, own, other)
                slope = converted(1.0, own, other) - zero
                factor, offset = factor * slope, factor * zero + offset
            wires.append(_Wire(start, output, end, input_, factor, offset))
    return wires


def _run(system: System, times: np.ndarray, slaves: Mapping[str, _Slave], values: Values) -> Trace:
    wires = _wires(system, slaves)
    tables = [np.empty((len(times), len(s.outputs))) for s in slaves.values()]

    def each(action: str, *arguments: float) -> None:
        for slave in slaves.values():
            with _told(slave):
                getattr(slave.call, action)(*arguments)

    def exchange() -> None:
        for wire, value in [(wire, wire.start.get(wire.output)) for wire in wires]:  # all are read before one is set
            with _told(wire.end):
                wire.transfer(value)

    for slave in slaves.values():
        with _told(slave):
            slave.call.setupExperiment(startTime=times[0])
            for name, value in values[slave.name].items():
                slave.set(slave.fmu.variables[name], value)
    each("enterInitializationMode")
    for _ in slaves:
        exchange()
    each("exitInitializationMode")
    for i, t in enumerate(times):
        if i:
            each("doStep", times[i - 1], t - times[i - 1])
        for slave, table in zip(slaves.values(), tables, strict=True):
            table[i] = slave.read()
        exchange()
    units = {f"{s.name}.{v.name}": v.unit or "1" for s in slaves.values() for v in s.outputs}
    parameters = {
        f"{s.name}.{n}": s.get(v) for s in slaves.values() for n, v in s.fmu.variables.items() if v.causality == "parameter"
    }
    warnings = tuple(f"{s.name}: {text}" for s in slaves.values() for status, text in s.said if status == WARNING)
    columns = dict(zip(units, np.hstack(tables).T.copy(), strict=True))
    return Trace(system, times, columns, units, parameters, warnings)


@contextmanager
def _told(slave: _Slave) -> Iterator[None]:
    """What an FMU refuses becomes an error in its own words."""
    try:
        yield
    except FMICallException as error:
        raise SimulationError(f"{slave.name}: {slave.last_words() or error}") from error
