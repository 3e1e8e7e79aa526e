"""What a chair costs among others, side by side in the lanes of vectors, beside the same chairs one by one.

A slalom of 12 s at 100 Hz, whose pushes bend at every sample, so that each chair takes 1 200 steps; 64 chairs that differ in
mass and cornering stiffness, on one core, with the results that a sweep asks for.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from wheelchair_fmu.engine.ensemble import Ensemble
from wheelchair_fmu.engine.kernel import kernel
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.handling.manoeuvres import manoeuvre
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.studies.sweep.engines import encoded
from wheelchair_fmu.studies.sweep.quantities import READS

from . import limits
from .rows import Row, timed

CHAIRS, REPEATS = 64, 15


def rows() -> Iterator[Row]:
    variant, m = Variant(), manoeuvre("slalom")
    simulator = Simulator(variant)
    places = {p.name: i for i, p in enumerate(variant.parameters())}
    p = np.tile(variant.vector(), (CHAIRS, 1))
    for name, value in encoded(variant, m.values).items():
        p[:, places[name]] = value
    p[:, places["chair.m"]] = np.linspace(60, 100, CHAIRS)
    p[:, places["tyre.C_lambda"]] = np.linspace(2500, 10_000, CHAIRS)
    w, ensemble = simulator.inputs(len(m.time), m.inputs), Ensemble(simulator, READS)
    steps = np.mean([simulator.run(m.time, w, own).steps for own in p])
    functions = kernel(simulator.model).functions
    work = limits.of(functions["plain"]) * float(steps) + limits.of(limits.results(simulator.model, READS)) * len(m.time)
    memory = np.empty(CHAIRS * len(READS) * len(m.time))
    together = timed(lambda: ensemble.run(m.time, w, p, memory=memory), REPEATS)
    alone = timed(lambda: [simulator.run(m.time, w, own) for own in p], REPEATS)
    made = f"{steps:.0f} steps and {len(m.time)} sets of results, {work.operations / 1e6:.1f} million operations"
    per_chair = float(np.median(alone)) / CHAIRS
    core = limits.widest()
    yield Row(
        f"a chair's slalom, {core.lanes} side by side",
        "ms",
        [t / CHAIRS for t in together],
        peer=per_chair,
        note="beside the same chairs one by one",
        limit=1e3 * work.seconds(core),
        why=f"{made}, {core.lanes} at once; the rest is waiting for operands, more of which there are than registers",
    )
    yield Row(
        "a chair's slalom, one by one",
        "ms",
        [t / CHAIRS for t in alone],
        limit=1e3 * work.seconds(limits.core(1)),
        why=f"{made}, one by one; the rest is the C library's functions, and results that nobody asked for",
    )
