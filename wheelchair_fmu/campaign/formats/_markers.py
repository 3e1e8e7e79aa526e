"""Markers of motion capture as a table, and what is odd about them: names that stand there twice, one that changed half-way."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from ...faults import WARNING, Fault, run_fault
from ...tables import FrameTable
from ...units import UnitError, factor

SOON = 0.5  # s after which a renamed marker is seen again, and how far it may be from where it was:
NEAR, FASTEST = 0.02, 3.0  # m, and m/s of what a chair does


def doubled(file: str, names: Sequence[str], line: int | None = None) -> Iterator[Fault]:
    """A fault where two markers have one name."""
    for name in sorted({name for name in names if names.count(name) > 1})[:1]:
        yield run_fault(file, f"the marker {name} stands there {names.count(name)} times", "rename one of them", line)


def table_of(
    file: str, names: Sequence[str], unit: str, rate: str, time: np.ndarray, places: np.ndarray
) -> tuple[FrameTable, list[Fault]]:
    """A table of markers at these times (n,) from their coordinates (n, 3 markers), NaN while hidden, and what is odd."""
    headers = ("time [s]", *(f"{name}.{axis} [{unit}]" for name in names for axis in "xyz"))
    hidden = [name for i, name in enumerate(names) if np.isnan(places[:, 3 * i]).any()]
    notes = [f"{len(names)} markers at {rate} Hz" if rate else f"{len(names)} markers"]
    notes += [f"hidden at times: {', '.join(hidden)}"] if hidden else []
    frame = pd.DataFrame(np.column_stack([time, places]), columns=list(headers))
    table = FrameTable(file, headers, ("s", *[unit] * (3 * len(names))), tuple(notes), time=0, frame=frame)
    return table, list(renamed(file, names, time, places.reshape(len(places), -1, 3), unit))


def renamed(file: str, names: Sequence[str], time: np.ndarray, places: np.ndarray, unit: str) -> Iterator[Fault]:
    """A warning for each marker that ends for good where another one begins: `places` are (n, markers, 3), NaN while hidden."""
    try:
        metre = factor(unit, "m")
    except UnitError:
        return  # which binding says
    seen = np.isfinite(places).all(axis=2)
    ends = {i: int(np.flatnonzero(s)[-1]) for i, s in enumerate(seen.T) if s.any()}
    begins = {i: int(np.argmax(s)) for i, s in enumerate(seen.T) if s.any()}
    for one, last in ends.items():
        for other, first in begins.items():
            gap = time[first] - time[last]
            if 0 < gap < SOON and metre * np.linalg.norm(places[first, other] - places[last, one]) < NEAR + FASTEST * gap:
                fact = f"{names[one]} ends at {time[last]:.4g} s, where {names[other]} begins: a marker renamed half-way"
                yield run_fault(file, fact, "give both one name, or only the first part is read", severity=WARNING)
