"""Tables of a supplement, as pandas frames and as LaTeX."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import nan
from typing import Any

import numpy as np
import pandas as pd

from .. import latex
from .case import Case, interval

RUNS = {"fit": "fitted", "heldout": "held out"}


def estimates(case: Case) -> pd.DataFrame:
    """A row for each value of the last model, in SI units; NaN where there is no prior or no interval."""
    return pd.DataFrame([_estimate(case, p) for p in case.parameters], columns=list(_COLUMNS)).set_index("parameter")


_COLUMNS = (
    *("parameter", "kind", "meaning", "unit", "estimate", "se", "unnamed", "lower_95", "upper_95", "interval"),
    *("at_bound", "prior", "prior_sd", "smallest_interesting"),
)


_NUMBERS = ("estimate", "se", "unnamed", "prior", "prior_sd", "smallest_interesting")  # of a record, where it has them


def _estimate(case: Case, p: Mapping[str, Any]) -> dict[str, Any]:
    lower, upper, how = interval(p)
    numbers = {key: nan if p.get(key) is None else p[key] for key in _NUMBERS}
    return {
        **{key: p[key] for key in ("meaning", "unit", "at_bound")},
        **numbers,
        "parameter": p["name"],
        "kind": case.kind(p["name"]),
        "lower_95": lower,
        "upper_95": upper,
        "interval": how,
    }


def estimates_tex(table: pd.DataFrame) -> str:
    """The estimates as a tabular with booktabs, effects first."""
    effects = table.index.str.startswith("effect.")
    rows = pd.concat([table[effects], table[~effects]])
    rows = rows.assign(se=rows["se"].where(rows["interval"] != ""))  # what a bound stopped has none to speak of
    columns = (rows[name].astype(float) for name in ("estimate", "se", "lower_95", "upper_95"))
    return latex.table(zip(rows.index, *columns, rows["unit"], strict=True))


def covariance(case: Case) -> pd.DataFrame:
    """Of the estimates (k, k), in the products of their SI units, with names at rows and columns."""
    names = [p["name"] for p in case.parameters]
    values = np.array(case.final["covariance"], float).reshape(len(names), len(names))
    return pd.DataFrame(values, index=pd.Index(names, name="parameter"), columns=names)


def errors(case: Case) -> pd.DataFrame:
    """The staircase: a row for each step, channel (or "all") and role of runs, with the RMS error whitened and in `unit`."""
    return pd.DataFrame(list(_errors(case)), columns=["step", "channel", "runs", "whitened_rms", "rms", "unit"])


def _errors(case: Case) -> Iterator[tuple[str, str, str, float, float, str]]:
    for step in case.ladder:
        for key, runs in RUNS.items():
            if step[key] is None:
                continue
            yield step["step"], "all", runs, step[key], nan, ""
            for channel, told in step["channels"].items():
                if told[f"{key}_rms"] is not None:
                    whitened = nan if told[key] is None else told[key]
                    yield step["step"], channel, runs, whitened, told[f"{key}_rms"], told["unit"]
