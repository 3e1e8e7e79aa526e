"""What a fleet lacks: which effect in which share of its chairs, and whether it is as large in all of them.

A share has Wilson's interval. Sizes are put together as in a meta-analysis, each chair a study with its standard error:
Cochran's Q tests whether they differ by more than these errors, I² is the share of their variance that the errors do not
explain (Higgins and Thompson 2002), and the mean is that of a random-effects model with Paule and Mandel's variance.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from statsmodels.stats.meta_analysis import combine_effects
from statsmodels.stats.proportion import proportion_confint

FOUND, TIED, SMALL = ("missing", "outside"), ("tie",), ("small",)
LEVEL = 0.05


def summary(found: pd.DataFrame, chairs: int) -> pd.DataFrame:
    """A line for each effect and parameter from `long`'s lines, of so many chairs diagnosed, the most frequent first.

    `missing`, `tied` and `small` count chairs; `share` is that of missing and tied together, with its 95 % interval `low` to
    `high`; `mean`, `se` and `spread` (a standard deviation from chair to chair) are in `unit`; `Q`, `p` and `I2` are empty for
    fewer than two chairs.
    """
    lines = [line for effect, rows in found.groupby("effect", sort=False) for line in _lines(str(effect), rows, chairs)]
    table = pd.DataFrame(
        lines,
        columns=[
            "effect",
            "missing",
            "tied",
            "small",
            "share",
            "low",
            "high",
            "parameter",
            "unit",
            "n",
            "mean",
            "se",
            "spread",
            "Q",
            "p",
            "I2",
        ],
    )
    return table.sort_values("share", ascending=False, kind="stable", ignore_index=True)


def _lines(effect: str, rows: pd.DataFrame, chairs: int) -> list[dict[str, Any]]:
    by = rows.drop_duplicates("folder").verdict
    missing, tied, small = (int(by.isin(verdicts).sum()) for verdicts in (FOUND, TIED, SMALL))
    low, high = proportion_confint(missing + tied, chairs, LEVEL, method="wilson")
    counts = {
        "effect": effect,
        "missing": missing,
        "tied": tied,
        "small": small,
        "share": (missing + tied) / chairs,
        "low": low,
        "high": high,
    }
    return [
        {**counts, "parameter": name, "unit": part.unit.iloc[0], **_sizes(part[part.verdict.isin((*FOUND, *TIED))])}
        for name, part in rows.groupby("parameter", sort=False)
    ]


def _sizes(rows: pd.DataFrame) -> dict[str, float]:
    """The sizes put together; those whose standard error the data do not tell are left out."""
    sure = rows[rows.se > 0]
    size, se = sure.estimate.to_numpy(float), sure.se.to_numpy(float)
    if len(size) < 2:
        nan = float("nan")
        return {
            "n": len(size),
            "mean": size[0] if len(size) else nan,
            "se": se[0] if len(se) else nan,
            "spread": nan,
            "Q": nan,
            "p": nan,
            "I2": nan,
        }
    together = combine_effects(size, se**2, method_re="iterated")
    Q = float(together.q)
    return {
        "n": len(size),
        "mean": float(together.mean_effect_re),
        "se": float(together.sd_eff_w_re),
        "spread": float(np.sqrt(together.tau2)),
        "Q": Q,
        "p": float(together.test_homogeneity().pvalue),
        "I2": max(0.0, 1 - together.df / Q) if Q > 0 else 0.0,
    }
