"""What simulates a sweep's chairs: the compiled kernel, or the FMU through fmpy. Both give results by FMI name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Protocol

import numpy as np

from ...engine.simulate import Simulator
from ...model.choice import names
from ...model.variant import Variant, number
from ..archives import fmu_of
from ..driving import Fmu

Values = Mapping[str, float]
TOLERANCE = 1e-6  # of the kernel's steps, which are free of the FMU's grid


class Engine(Protocol):
    """One variant, ready to run with any values (numbers, SI units; choices by their number)."""

    def run(self, time: np.ndarray, inputs: Mapping[str, np.ndarray], values: Values) -> Mapping[str, np.ndarray]: ...


class KernelEngine:
    """The compiled step map, called in this process; one library for each of the tyre `laws`, by their numbers."""

    def __init__(self, variant: Variant, laws: Iterable[int] = ()):
        self._own = variant.vector()
        self._places = {p.name: i for i, p in enumerate(variant.parameters())}
        own = int(self._own[self._places["tyre.law"]])
        self._simulators = {
            n: Simulator(variant.with_values({"tyre.law": names(variant.choice)["tyre"][n - 1]})) for n in {own, *laws}
        }

    def run(self, time: np.ndarray, inputs: Mapping[str, np.ndarray], values: Values) -> Mapping[str, np.ndarray]:
        p = self._own.copy()
        for name, value in values.items():
            p[self._places[name]] = value
        simulator = self._simulators[int(p[self._places["tyre.law"]])]
        trajectory = simulator.run(time, simulator.inputs(len(time), inputs), p, tolerance=TOLERANCE)
        return dict(zip(trajectory.names, trajectory.results.T, strict=True))


class FmuEngine:
    """The FMU that `build_fmu.py` makes of the variant, with its default effects, driven by fmpy."""

    def __init__(self, variant: Variant, laws: Iterable[int] = ()):
        self._fmu = Fmu(fmu_of(variant))
        self._own = {name: value for name, value in variant.values.items() if name in self._fmu.parameters}
        self._own["tyre.law"] = 1 + names(variant.choice)["tyre"].index(variant.choice.tyre)

    def run(self, time: np.ndarray, inputs: Mapping[str, np.ndarray], values: Values) -> Mapping[str, np.ndarray]:
        values = {name: value for name, value in values.items() if name in self._fmu.parameters}  # a record's delay is not
        return self._fmu.run(time, inputs, {**self._own, **values}).columns


ENGINES: dict[str, type[KernelEngine] | type[FmuEngine]] = {"kernel": KernelEngine, "fmu": FmuEngine}


def encoded(variant: Variant, values: Mapping[str, float | str]) -> dict[str, float]:
    """Values as numbers, choices by their number; those that the variant does not know are left out."""
    records = {p.name: p for p in variant.parameters()}
    return {
        name: number(records, name, value) if isinstance(value, str) else float(value)
        for name, value in values.items()
        if name in records
    }
