"""Columns as `pa.array` makes them."""

from __future__ import annotations

import numpy as np
import pyarrow as pa
import pytest

from wheelchair_fmu.studies.sweep.columns import column, woven


@pytest.mark.parametrize(
    ("values", "kind"),
    [
        (["a", None, "µ·s", ""] * 5, pa.string()),
        (["steady-turn"] * 3, pa.string()),
        (np.array([None, "it stops", None], object), pa.string()),
        ([None, 1.5, np.nan] * 4, pa.float64()),
        ([None, None], pa.float64()),
        (np.linspace(0, 1, 7), pa.float64()),
        ([2.5, 5], pa.float64()),
        (np.arange(5), pa.int64()),
    ],
)
def test_a_column_is_what_arrow_makes_of_it(values, kind):
    made = column(values, kind)
    made.validate(full=True)
    assert made.type == kind and made.null_count == sum(v is None for v in values)
    np.testing.assert_array_equal(made.to_numpy(zero_copy_only=False), pa.array(values, kind).to_numpy(zero_copy_only=False))


def test_columns_are_woven_row_by_row():
    assert woven([["a", "b"], ["c", "d"]]) == ["a", "c", "b", "d"]
    assert woven([np.array([1, 2]), np.array([3, 4])]).tolist() == [1, 3, 2, 4]
