"""What simulates a sweep's chairs: the compiled kernel, several at once, or the FMU through fmpy, one by one."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Protocol, cast

import numpy as np

from ...engine.ensemble import Ensemble, Runs, making
from ...engine.simulate import Simulator
from ...errors import WheelchairError
from ...model.choice import names
from ...model.variant import Variant, number

if TYPE_CHECKING:
    from .. import Fmu

Values = Mapping[str, float]
TOLERANCE = 1e-6  # of the kernel's steps, which are free of the FMU's grid


class Engine(Protocol):
    """One variant, ready to run with any values (numbers, SI units; choices by their number), from several threads at once."""

    def run(self, time: np.ndarray, inputs: Mapping[str, np.ndarray], chairs: Sequence[Values], wanted: Sequence[str]) -> Runs:
        """Chairs, by their values, through the same inputs; the results that are wanted, by FMI name."""
        ...


class KernelEngine:
    """The compiled step map, called in this process; one library for each of the tyre `laws`, by their numbers."""

    def __init__(self, variant: Variant, laws: Iterable[int] = ()):
        self._own = variant.vector()
        self._places = {p.name: i for i, p in enumerate(variant.parameters())}
        own = int(self._own[self._places["tyre.law"]])
        self._simulators = {
            n: Simulator(variant.with_values({"tyre.law": names(variant.choice)["tyre"][n - 1]})) for n in {own, *laws}
        }
        self._ensembles: dict[tuple[int, tuple[str, ...]], Ensemble] = {}
        self._own_of = threading.local()  # of each thread the memory of its results, kept from run to run

    def run(self, time: np.ndarray, inputs: Mapping[str, np.ndarray], chairs: Sequence[Values], wanted: Sequence[str]) -> Runs:
        p = np.tile(self._own, (len(chairs), 1))
        for row, values in zip(p, chairs, strict=True):
            for name, value in values.items():
                row[self._places[name]] = value
        laws = p[:, self._places["tyre.law"]].astype(int)
        if len(set(laws)) == 1:
            return self._of_law(int(laws[0]), time, inputs, p, tuple(wanted))
        runs = Runs(np.empty((len(chairs), len(wanted), len(time))), [None] * len(chairs))
        for law in sorted(set(laws)):
            some = np.flatnonzero(laws == law)
            runs.put(some, self._of_law(int(law), time, inputs, p[some], tuple(wanted)))
        return runs

    def _of_law(
        self, law: int, time: np.ndarray, inputs: Mapping[str, np.ndarray], p: np.ndarray, wanted: tuple[str, ...]
    ) -> Runs:
        with making:
            if (law, wanted) not in self._ensembles:
                self._ensembles[law, wanted] = Ensemble(self._simulators[law], wanted)
            ensemble = self._ensembles[law, wanted]
        rows = ensemble.simulator.inputs(len(time), inputs)
        return ensemble.run(time, rows, p, tolerance=TOLERANCE, memory=self._memory(len(p) * len(wanted) * len(time)))

    def _memory(self, numbers: int) -> np.ndarray:
        """At least so many, of this thread."""
        kept: np.ndarray | None = getattr(self._own_of, "results", None)
        if kept is None or len(kept) < numbers:
            kept = self._own_of.results = np.empty(numbers)
        return kept


class FmuEngine:
    """The FMU that `build_fmu.py` makes of the variant, with its default effects, driven by fmpy."""

    def __init__(self, variant: Variant, laws: Iterable[int] = ()):
        from .. import Fmu, fmu_of  # brings fmpy along, which the kernel does without

        self._fmus = threading.local()  # one serves one thread
        self._make: Callable[[], Fmu] = partial(Fmu, fmu_of(variant))
        self._own = {name: value for name, value in variant.values.items() if name in self._fmu().parameters}
        self._own["tyre.law"] = 1 + names(variant.choice)["tyre"].index(variant.choice.tyre)

    def run(self, time: np.ndarray, inputs: Mapping[str, np.ndarray], chairs: Sequence[Values], wanted: Sequence[str]) -> Runs:
        runs = Runs(np.full((len(chairs), len(wanted), len(time)), np.nan), [None] * len(chairs))
        fmu = self._fmu()
        for i, chair in enumerate(chairs):
            values = {name: value for name, value in chair.items() if name in fmu.parameters}  # a record's delay is not
            try:
                columns = fmu.run(time, inputs, {**self._own, **values}).columns
            except WheelchairError as error:
                runs.errors[i] = str(error)
            else:
                runs.results[i] = [columns[name] for name in wanted]
        return runs

    def _fmu(self) -> Fmu:
        """This thread's."""
        if not hasattr(self._fmus, "own"):
            self._fmus.own = self._make()
        return cast("Fmu", self._fmus.own)


ENGINES: dict[str, type[KernelEngine] | type[FmuEngine]] = {"kernel": KernelEngine, "fmu": FmuEngine}


def encoded(variant: Variant, values: Mapping[str, float | str]) -> dict[str, float]:
    """Values as numbers, choices by their number; those that the variant does not know are left out."""
    records = {p.name: p for p in variant.parameters()}
    return {
        name: number(records, name, value) if isinstance(value, str) else float(value)
        for name, value in values.items()
        if name in records
    }
