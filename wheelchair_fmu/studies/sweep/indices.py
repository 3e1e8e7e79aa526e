"""Sensitivity indices of a sweep by SALib: Morris' elementary effects, or Sobol's shares of the variance.

Morris: mu is the mean change of a quantity as the parameter crosses its range, mu_star the mean of its size, sigma its
spread (curved, or with others). Saltelli's design: S1 is the share of the variance that the parameter alone makes, ST with
all its interactions. *_conf is SALib's bootstrap half-width at 95 %.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow.parquet as pq

from .design import INDICES, LEVELS, Design, problem
from .plan import Plan
from .quantities import QUANTITIES

COLUMNS = {"morris": ("mu", "mu_star", "mu_star_conf", "sigma"), "saltelli": ("S1", "S1_conf", "ST", "ST_conf")}


def indices(plan: Plan, out: Path) -> pd.DataFrame | None:
    """One row for each variant, manoeuvre, quantity and parameter; None where the design is not for indices.

    Groups of chairs (a trajectory, a base point with its neighbours) with a run that gave no number are left out and
    counted in `left_out`; where fewer than two are left, and for quantities that do not vary, the indices are NaN.
    """
    if plan.design.method not in INDICES:
        return None
    rows = []
    table = pq.ParquetFile(out)
    there = pd.unique(table.read(["variant", "manoeuvre"]).to_pandas().agg(tuple, axis=1))
    for name in QUANTITIES:  # a column at a time
        frame = table.read(["chair", "variant", "manoeuvre", name]).to_pandas()
        for variant, manoeuvre in there:
            case = frame[(frame.variant == variant) & (frame.manoeuvre == manoeuvre)].sort_values("chair")
            values = case[name].to_numpy()
            if np.isfinite(values).any():
                rows += [
                    {"variant": variant, "manoeuvre": manoeuvre, "quantity": name, **row}
                    for row in indices_of(plan.design, values)
                ]
    return pd.DataFrame(rows)


def indices_of(design: Design, values: np.ndarray) -> Iterator[dict[str, object]]:
    """Indices of one quantity, (chairs,), by each parameter."""
    groups = values.reshape(-1, design.group)
    good = np.isfinite(groups).all(axis=1)
    y = groups[good].ravel()
    columns = COLUMNS[design.method]
    found = {c: np.full(len(design.axes), np.nan) for c in columns}
    if good.sum() >= 2 and np.ptp(y) > 0:
        found = _analysed(design, y, np.repeat(good, design.group))
    for i, axis in enumerate(design.axes):
        yield {"parameter": axis.name, **{c: float(found[c][i]) for c in columns}, "left_out": int((~good).sum())}


def _analysed(design: Design, y: np.ndarray, keep: np.ndarray) -> dict[str, np.ndarray]:
    from SALib.analyze import morris, sobol  # an extra

    cube = problem(tuple(axis.name for axis in design.axes))
    if design.method == "morris":
        u = design.unit(0, design.chairs)[keep]
        return dict(morris.analyze(cube, u, y, num_levels=LEVELS, seed=design.seed))
    return dict(sobol.analyze(cube, y, calc_second_order=False, seed=design.seed))
