"""Drive an FMU 2.0 for co-simulation by fmpy, over sampled inputs that are linear between samples.

`fmpy.simulate_fmu` cannot do this exactly: at a sample it sets the slope of the interval before, and it knows even
time grids only. Here fmpy loads and calls the FMU, and the loop over samples is our own: each interval is one
communication step with the slope that leads to the next sample, so recorded clocks may be uneven.
"""

from __future__ import annotations

import ctypes
import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from math import inf
from pathlib import Path
from types import TracebackType
from typing import Any

import fmpy
import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave
from fmpy.model_description import ModelDescription, ScalarVariable

from ..errors import Failure, SimulationError, UsageError, unknown
from ..model.former import current
from ..model.variant import number
from ..quantities import Parameter, Unit
from .loading import loaded

Values = Mapping[str, float | str]
WARNING = 1  # fmi2Warning; what is above it stops the run


@dataclass(frozen=True, eq=False)
class Result:
    """Times (n,) and every output (n,) by its FMI name, SI units; what the FMU warned of on the way."""

    time: np.ndarray
    columns: Mapping[str, np.ndarray]
    units: Mapping[str, str]
    warnings: tuple[str, ...] = ()

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self.columns:
            raise unknown("output", name, self.columns)
        return self.columns[name]


class Fmu:
    """An FMU, unpacked and loaded once, for any number of runs. A context manager; not for several threads.

    Raises Failure for a file that is no FMU 2.0 for co-simulation on this platform.
    """

    def __init__(self, path: str | Path):
        self.path = Path(path)
        self.description = _description(self.path)
        self._folder = tempfile.mkdtemp(prefix="wheelchair-")
        self._said: list[tuple[int, str]] = []
        self._slave: FMU2Slave | None = None
        try:
            fmpy.extract(str(self.path), self._folder)
        except Exception:
            self.close()
            raise
        by_causality: dict[str, list[ScalarVariable]] = {}
        for v in self.description.modelVariables:
            by_causality.setdefault(v.causality, []).append(v)
        self._inputs = [v for v in by_causality.get("input", ()) if v.type == "Real"]
        self._outputs = [v for v in by_causality.get("output", ()) if v.type == "Real"]
        self._flags = [v for v in by_causality.get("output", ()) if v.type == "Boolean"]
        self._settable = {v.name: v for v in by_causality.get("parameter", ())}
        self.parameters = {name: _record(v) for name, v in self._settable.items()}

    def __enter__(self) -> Fmu:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Unload the FMU and remove its unpacked files."""
        self._drop()
        shutil.rmtree(self._folder, ignore_errors=True)

    @property
    def _name(self) -> str:
        return str(self.description.modelName)

    @property
    def outputs(self) -> tuple[str, ...]:
        return tuple(v.name for v in (*self._outputs, *self._flags))

    def checked(self, values: Values) -> dict[str, float]:
        """The values as numbers, named choices included. Former names that the FMU does not have are read, with a warning.

        Raises UsageError for an unknown name and for a value outside the bounds that the FMU states.
        """
        starts = {name: v.start for name, v in self._settable.items() if v.type == "Real"}
        given = current(values, {name: float(start or 0.0) for name, start in starts.items()}, known=self.parameters)
        return {name: _number(self.parameters, name, value) for name, value in given.items()}

    def run(self, time: np.ndarray, inputs: Mapping[str, np.ndarray], values: Values | None = None) -> Result:
        """Simulate over `time` (n,), strictly rising, with `inputs` (n,) by name; the rest stay at their start values.

        Raises UsageError for an unknown name or a value out of bounds, and SimulationError, with the FMU's own
        sentence, where it refuses or cannot go on. After either the FMU is ready for the next run.
        """
        t = np.ascontiguousarray(time, float)
        if len(t) < 2 or not np.all(np.diff(t) > 0):
            raise SimulationError("time does not rise from sample to sample; sort the samples and drop repeated ones")
        w = self._table(len(t), inputs)
        numbers = self.checked(values or {})
        self._said.clear()
        try:
            y, flags = self._simulate(t, w, numbers)
        except FMICallException as error:
            self._drop()  # what state it is in, nobody knows
            raise SimulationError(f"{self._name}: {self._last_words() or error}") from error
        columns = dict(zip(self.outputs, np.ascontiguousarray(np.hstack([y, flags]).T), strict=True))
        units = {v.name: _unit(v) for v in (*self._inputs, *self._outputs, *self._flags)}
        return Result(t, columns, units, tuple(text for status, text in self._said if status == WARNING))

    def _table(self, n: int, inputs: Mapping[str, np.ndarray]) -> np.ndarray:
        """All inputs, (n, nw): given, or at their start values."""
        names = [v.name for v in self._inputs]
        w = np.tile([float(v.start or 0.0) for v in self._inputs], (n, 1))
        for name, column in inputs.items():
            if name not in names:
                raise unknown(f"input of {self._name}", name, names)
            w[:, names.index(name)] = column
        return w

    def _simulate(self, t: np.ndarray, w: np.ndarray, numbers: Mapping[str, float]) -> tuple[np.ndarray, np.ndarray]:
        """Outputs (n, ny) and flags (n, nb). Raises FMICallException where the FMU refuses."""
        slave = self._fresh()
        call, nw, ny, nb = slave.component, len(self._inputs), len(self._outputs), len(self._flags)
        to, of, at = (_references(group) for group in (self._inputs, self._outputs, self._flags))
        first_order = (ctypes.c_int * nw)(*[1] * nw)
        with np.errstate(invalid="ignore"):  # ∞ − ∞; the FMU refuses such a push by name
            slopes = np.ascontiguousarray(np.diff(w, axis=0) / np.diff(t)[:, None])
        bends = self.description.coSimulation.canInterpolateInputs
        y, flags = np.empty((len(t), ny)), np.empty((len(t), nb), np.int32)
        slave.setupExperiment(startTime=t[0])
        self._set(slave, numbers)
        slave.fmi2SetReal(call, to, nw, _row(w, 0))
        slave.enterInitializationMode()
        slave.exitInitializationMode()
        for i in range(len(t)):
            slave.fmi2SetReal(call, to, nw, _row(w, i))
            slave.fmi2GetReal(call, of, ny, _row(y, i))
            if nb:
                slave.fmi2GetBoolean(call, at, nb, _row(flags, i, ctypes.c_int))
            if i + 1 < len(t):
                if bends:
                    slave.fmi2SetRealInputDerivatives(call, to, nw, first_order, _row(slopes, i))
                slave.doStep(t[i], t[i + 1] - t[i])
        return y, flags

    def _set(self, slave: FMU2Slave, numbers: Mapping[str, float]) -> None:
        for name, value in numbers.items():
            v = self._settable[name]
            if v.type == "Real":
                slave.setReal([v.valueReference], [value])
            else:
                slave.setInteger([v.valueReference], [int(value)])

    def _fresh(self) -> FMU2Slave:
        """The instance, as after fmi2Instantiate."""
        if self._slave:
            self._slave.reset()
            return self._slave
        try:
            self._slave = loaded(self._folder, self.description, self._log)
        except Exception as error:  # fmpy raises OSError, FMICallException or a bare Exception
            raise SimulationError(f"{self._name}: cannot be loaded: {self._last_words() or _one_line(error)}") from error
        return self._slave

    def _drop(self) -> None:
        if self._slave:
            self._slave.freeInstance()
        self._slave = None

    def _log(self, environment: Any, instance: bytes, status: int, category: bytes, text: bytes, *rest: Any) -> None:
        self._said.append((status, text.decode(errors="replace")))

    def _last_words(self) -> str:
        """The last sentence that was more than a warning."""
        return next((text for status, text in reversed(self._said) if status > WARNING), "")


def _description(path: Path) -> ModelDescription:
    if not path.is_file():
        raise Failure(f"{path}: no such file; build one with `wheelchair build`")
    try:
        description = fmpy.read_model_description(str(path))
    except Exception as error:  # fmpy raises whatever its parsers raise
        raise Failure(f"{path}: not an FMU: {_one_line(error)}; give a file that `fmpy validate` accepts") from error
    if description.fmiVersion != "2.0" or description.coSimulation is None:
        raise Failure(
            f"{path}: FMI {description.fmiVersion} without co-simulation by FMI 2.0; give an FMU 2.0 for co-simulation"
        )
    platforms = fmpy.supported_platforms(str(path))
    if fmpy.platform not in platforms:
        raise Failure(f"{path}: built for {', '.join(platforms) or 'no platform'}, not for {fmpy.platform}; build it here")
    return description


def _one_line(error: Exception) -> str:
    return " ".join(str(error).split()) or type(error).__name__


def _record(v: ScalarVariable) -> Parameter:
    """The bounds and choices of a variable, as far as its FMU tells."""
    choices = tuple(item.name for item in v.declaredType.items) if v.type == "Enumeration" else ()
    lower, upper = (float(x) if x is not None else y for x, y in ((v.min, -inf), (v.max, inf)))
    return Parameter(v.name, Unit(_unit(v)), lower=lower, upper=upper, choices=choices)


def _number(records: Mapping[str, Parameter], name: str, value: float | str) -> float:
    """As `model.variant.number`; the number of a choice is as good as its name."""
    record = records.get(name)
    if record and record.choices and not isinstance(value, str):
        if value not in range(1, len(record.choices) + 1):
            raise UsageError(f"{name} = {value:g}: choose one of {', '.join(record.choices)}")
        return float(value)
    return number(records, name, value)


def _unit(v: ScalarVariable) -> str:
    return str(v.unit or "1")


def _references(variables: list[ScalarVariable]) -> ctypes.Array:
    return (ctypes.c_uint32 * len(variables))(*(v.valueReference for v in variables))


def _row(table: np.ndarray, i: int, kind: Any = ctypes.c_double) -> ctypes.Array:
    """Row i of a table, shared with C and not copied."""
    width = table.shape[1]
    return (kind * width).from_buffer(table, i * width * ctypes.sizeof(kind))
