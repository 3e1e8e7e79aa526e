"""An unpacked FMU, by the names of its variables, and what it says."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import fmpy
from fmpy.fmi2 import (
    FMU2Slave,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
)
from fmpy.fmi3 import FMU3Slave
from fmpy.model_description import ModelDescription

from wheelchair_fmu.engine import compiler

DISCARD, ERROR = 2, 3
FEW = "gyro_scale,wheel_inertia"  # effects of an FMU that is soon compiled


@dataclass(frozen=True)
class Unpacked:
    """An FMU, its folder and its description."""

    path: Path
    folder: Path
    description: ModelDescription

    @staticmethod
    def of(path: Path, folder: Path) -> Unpacked:
        fmpy.extract(str(path), str(folder))
        return Unpacked(path, folder, fmpy.read_model_description(str(path)))

    @property
    def library(self) -> Path:
        return next((self.folder / "binaries").glob(f"*/*{compiler.SUFFIX}"))

    def reference(self, name: str) -> int:
        return next(v.valueReference for v in self.description.modelVariables if v.name == name)

    def names(self, causality: str, kind: str = "Real") -> list[str]:
        return [v.name for v in self.description.modelVariables if v.causality == causality and v.type == kind]

    @property
    def derivatives(self) -> list[str]:
        return [v.name for v in self.description.modelVariables if v.derivative is not None]


class Chair:
    """One instance. `said` collects (status, category, sentence)."""

    def __init__(self, unpacked: Unpacked, name: str = "chair", logging: bool = False, free=None):
        d = unpacked.description
        self.unpacked, self.said, self.time = unpacked, [], 0.0
        self.types = {v.name: v for v in d.modelVariables}
        self.fmu = FMU2Slave(
            guid=d.guid, unzipDirectory=str(unpacked.folder), instanceName=name, modelIdentifier=d.coSimulation.modelIdentifier
        )
        callbacks = fmi2CallbackFunctions()
        callbacks.logger = fmi2CallbackLoggerTYPE(self._log)
        callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(fmpy.calloc)
        callbacks.freeMemory = free or fmi2CallbackFreeMemoryTYPE(fmpy.free)
        self.fmu.instantiate(callbacks=callbacks, loggingOn=logging)

    def _log(self, environment, name, status, category, text, *rest) -> None:
        self.said.append((status, category.decode(), text.decode()))

    @property
    def sentences(self) -> list[str]:
        return [text for status, _, text in self.said if status > 0]

    def start(self, values: Mapping[str, float] | None = None, time: float = 0.0, **setup) -> Chair:
        self.time = time
        self.fmu.setupExperiment(startTime=time, **setup)
        self.set(values or {})
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        return self

    def set(self, values: Mapping[str, float]) -> None:
        """Reals in one call, then the rest."""
        reals = {n: v for n, v in values.items() if self.types[n].type == "Real"}
        if reals:
            self.fmu.setReal([self.types[n].valueReference for n in reals], list(reals.values()))
        for n in values.keys() - reals.keys():
            self.fmu.setInteger([self.types[n].valueReference], [int(values[n])])

    def get(self, *names: str) -> list[float]:
        call = {"Real": self.fmu.getReal, "Boolean": self.fmu.getBoolean, "Enumeration": self.fmu.getInteger}
        return [call[self.types[n].type]([self.types[n].valueReference])[0] for n in names]

    def outputs(self) -> list[float]:
        return self.fmu.getReal([self.unpacked.reference(n) for n in self.unpacked.names("output")])

    def step(self, h: float, count: int = 1) -> Chair:
        for _ in range(count):
            self.fmu.doStep(self.time, h)
            self.time += h
        return self

    def free(self) -> None:
        self.fmu.fmi2FreeInstance(self.fmu.component)

    def save(self):
        return self.fmu.getFMUstate()

    def restore(self, state) -> None:
        self.fmu.setFMUstate(state)

    def drop(self, state) -> None:
        self.fmu.freeFMUstate(state)

    def serialized(self) -> bytes:
        """The state as it is now."""
        state = self.save()
        made = self.fmu.serializeFMUstate(state)
        self.drop(state)
        return made

    def deserialized(self, serialized: bytes):
        return self.fmu.deSerializeFMUstate(serialized)

    def revive(self, serialized: bytes) -> None:
        state = self.deserialized(serialized)
        self.restore(state)
        self.drop(state)


class Chair3(Chair):
    """The same by FMI 3.0. `update`, where given, is called in intermediate updates; see fmi3IntermediateUpdateCallback."""

    def __init__(self, unpacked: Unpacked, name: str = "chair", logging: bool = False, update=None, early: bool = False):
        d = unpacked.description
        self.unpacked, self.said, self.time = unpacked, [], 0.0
        self.types = {v.name: v for v in d.modelVariables}
        self.fmu = FMU3Slave(
            guid=d.guid, unzipDirectory=str(unpacked.folder), instanceName=name, modelIdentifier=d.coSimulation.modelIdentifier
        )
        self.failed: list[BaseException] = []
        self.fmu.instantiate(
            loggingOn=logging,
            earlyReturnAllowed=early,
            logMessage=self._log3,
            intermediateUpdate=update and self._guarded(update),
        )

    def _log3(self, environment, status, category, text) -> None:
        self._log(environment, b"", status, category, text)

    def _guarded(self, update):
        """ctypes swallows what a callback raises; it is kept, and raised when the instance is freed."""

        def guarded(*words) -> None:
            try:
                update(*words)
            except BaseException as error:
                self.failed.append(error)

        return guarded

    def start(self, values: Mapping[str, float] | None = None, time: float = 0.0, **setup) -> Chair3:
        self.time = time
        self.set(values or {})
        self.fmu.enterInitializationMode(startTime=time, **setup)
        self.fmu.exitInitializationMode()
        return self

    def set(self, values: Mapping[str, float]) -> None:
        numbers = {n: v for n, v in values.items() if self.types[n].type == "Float64"}
        if numbers:
            self.fmu.setFloat64([self.types[n].valueReference for n in numbers], list(numbers.values()))
        for n in values.keys() - numbers.keys():
            self.fmu.setInt64([self.types[n].valueReference], [int(values[n])])

    def get(self, *names: str) -> list[float]:
        call = {"Float64": self.fmu.getFloat64, "Boolean": self.fmu.getBoolean, "Enumeration": self.fmu.getInt64}
        return [call[self.types[n].type]([self.types[n].valueReference])[0] for n in names]

    def outputs(self) -> list[float]:
        return self.get(*self.unpacked.names("output", "Float64"))

    def free(self) -> None:
        self.fmu.fmi3FreeInstance(self.fmu.component)
        if self.failed:
            raise self.failed[0]

    def save(self):
        return self.fmu.getFMUState()

    def restore(self, state) -> None:
        self.fmu.setFMUState(state)

    def drop(self, state) -> None:
        self.fmu.freeFMUState(state)

    def serialized(self) -> bytes:
        state = self.save()
        made = self.fmu.serializeFMUState(state)
        self.drop(state)
        return made

    def revive(self, serialized: bytes) -> None:
        state = self.fmu.deserializeFMUState(serialized)
        self.restore(state)
        self.drop(state)


@contextmanager
def chair(unpacked: Unpacked, **options) -> Iterator[Chair]:
    """An instance by the version of FMI that the archive is for."""
    kind = Chair if unpacked.description.fmiVersion == "2.0" else Chair3
    made = kind(unpacked, **options)
    try:
        yield made
    finally:
        made.free()


def pushed(i: int) -> dict[str, float]:
    """Inputs of the i-th step: strokes once a second, turning right, then left."""
    stroke = 40.0 if i % 100 < 40 else 0.0
    turn = 5.0 if (i // 100) % 2 == 0 else -6.0
    return {"push.F_rl": stroke + turn, "push.F_rr": stroke - turn}
