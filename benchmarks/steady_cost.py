"""What steady turns cost: trim, linearise and all slopes of the radius at 200 speeds from 0.1 to 4 m/s and 10 N m.

Of the chair with the chosen effects; each speed begins at the one before.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from wheelchair_fmu.fmu.build import with_chosen_effects
from wheelchair_fmu.handling.linearize import linearize, radius_slopes
from wheelchair_fmu.handling.trim import Chair, trim
from wheelchair_fmu.model.variant import Variant

from .rows import Row, timed

SPEEDS, MOMENT, REPEATS, TARGET = np.linspace(0.1, 4, 200), 10.0, 5, 1000.0  # m/s, N m, and ms


def rows() -> Iterator[Row]:
    chair = Chair(with_chosen_effects(Variant()))

    def all_speeds() -> None:
        near = None
        for speed in SPEEDS:
            near = trim(chair, speed, MOMENT, near=near)
            linearize(near)
            radius_slopes(near)

    yield Row(f"steady turns at {len(SPEEDS)} speeds, with all sensitivities", "ms", timed(all_speeds, REPEATS), TARGET)
