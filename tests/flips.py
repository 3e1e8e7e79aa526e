"""Recordings in which casters swing round, for several tests."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks.independent.campaigns import make
from wheelchair_fmu.campaign import BY_NAME, Campaign, read
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.model.variant import Variant


def flipping(folder: Path, chair: Variant, values: dict[str, float]) -> Campaign:
    """Runs in which casters swing round, as this very chair goes, so that its errors are small and every path is plain."""
    make(folder, {}, manoeuvres=("spin-right", "holdout-spin"))
    slow, simulator, chance = read(folder), Simulator(chair), np.random.default_rng(1)
    for run in slow.runs:
        felt = {n: v + chance.normal(0, slow.noise["F_rl"] * n.startswith("push.F"), len(v)) for n, v in run.inputs.items()}
        p = chair.vector({**slow.known, **values, "start.u": run.u0 or 0.0})
        there = simulator.run(run.time, simulator.inputs(len(run.time), felt), p, tolerance=1e-6)
        file = folder / "runs" / f"{run.name}.csv"
        rows = pd.read_csv(file)
        for channel in run.channels:
            column = next(c for c in rows.columns if c.startswith(f"{channel} ["))
            rows[column] = there[BY_NAME[channel].fmu] + chance.normal(0, slow.noise[channel], len(rows))
        rows.to_csv(file, index=False)
    return read(folder)
