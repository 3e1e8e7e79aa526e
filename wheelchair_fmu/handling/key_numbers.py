"""A manoeuvre in a handful of numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import inf, nan, pi

import numpy as np

STRAIGHT = 1e3  # m; a path of larger radius is straight


@dataclass(frozen=True)
class KeyNumber:
    """One result over a manoeuvre, in `unit`; NaN for what would say nothing."""

    meaning: str
    unit: str
    end: float
    mean: float
    least: float
    greatest: float


SHOWN = (  # meaning, unit, FMI name, factor from SI
    ("curvature 1/R_c", "1/m", "chair.curvature", 1.0),
    ("forward speed u", "m/s", "chair.u", 1.0),
    ("yaw rate ψ'", "deg/s", "chair.psi_dot", 180 / pi),
    ("slip angle, left", "deg", "slip.rl", 180 / pi),
    ("slip angle, right", "deg", "slip.rr", 180 / pi),
    ("path x, forward", "m", "chair.x", 1.0),
    ("path y, right", "m", "chair.y", 1.0),
)
NEEDED = ("push needed", "N", "push.total_needed", 1.0)


def key_numbers(columns: Mapping[str, np.ndarray], *, held: bool) -> list[KeyNumber]:
    """Numbers from outputs (n,) by FMI name; with the push needed where the speed is `held`."""
    rows = (*SHOWN, NEEDED) if held else SHOWN
    return [_radius(columns["chair.curvature"]), *(_number(*row, columns) for row in rows)]


def _number(meaning: str, unit: str, name: str, factor: float, columns: Mapping[str, np.ndarray]) -> KeyNumber:
    values = factor * columns[name]
    return KeyNumber(meaning, unit, *map(float, (values[-1], values.mean(), values.min(), values.max())))


def _radius(curvature: np.ndarray) -> KeyNumber:
    """At the end only: on the way a radius goes through infinity. Infinite where the end is straight."""
    last = float(curvature[-1])
    return KeyNumber("radius of curvature R_c", "m", 1 / last if abs(last) > 1 / STRAIGHT else inf, nan, nan, nan)
