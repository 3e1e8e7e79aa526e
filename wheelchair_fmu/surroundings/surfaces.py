"""Floors by name: how much harder a chair rolls on each, as published.

Axelson and Chesney propelled one chair over floors and up ramps and told the work per metre [N]. What a ramp takes is linear in
its grade, so the ramps say what the chair weighs and what their own floor takes, and any other floor is as steep a ramp:

    W = k (f + grade),    so a floor adds  Δf = (W − W of a level ramp) / k  to the coefficient of a hard one

with no need of the weight. Hoffman and others tell Δf themselves. On grass no wheelchair's was at hand: those two rows are what
aircraft tyres take there more than on concrete. A chair whose coefficient on a hard floor is f has `floor.rolling_factor`
1 + Δf/f on it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..errors import UsageError, unknown

HARD = 0.012  # coefficient of a chair on a hard floor: the median of what is published, and the default of resistance.f_r
RAMPS: Mapping[float, float] = {0.03: 35.5, 0.04: 44.5, 0.05: 53.5, 0.07: 71.6}  # work per metre by grade, Axelson1999


@dataclass(frozen=True)
class Surface:
    """A floor: the work per metre [N] that was measured beside the ramps, or what it adds to the coefficient itself."""

    what: str
    source: str
    work: float | None = None
    told: float = 0.0

    @property
    def adds(self) -> float:
        """To the coefficient of rolling resistance of a hard floor."""
        return self.told if self.work is None else (self.work - _level()) / _per_grade()

    def factor(self, coefficient: float = HARD) -> float:
        """`floor.rolling_factor` of a chair with this coefficient on a hard floor. Raises UsageError unless it is above 0."""
        if not coefficient > 0:
            raise UsageError(f"a coefficient of {coefficient:g} on a hard floor is none to compare with; give one above 0")
        return 1 + self.adds / coefficient


def _per_grade() -> float:
    """Work per metre and unit of grade [N]: about the weight."""
    return float(np.polyfit(list(RAMPS), list(RAMPS.values()), 1)[0])


def _level() -> float:
    """Work per metre on the ramps' own floor, were it level [N]."""
    return float(np.polyfit(list(RAMPS), list(RAMPS.values()), 1)[1])


def _measured(work: float, what: str) -> Surface:
    return Surface(what, "Axelson1999", work=work)


SURFACES: Mapping[str, Surface] = {
    "hard": Surface("linoleum, and the slip-resistant floor of the ramps: what f_r and f_f are for", "Hoffman2003"),
    "carpet": Surface("carpet, mean of what was measured beside linoleum", "Hoffman2003", told=0.0118),
    "carpet-1": _measured(20.4, "the first of three carpets, pad 0 of five (C1P0)"),
    "carpet-1-pad-1": _measured(23.5, "the first carpet, pad 1 (C1P1)"),
    "carpet-2-pad-1": _measured(32.5, "the second carpet, pad 1 (C2P1)"),
    "carpet-2-pad-4": _measured(39.7, "the second carpet, pad 4 (C2P4)"),
    "carpet-3": _measured(43.2, "the third carpet, pad 0 (C3P0)"),
    "carpet-3-pad-3": _measured(50.5, "the third carpet, pad 3 (C3P3)"),
    "asphalt": _measured(13.8, "asphalt with exposed aggregate (ASPP)"),
    "path-fines": _measured(21.6, "path fines, decomposed granite (PAFN)"),
    "road-mix": _measured(27.6, "unpaved road mix of up to 19 mm (RDMX)"),
    "soil": _measured(34.4, "native soil (DIRP)"),
    "wood-chips": _measured(41.7, "wood chips of brush, compacted (CPBR)"),
    "wood-fibre": _measured(56.7, "engineered wood fibre, compacted (EWFK)"),
    "grass": Surface("short dry grass: of aircraft tyres, 0.05 beside 0.02 on concrete", "Mason1997", told=0.03),
    "long-grass": Surface("long grass: of aircraft tyres, 0.10 beside 0.02 on concrete", "Mason1997", told=0.08),
}


def surface(name: str) -> Surface:
    """A floor by its name. Raises UsageError for one that is not in the table."""
    if name not in SURFACES:
        raise unknown("surface", name, SURFACES)
    return SURFACES[name]
