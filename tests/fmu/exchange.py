"""One instance in Model Exchange, of either version of FMI, as SciPy sees it: x' = f(t, x)."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

import fmpy
import numpy as np
from fmpy.fmi2 import (
    FMU2Model,
    fmi2CallbackAllocateMemoryTYPE,
    fmi2CallbackFreeMemoryTYPE,
    fmi2CallbackFunctions,
    fmi2CallbackLoggerTYPE,
)
from fmpy.fmi3 import FMU3Model

from .chair import Chair, Chair3, Unpacked


class _Exchange:
    """What both versions do alike; mixed into the drivers of Co-Simulation, whose get and set are the same."""

    def enter(self, values: Mapping[str, float] | None = None):
        self.start(values)
        self.event()
        return self

    def event(self) -> bool:
        """From event mode into continuous time; whether states have jumped."""
        jumped = (self.fmu.newDiscreteStates if self.version == 2 else self.fmu.updateDiscreteStates)()[3]
        self.fmu.enterContinuousTimeMode()
        return bool(jumped)

    @property
    def size(self) -> int:
        return self.unpacked.description.numberOfContinuousStates

    def states(self) -> np.ndarray:
        return self._vector(self.fmu.getContinuousStates, self.size)

    def nominals(self) -> np.ndarray:
        return self._vector(self.fmu.getNominalsOfContinuousStates, self.size)

    def indicators(self) -> np.ndarray:
        return self._vector(self.fmu.getEventIndicators, self.unpacked.description.numberOfEventIndicators)

    def rates(self) -> np.ndarray:
        return self._vector(self.fmu.getDerivatives if self.version == 2 else self.fmu.getContinuousStateDerivatives, self.size)

    def put(self, x) -> None:
        self.fmu.setContinuousStates((ctypes.c_double * len(x))(*x), len(x))

    def f(self, t: float, x) -> np.ndarray:
        self.fmu.setTime(t)
        self.put(x)
        return self.rates()

    @staticmethod
    def _vector(call, n: int) -> np.ndarray:
        values = (ctypes.c_double * n)()
        call(values, n)
        return np.array(values)


class Exchange2(_Exchange, Chair):
    version = 2

    def __init__(self, unpacked: Unpacked, logging: bool = False):
        d = unpacked.description
        self.unpacked, self.said, self.time = unpacked, [], 0.0
        self.types = {v.name: v for v in d.modelVariables}
        self.fmu = FMU2Model(
            guid=d.guid,
            unzipDirectory=str(unpacked.folder),
            instanceName="chair",
            modelIdentifier=d.modelExchange.modelIdentifier,
        )
        callbacks = fmi2CallbackFunctions()
        callbacks.logger = fmi2CallbackLoggerTYPE(self._log)
        callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(fmpy.calloc)
        callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(fmpy.free)
        self.fmu.instantiate(callbacks=callbacks, loggingOn=logging)


class Exchange3(_Exchange, Chair3):
    version = 3

    def __init__(self, unpacked: Unpacked, logging: bool = False):
        d = unpacked.description
        self.unpacked, self.said, self.time, self.failed = unpacked, [], 0.0, []
        self.types = {v.name: v for v in d.modelVariables}
        self.fmu = FMU3Model(
            guid=d.guid,
            unzipDirectory=str(unpacked.folder),
            instanceName="chair",
            modelIdentifier=d.modelExchange.modelIdentifier,
        )
        self.fmu.instantiate(loggingOn=logging, logMessage=self._log3)


@contextmanager
def exchange(unpacked: Unpacked, **options) -> Iterator[Exchange2 | Exchange3]:
    made = (Exchange2 if unpacked.description.fmiVersion == "2.0" else Exchange3)(unpacked, **options)
    try:
        yield made
    finally:
        made.free()
