"""What the sensitivities of the run of `run_cost` cost, beside finite differences of CVODES runs.

All parameters that a fit may touch and the initial states among them. One-sided differences need a run for each and one more;
one CVODES run, by the fastest of its methods, is timed, for a loop of them grows with their number alone.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from wheelchair_fmu.engine.sensitivities import Sensitivities

from .rows import Row, timed
from .run_cost import METHODS, REPEATS, TOLERANCE, case, cvodes

TARGET = 40.0


def rows() -> Iterator[Row]:
    c = case()
    s = Sensitivities(c.simulator.variant)
    names = [p for p in s.columns]
    own = timed(lambda: s.run(c.t, c.w, c.p, names, tolerance=TOLERANCE), REPEATS)
    peers = {name: timed(cvodes(c, options), REPEATS) for name, options in METHODS.items()}
    fastest = min(peers, key=lambda name: float(np.median(peers[name])))
    differences = [(len(names) + 1) * ms for ms in peers[fastest]]
    yield Row(f"20 s run, own sensitivities by {len(names)} parameters", "ms", own, TARGET, float(np.median(differences)),
              f"beside {len(names) + 1} runs of CVODES ({fastest})")  # fmt: skip
    yield Row(f"20 s run, {len(names) + 1} runs of CVODES", "ms", differences, note="one is timed")
