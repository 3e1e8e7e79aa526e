"""Over which range of what the paper's text leaves open does each statement hold?"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from ..driving import Fmu
from .runs import Runs, Setting
from .statements import STATEMENTS


@dataclass(frozen=True)
class OpenValue:
    """A value the text does not give: its name, how it is written, its unit, and the values tried, in order."""

    name: str
    symbol: str
    unit: str
    tried: tuple[float, ...]
    chosen: float


OPEN = (
    OpenValue("delta_force", "ΔF", "N", (1, 2, 3, 5, 7, 10, 15, 20, 25, 30, 40, 50, 60), 10),
    OpenValue("period", "T", "s", (1, 1.5, 2, 3, 4, 5, 6, 8), 4),
    OpenValue("slalom_speed", "slalom's u", "m/s", (0.4, 0.6, 0.8, 1, 1.2, 1.5, 2), 1),
    OpenValue("resistance.f_r", "f_r", "", (0, 0.006, 0.012, 0.024, 0.05), 0.012),
    OpenValue("resistance.f_f", "f_f", "", (0, 0.01, 0.02, 0.04, 0.08), 0.020),
    OpenValue("tyre.C_m_phi", "C_mφ", "N m/rad", (0, 1, 3, 6, 12, 24), 3),
)


@dataclass(frozen=True)
class Range:
    """Where one statement held when one open value was varied: the values tried, and whether it held at each."""

    open: OpenValue
    held: tuple[bool, ...]

    @property
    def around(self) -> tuple[float, float] | None:
        """The values that hold without a break around the chosen one."""
        place = self.open.tried.index(self.open.chosen)
        if not self.held[place]:
            return None
        low = high = place
        while low and self.held[low - 1]:
            low -= 1
        while high + 1 < len(self.held) and self.held[high + 1]:
            high += 1
        return self.open.tried[low], self.open.tried[high]

    def __str__(self) -> str:
        found = self.around
        if found is None:
            return "nowhere around"
        if all(self.held):
            return "all"
        return f"{found[0]:g} to {found[1]:g}"


def ranges(fmu: Fmu, setting: Setting = Setting()) -> Iterator[tuple[OpenValue, dict[str, Range]]]:
    """Of each open value, one at a time: the ranges by statement id."""
    for value in OPEN:
        held: dict[str, list[bool]] = {s.id: [] for s in STATEMENTS}
        for tried in value.tried:
            runs = Runs(fmu, setting.but(value.name, tried))
            for statement in STATEMENTS:
                held[statement.id].append(statement.measure(runs).holds)
        yield value, {id: Range(value, tuple(h)) for id, h in held.items()}
