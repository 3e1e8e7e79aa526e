"""How the result of a coupled system depends on the communication step:  python -m benchmarks.coupling [FILE.ssp]

Prints, as the table in docs/ssp.md, the largest difference from a run with a step of 0.25 ms over 20 s.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

from wheelchair_fmu.studies.ssp.building import build
from wheelchair_fmu.studies.ssp.running import run

FINEST, STOP = 0.25e-3, 20.0  # s
STEPS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05)
SHOWN = ("Chair.chair.x", "Chair.chair.y", "Chair.chair.u")


def main(path: Path) -> None:
    fine = run(path, step=FINEST, stop=STOP)
    print("| step [ms] | x [mm] | y [mm] | u [mm/s] |\n|---|---|---|---|")
    for step in STEPS:
        coarse = run(path, step=step, stop=STOP)
        worst = [1000 * np.max(np.abs(np.interp(fine.time, coarse.time, coarse[n]) - fine[n])) for n in SHOWN]
        print(f"| {1000 * step:g} | " + " | ".join(f"{w:.1f}" for w in worst) + " |")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]))
    else:
        with tempfile.TemporaryDirectory() as folder:
            main(build("slalom", Path(folder) / "slalom.ssp"))
