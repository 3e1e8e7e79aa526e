"""From single measurements to sweeps: which rows were taken in one condition, and which angle was varied.

Every format ends here. Rows are in SI units (pressure in bar) and the paper's axes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ..faults import SHOWN, WARNING, Fault
from .records import CAMBER, KM_H, SLIP, Condition, Sweep

LEVEL = np.radians(0.05)  # an angle below this is zero
SAME = 0.03  # relative: settings of a rig that lie closer are one


@dataclass(frozen=True)
class Bound:
    """What a column may hold, in SI, and what is most likely wrong where it holds more."""

    low: float
    high: float
    cure: str


BOUNDS = {
    "pressure": Bound(0.05, 20.0, "give the pressure above the air's, with its unit, such as [bar] or [kPa]"),
    "load": Bound(1.0, 2e4, "give the vertical load as a positive force, with its unit, such as [N]"),
    "disc_speed": Bound(0.01, 60.0, "give the speed of the track, with its unit, such as [km/h]"),
    "slip_angle": Bound(-np.pi / 6, np.pi / 6, "is the unit [deg]? rigs reach 30°"),
    "camber_angle": Bound(-np.pi / 3, np.pi / 3, "is the unit [deg]? rigs reach 60°"),
    "lateral_force": Bound(-5e4, 5e4, "check the unit"),
    "yaw_torque": Bound(-5e3, 5e3, "check the unit"),
}
USUAL_SPEED = 4 * KM_H  # m/s, where none is given; it hardly matters (Doria, Fig. 5)
NEEDED = ("pressure", "load", "slip_angle", "lateral_force")


@dataclass(frozen=True, eq=False)
class Rows:
    """Columns (n,) by name, as BOUNDS has them; `tyre` (n,) names; `line` (n,) in `file`, 0 where a file has none.

    `headers` says what the file calls a column.
    """

    file: str
    tyre: Sequence[str]
    columns: dict[str, np.ndarray]
    line: np.ndarray
    headers: dict[str, str] = field(default_factory=dict)

    def faults(self) -> Iterator[Fault]:
        """Every value that is missing or cannot be."""
        for name, values in self.columns.items():
            bound = BOUNDS[name]
            header = self.headers.get(name, name)
            gaps, beyond = np.isnan(values), (values < bound.low) | (values > bound.high)
            yield from self._listed(gaps, header, lambda _: "the cell is empty", "write the value, or remove the row")
            yield from self._listed(beyond, header, partial(_implausible, name, values), bound.cure)

    def _listed(self, where: np.ndarray, header: str, fact: Callable[[int], str], cure: str) -> Iterator[Fault]:
        places = [int(i) for i in np.flatnonzero(where)]
        for i in places[:SHOWN]:
            yield Fault(self.file, int(self.line[i]) or None, header, fact(i), cure)
        if len(places) > SHOWN:
            more = f"{len(places) - SHOWN} more cells like these"
            yield Fault(self.file, int(self.line[places[SHOWN]]) or None, header, more, cure)


def _implausible(name: str, values: np.ndarray, i: int) -> str:
    return f"{_shown(name, float(values[i]))} is not plausible"


def _shown(name: str, value: float) -> str:
    if name.endswith("angle"):
        return f"{np.degrees(value):.4g}°"
    unit = {"pressure": "bar", "load": "N", "disc_speed": "m/s", "lateral_force": "N", "yaw_torque": "N.m"}[name]
    return f"{value:.4g} {unit}"


def sweeps(rows: Rows) -> tuple[tuple[Sweep, ...], tuple[Fault, ...]]:
    """Sweeps in the order of the file, and warnings on rows that belong to none."""
    c = rows.columns
    n = len(rows.line)
    slip, camber = c["slip_angle"], c.get("camber_angle", np.zeros(n))
    slips, leans = np.abs(slip) > LEVEL, np.abs(camber) > LEVEL
    settings = [_grouped(c[name]) for name in ("pressure", "load", "disc_speed")]
    found = []
    groups: dict[tuple[Condition, str], list[int]] = {}
    for i in map(int, np.flatnonzero(slips ^ leans)):
        condition = Condition(rows.tyre[i], *(float(s[i]) for s in settings))
        groups.setdefault((condition, SLIP if slips[i] else CAMBER), []).append(i)
    for (condition, kind), places in groups.items():
        angle = (slip if kind == SLIP else camber)[places]
        torque = c["yaw_torque"][places] if "yaw_torque" in c else np.full(len(places), np.nan)
        found.append(Sweep(condition, kind, angle, c["lateral_force"][places], torque))
    return tuple(found), tuple(_both(rows, slips & leans))


def _both(rows: Rows, where: np.ndarray) -> Iterator[Fault]:
    if where.any():
        first = int(rows.line[np.flatnonzero(where)[0]]) or None
        yield Fault(
            rows.file,
            first,
            None,
            f"{int(where.sum())} rows have slip and camber at once and are left out",
            "measure one angle with the other at zero",
            WARNING,
        )


def _grouped(values: np.ndarray) -> np.ndarray:
    """Each value (n,) replaced by the median of the setting it belongs to."""
    order = np.argsort(values, kind="stable")
    ranked = values[order]
    new = np.r_[False, np.diff(ranked) > SAME * np.maximum(np.abs(ranked[1:]), 1e-9)]
    label = np.empty(len(values), int)
    label[order] = np.cumsum(new)
    medians = [float(np.median(values[label == k])) for k in range(label.max() + 1)]
    return np.array(medians)[label]
