"""Equations that tie what one device saw to what another saw, up to a lag between their clocks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .smoothing import Smooth


@dataclass(frozen=True, eq=False)
class Equation:
    """`target` (n,) and `own` (j, n) at times (n,) of A's clock, even, NaN in gaps; `seen` of B. `slope` (n,) is the target's,
    by which the sharpness of the lag is judged without the noise of B."""

    time: np.ndarray
    target: np.ndarray
    slope: np.ndarray
    own: np.ndarray
    seen: tuple[Smooth, ...]
