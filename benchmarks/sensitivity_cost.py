"""What the sensitivities of the run of `run_cost` cost, beside finite differences of CVODES runs.

All parameters that a fit may touch and the initial states among them. One-sided differences need a run for each and one more;
one CVODES run is timed, as CasADi hands it out and by the fastest of its methods, for a loop of them grows with their number
alone.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from wheelchair_fmu.engine.kernel import at_rest, kernel
from wheelchair_fmu.engine.rodas import GAMMA_I
from wheelchair_fmu.engine.sensitivities import Sensitivities
from wheelchair_fmu.engine.tangent import tangent

from . import limits
from .rows import Row, timed
from .run_cost import AS_IT_COMES, METHODS, REPEATS, TOLERANCE, Case, case, cvodes

TARGET, STAGES = 80.0, len(GAMMA_I)


def work_of(s: Sensitivities, c: Case) -> tuple[limits.Work, int]:
    """What the run and its derivatives take, and how many steps it has: each stage's slopes and bend, and the sums of
    `tangent.c`, whose rows are by states now."""
    nx, k = s.model.x.numel(), len(s.columns)
    model, names = at_rest(s.model), s.columns
    functions = {
        name: limits.of(f) for name, f in {**kernel(model).functions, **tangent(model, names, s.pushes).functions}.items()
    }
    touched, m = len(tangent(model, names, s.pushes).touched), nx + 2 * s.pushes + k
    of_stages = STAGES * (2 * nx**2 + 2 * nx + 4 * s.pushes * nx + touched) + STAGES * (STAGES - 1) / 2 * 2 * nx
    sums = limits.Work(2 * nx * (of_stages + m * nx + m + 3 * nx * STAGES * (nx - 1) / 2))
    once, each = ("step", "slopes", "ramp", "prepare_all"), ("motion", "slopes_all", "bend_all")
    step = sums
    for name in once:
        step += functions[name]
    for name in each:
        step += functions[name] * STAGES
    row = functions["output"] + functions["readout"] + limits.Work(2 * (nx + len(s.sensors)) * nx * k)
    steps = s.simulator.run(c.t, c.w, c.p, tolerance=TOLERANCE).steps
    return step * steps + row * len(c.t), steps


def rows() -> Iterator[Row]:
    c = case()
    s = Sensitivities(c.simulator.variant)
    names = [p for p in s.columns]
    own = timed(lambda: s.run(c.t, c.w, c.p, names, tolerance=TOLERANCE), REPEATS)
    peers = {name: timed(cvodes(c, options), REPEATS) for name, options in METHODS.items()}
    fastest = min(peers, key=lambda name: float(np.median(peers[name])))
    runs = len(names) + 1
    work, steps = work_of(s, c)
    core = limits.core(min(4, limits.widest().lanes))
    what = f"20 s run, own sensitivities by {len(names)} parameters"
    yield Row(
        what,
        "ms",
        own,
        TARGET,
        runs * float(np.median(peers[AS_IT_COMES])),
        f"beside {runs} runs of CVODES",
        1e3 * work.seconds(core),
        f"{steps} steps and {len(c.t)} readings with derivatives, {work.operations / 1e6:.0f} million operations, {core.lanes} "
        "at once; rows of derivatives are that short that they wait for memory, and the model's own functions are evaluated "
        "one by one",
    )
    yield Row(what, "ms", own, peer=runs * float(np.median(peers[fastest])), note=f"beside {runs} runs of CVODES ({fastest})")
