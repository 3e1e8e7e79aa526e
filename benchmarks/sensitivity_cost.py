"""What the sensitivities of the run of `run_cost` cost, beside finite differences of CVODES runs.

All parameters that a fit may touch and the initial states among them. One-sided differences need a run for each and one more;
one CVODES run is timed, as CasADi hands it out and by the fastest of its methods, for a loop of them grows with their number
alone.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from wheelchair_fmu.engine.sensitivities import Sensitivities

from .rows import Row, timed
from .run_cost import AS_IT_COMES, METHODS, REPEATS, TOLERANCE, case, cvodes

TARGET = 40.0


def rows() -> Iterator[Row]:
    c = case()
    s = Sensitivities(c.simulator.variant)
    names = [p for p in s.columns]
    own = timed(lambda: s.run(c.t, c.w, c.p, names, tolerance=TOLERANCE), REPEATS)
    peers = {name: timed(cvodes(c, options), REPEATS) for name, options in METHODS.items()}
    fastest = min(peers, key=lambda name: float(np.median(peers[name])))
    runs = len(names) + 1
    what = f"20 s run, own sensitivities by {len(names)} parameters"
    yield Row(what, "ms", own, TARGET, runs * float(np.median(peers[AS_IT_COMES])), f"beside {runs} runs of CVODES")
    yield Row(what, "ms", own, peer=runs * float(np.median(peers[fastest])), note=f"beside {runs} runs of CVODES ({fastest})")
