"""The runs of the study, each done when first asked for. The turns go at 1 m/s, as the paper has it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...handling.manoeuvres import Manoeuvre, manoeuvre
from ..driving import Fmu, Result

Values = Mapping[str, float]

TABLE_1 = {"tyre.C_lambda": 5038.0, "tyre.C_m_lambda": 45.0}
TYRE_B = {
    "tyre.C_lambda": 3893.0,
    "tyre.C_m_lambda": 43.1,
}  # fitted to examples/rotating-disc.csv; the text has no numbers of it
PERIODS = 3


@dataclass(frozen=True)
class Setting:
    """What the paper's text leaves open, SI units; FMI parameters keep their defaults unless `values` has them."""

    delta_force: float = 10.0
    period: float = 4.0
    slalom_speed: float = 1.0
    values: Values = field(default_factory=dict)

    def but(self, name: str, value: float) -> Setting:
        """The same but for one value."""
        if name in ("delta_force", "period", "slalom_speed"):
            changed: dict[str, Any] = {name: value}
            return replace(self, **changed)
        return replace(self, values={**self.values, name: value})


def scaled(name: str, scale: float) -> Values:
    """A stiffness of Table 1 at half, once or twice its value."""
    return {name: scale * TABLE_1[name]}


def camber(left: float, right: float | None = None) -> Values:
    """Camber angles in degrees, the same on both sides unless given."""
    right = left if right is None else right
    combined = {"sum": right + left, "difference": right - left}
    return {f"effect.camber_misalignment.{name}": float(np.radians(angle)) for name, angle in combined.items()}


class Runs:
    """The FMU's results under one setting."""

    def __init__(self, fmu: Fmu, setting: Setting = Setting()):
        self.fmu, self.setting = fmu, setting
        self._done: dict[tuple[object, ...], Result] = {}

    def turn(self, values: Values | None = None, total_push: float = 0.0, delta_force: float | None = None) -> Result:
        """The steady turn, with a push on both wheels together that may differ from what the speed needs."""
        force = self.setting.delta_force if delta_force is None else delta_force
        return self._run(manoeuvre("steady-turn", delta_force=force), values or {}, total_push)

    def slalom(self, values: Values | None = None, mirrored: bool = False) -> Result:
        """Three periods of the slalom, which begins to the right, or `mirrored` to the left."""
        set = self.setting
        force = -set.delta_force if mirrored else set.delta_force
        course = manoeuvre("slalom", speed=set.slalom_speed, delta_force=force, period=set.period, time=PERIODS * set.period)
        return self._run(course, values or {}, 0.0)

    def last_period(self, result: Result) -> slice:
        return slice(-(len(result.time) // PERIODS) - 1, None)

    def _run(self, course: Manoeuvre, values: Values, total_push: float) -> Result:
        values = {**self.setting.values, **values}
        key = (course.title, total_push, *sorted(values.items()))
        if key not in self._done:
            inputs = {name: column + total_push / 2 for name, column in course.inputs.items()}
            self._done[key] = self.fmu.run(course.time, inputs, {**course.values, **values})
        return self._done[key]
