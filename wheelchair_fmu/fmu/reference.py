"""Reference results in the archive: what an importer should get, computed by the engine and not through FMI.

Inputs are held over steps of 10 ms, as a master of Co-Simulation holds them.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..engine.simulate import Simulator
from ..errors import BuildError, SimulationError
from .variables import GRID, TOLERANCE, Interface

DURATION, STEP = 5.0, 0.01  # s
OUTPUTS = (
    "chair.x",
    "chair.y",
    "chair.psi",
    "chair.u",
    "chair.v",
    "chair.psi_dot",
    "slip.rl",
    "slip.rr",
    "sensor.a_x",
    "sensor.a_y",
)


def strokes(time: np.ndarray) -> dict[str, np.ndarray]:
    """One stroke a second of up to 40 N on each wheel, half of it pushing, first more on the left, then on the right."""
    both = 40 * np.maximum(0.0, np.sin(2 * np.pi * time))
    more = np.where(time < DURATION / 2, 4.0, -6.0)
    return {"push.F_rl": both + more, "push.F_rr": both - more}


def files(face: Interface) -> dict[str, bytes]:
    """Inputs and results as CSV, by name. Raises BuildError where the variant cannot be simulated."""
    time = np.arange(round(DURATION / STEP) + 1) * STEP
    inputs = {name: np.array([float(f"{v:.9g}") for v in values]) for name, values in strokes(time).items()}
    simulator = Simulator(face.variant)
    try:
        run = simulator.run(time, simulator.inputs(len(time), inputs), tolerance=TOLERANCE, grid=GRID, hold=True)
    except SimulationError as error:
        raise BuildError(f"the reference run from this variant's own start values fails: {error}") from error
    return {
        "reference_in.csv": _csv(("time", *inputs), [time, *inputs.values()]),
        "reference.csv": _csv(("time", *OUTPUTS), [time, *(run[name] for name in OUTPUTS)]),
    }


def _csv(names: Sequence[str], columns: Sequence[np.ndarray]) -> bytes:
    rows = (",".join(f"{value:.9g}" for value in row) for row in zip(*columns, strict=True))
    return ("\n".join([",".join(names), *rows]) + "\n").encode()
