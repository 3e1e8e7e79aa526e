"""Shares and sizes over a fleet, against closed forms."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest
from scipy import stats

from wheelchair_fmu.fleet import summary


def lines(*rows):
    columns = ["folder", "verdict", "effect", "parameter", "estimate", "se"]
    return pd.DataFrame(rows, columns=columns).assign(campaign=lambda t: t.folder, unit="N")


def test_sizes_that_differ_by_more_than_their_errors_are_told():
    sizes, se = np.array([1.0, 1.1, 1.9]), np.array([0.1, 0.1, 0.2])
    found = lines(*((f"{i}", "missing", "drag", "D", s, e) for i, (s, e) in enumerate(zip(sizes, se, strict=True))))
    (row,) = summary(found, chairs=4).to_dict("records")
    w = 1 / se**2
    Q = float(w @ (sizes - w @ sizes / w.sum()) ** 2)
    assert row["Q"] == pytest.approx(Q) and row["p"] == pytest.approx(stats.chi2.sf(Q, 2))
    assert row["I2"] == pytest.approx(1 - 2 / Q)
    # Paule and Mandel: with the spread between chairs in the weights, Q is its degrees of freedom
    w = 1 / (se**2 + row["spread"] ** 2)
    mean = w @ sizes / w.sum()
    assert w @ (sizes - mean) ** 2 == pytest.approx(2, rel=1e-3)
    assert row["mean"] == pytest.approx(mean, rel=1e-4) and row["se"] == pytest.approx(w.sum() ** -0.5, rel=1e-4)


def test_the_share_has_wilsons_interval():
    found = lines(*((f"{i}", "missing", "drag", "D", 1.0, 0.1) for i in range(3)))
    (row,) = summary(found, chairs=10).to_dict("records")
    z, n, k = stats.norm.isf(0.025), 10, 3
    middle, half = (k + z**2 / 2) / (n + z**2), z / (n + z**2) * np.sqrt(k * (n - k) / n + z**2 / 4)
    assert (row["missing"], row["share"]) == (3, 0.3)
    assert (row["low"], row["high"]) == (pytest.approx(middle - half), pytest.approx(middle + half))


def test_what_is_tied_counts_apart_and_what_is_small_has_no_part_in_the_size():
    found = lines(
        ("1", "missing", "drag", "D", 1.0, 0.1),
        ("2", "tie", "drag", "D", 1.2, 0.1),
        ("2", "tie", "air", "k", 0.4, 0.1),
        ("3", "small", "drag", "D", 0.1, 0.01),
    )
    drag, air = summary(found, chairs=5).to_dict("records")
    assert (drag["missing"], drag["tied"], drag["small"], drag["n"]) == (1, 1, 1, 2)
    assert drag["mean"] == pytest.approx(1.1) and drag["share"] == pytest.approx(0.4)
    assert (air["tied"], air["n"], air["mean"]) == (1, 1, 0.4) and np.isnan(air["Q"])


def test_a_size_that_the_data_do_not_tell_is_left_out():
    found = lines(("1", "missing", "drag", "D", 1.0, 0.1), ("2", "missing", "drag", "D", 50.0, None))
    (row,) = summary(found, chairs=2).to_dict("records")
    assert (row["missing"], row["n"], row["mean"]) == (2, 1, 1.0)
