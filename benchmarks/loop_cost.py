"""What the loop costs on the sample campaign, beside refitting every effect through fmpy and SciPy.

Compiled code is cached. The peer refits the calibrated values and one effect by `least_squares` on all fitted runs, each driven
by `fmpy.simulate_fmu` (FMU unpacked once, one instance that is reset, only the outputs that were measured, no estimate of the
start); it is timed for some effects of the default FMU, and would take as long for each of the others. It is given all cores,
an effect on each, and as many linearisations as our own fits: with differences through an integrator that chooses its steps,
it goes on for an hour.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import redirect_stdout
from io import StringIO
from os import cpu_count
from pathlib import Path
from time import perf_counter

import fmpy
import numpy as np
from fmpy.simulation import instantiate_fmu
from scipy.optimize import least_squares
from threadpoolctl import threadpool_limits

from wheelchair_fmu.campaign import CHANNELS, Campaign, read
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.estimation.fit import MOST
from wheelchair_fmu.inference.models.factory import CALIBRATED, ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.search.beginning import begin
from wheelchair_fmu.inference.search.screen import screen
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.generic import library
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies import fmu_of

from .rows import Row, timed

SAMPLE = Path(__file__).parent.parent / "examples" / "sample-campaign"
SCREEN, WHOLE, TIMES = 1.0, 10.0, 30.0  # s, s, times faster
REFITTED = ("effect.rolling_resistance_asymmetry.D", "effect.aerodynamic_drag.k")


class _Peer:
    """Fits by fmpy and SciPy."""

    def __init__(self, measured: Campaign):
        self.measured = measured
        self.folder = fmpy.extract(str(fmu_of(Variant())))
        self.description = fmpy.read_model_description(self.folder)
        self.instance = instantiate_fmu(self.folder, self.description, "CoSimulation")
        self.there = {v.name for v in self.description.modelVariables}
        self.records = {p.name: p for p in Variant().with_effects(bundled()).parameters()}

    def residuals(self, values: dict[str, float]) -> np.ndarray:
        return np.concatenate([self._of_run(run, values) for run in self.measured.fit])

    def _of_run(self, run, values: dict[str, float]) -> np.ndarray:
        self.instance.reset()
        shown = {c.name: c.fmu for c in CHANNELS if c.name in run.channels}
        signals = np.rec.fromarrays([run.time, *run.inputs.values()], names=["time", *run.inputs])
        given = {**self.measured.known, **values, **run.set, "start.u": run.u0}
        with redirect_stdout(StringIO()):  # fmpy says each time which inputs are left at their start values
            done = fmpy.simulate_fmu(
                self.folder,
                stop_time=run.time[-1],
                output_interval=0.01,
                input=signals,
                output=list(shown.values()),
                start_values={n: v for n, v in given.items() if n in self.there},
                model_description=self.description,
                fmu_instance=self.instance,
            )
        n = min(len(run.time), len(done))
        return np.concatenate([(run.channels[c][:n] - done[fmu][:n]) / self.measured.noise[c] for c, fmu in shown.items()])

    def refit(self, effect: str) -> float:
        """Seconds of a refit with one more parameter."""
        names = (*CALIBRATED, effect)
        start = np.array([self.measured.known.get(n, self.records[n].default) for n in names])
        scale = np.array([self.records[n].smallest_interesting or self.records[n].nominal for n in names])
        start_time = perf_counter()
        least_squares(
            lambda q: self.residuals(dict(zip(names, q, strict=True))),
            start,
            x_scale=scale,
            bounds=([self.records[n].lower for n in names], [self.records[n].upper for n in names]),
            max_nfev=MOST,
        )
        return perf_counter() - start_time


def rows() -> Iterator[Row]:
    measured = read(SAMPLE)
    begun = begin(Models.of(ModelFactory(measured, Variant())))
    count, cores = len(begun.models.factory.catalogue), cpu_count() or 1
    with threadpool_limits(limits=1):  # as in diagnose: cores are for runs
        screens = [ms / 1e3 for ms in timed(lambda: screen(begun.models, begun.calibrated), 5)]
    yield Row(f"screening {count} effects on {len(measured.runs)} runs", "s", screens, SCREEN, note="tangents and secants")
    whole = [ms / 1e3 for ms in timed(lambda: diagnose(measured, generic=library()), 3)]
    yield Row("the whole diagnose", "s", whole, WHOLE)
    peer = _Peer(measured)
    refits = [count / cores * peer.refit(effect) for effect in REFITTED]
    yield Row("the whole diagnose", "s", whole, TIMES, float(np.median(refits)), "beside fmpy and SciPy")
    yield Row(f"refitting {count} effects by fmpy and SciPy", "s", refits, note=f"{len(REFITTED)} are timed; on {cores} cores")
