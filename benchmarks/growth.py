"""How cost grows with samples, runs, effects and chairs: the slope of each line in a log-log plot, 1 where it is linear.

Samples: evidence of one run with sensitivities by all light effects. Runs and effects: the screening of a catalogue. Chairs: a
sweep in one process. Then one hour of recordings through `wheelchair diagnose` in a process of its own.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter

import numpy as np
from matplotlib.figure import Figure

from wheelchair_fmu.campaign import Campaign, Run, read
from wheelchair_fmu.inference.estimation.fit import fit
from wheelchair_fmu.inference.estimation.problem import start_values
from wheelchair_fmu.inference.evidence.evidence import Evidence
from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.inference.models.hypothesis import Model
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.search.screen import screen
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies.sweep import prepare

from . import large, sweep_cost
from .loop_cost import SAMPLE
from .rows import Row

LINEAR, REPEATS = 1.1, 2
MINUTES, GIGABYTES = 5.0, 2.0  # of a diagnosis of one hour


@dataclass(frozen=True)
class Line:
    """Seconds (k,) at sizes (k,)."""

    of: str
    sizes: np.ndarray
    seconds: np.ndarray

    @property
    def slope(self) -> float:
        return float(np.polyfit(np.log(self.sizes), np.log(self.seconds), 1)[0])


def lines() -> list[Line]:
    measured = read(SAMPLE)
    return [_samples(measured), _runs(measured), _effects(measured), _chairs()]


def rows(found: Sequence[Line]) -> Iterator[Row]:
    for line in found:
        took = f"{line.seconds[0]:.2g} s at {line.sizes[0]:g}, {line.seconds[-1]:.2g} s at {line.sizes[-1]:g}"
        yield Row(f"growth with {line.of}: slope", "", [line.slope], LINEAR, note=took)
    if sys.platform != "win32":
        with tempfile.TemporaryDirectory() as place:
            cost = large.cost(["diagnose", large.make(Path(place) / "hour", runs=4, minutes=15.0)])
        yield Row("diagnose, one hour at 100 Hz", "min", [cost.seconds / 60], MINUTES, note="by windows")
        yield Row("diagnose, one hour at 100 Hz: memory", "GB", [cost.gigabytes], GIGABYTES)


def figure(found: Sequence[Line]) -> Figure:
    """Seconds against size, one panel for each line, with its slope."""
    shown = Figure(figsize=(11, 3), layout="constrained")
    for ax, line in zip(shown.subplots(1, len(found)), found, strict=True):
        ax.loglog(line.sizes, line.seconds, "o-")
        ax.loglog(line.sizes, line.seconds[-1] * line.sizes / line.sizes[-1], ":", color="0.5", label="linear")
        ax.set(title=f"slope {line.slope:.2f}", xlabel=line.of, ylabel="time [s]")
        ax.set_xticks(line.sizes, [f"{size:g}" for size in line.sizes])
        ax.xaxis.minorticks_off()
        ax.legend(frameon=False)
    return shown


def _line(of: str, calls: dict[int, Callable[[], object]]) -> Line:
    """The least of some repeats at each size."""
    return Line(of, np.array(list(calls), float), np.array([_least(call) for call in calls.values()]))


def _least(call: Callable[[], object]) -> float:
    took = []
    for _ in range(REPEATS):
        start = perf_counter()
        call()
        took.append(perf_counter() - start)
    return min(took)


def _samples(measured: Campaign) -> Line:
    """Runs put end to end, at their own sampling."""
    run = max(measured.runs, key=lambda r: len(r.time))
    longer = {len(run.time) * times: _repeated(run, times) for times in (1, 2, 4, 8)}
    likelihood = ModelFactory(replace(measured, runs=(run,)), Variant()).wide()
    by = [n for n in likelihood.sensitivities.columns if n.startswith("effect.")]
    return _line("samples", {n: (lambda r=r: likelihood.evidence([r], {}, by)) for n, r in longer.items()})


def _repeated(run: Run, times: int) -> Run:
    step = run.time[-1] - run.time[-2]
    time = np.concatenate([run.time + i * (run.time[-1] - run.time[0] + step) for i in range(times)])
    inputs, channels = ({n: np.tile(v, times) for n, v in series.items()} for series in (run.inputs, run.channels))
    return replace(run, time=time, inputs=inputs, channels=channels)


def _runs(measured: Campaign) -> Line:
    copies = [replace(run, name=f"{run.name}-{i}") for i in range(3) for run in measured.fit]
    return _line("runs", {n: _screening(replace(measured, runs=tuple(copies[:n]))) for n in (2, 4, 8, 16)})


def _effects(measured: Campaign) -> Line:
    """Parts of the library, drawn at random."""
    names = [*np.random.default_rng(0).permutation(list(bundled()))]
    models, base = _fitted(measured)
    return _line("effects", {n: (lambda some=names[:n]: screen(models, base, some)) for n in (4, 8, 16, len(names))})


def _screening(measured: Campaign) -> Callable[[], object]:
    models, base = _fitted(measured)
    return lambda: screen(models, base)


def _fitted(measured: Campaign) -> tuple[Models, Model]:
    """Models that are compiled, and the calibrated one."""
    models = Models.of(ModelFactory(measured, Variant()))
    likelihood, names = models.likelihood(), models.names(())
    start = start_values(likelihood, names)
    base = Model((), fit(likelihood, names, start), Evidence((), ()))
    screen(models, base)
    return models, base


def _chairs() -> Line:
    whole = sweep_cost.job()
    prepare(whole)
    jobs = {
        n: replace(whole, chunk=n, plan=replace(whole.plan, design=replace(whole.plan.design, samples=n)))
        for n in (64, 256, 1024, 4096)
    }
    return _line("chairs", {n: (lambda job=job: job.table(0)) for n, job in jobs.items()})
