"""Floors that a run is on: by name, by factor, by slope, as a constant and as a column."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.campaign import check, read
from wheelchair_fmu.surroundings.surfaces import SURFACES

from .small import HEAD, RUNS, SI, csv_text, motion, rows


def on(floor: str) -> str:
    """The runs, of which the first has these constants."""
    return RUNS.replace("u0 = 1.0\n", f"u0 = 1.0\nconstant = {{ {floor} }}\n", 1)


@pytest.mark.parametrize(("said", "factor"), [('"carpet"', SURFACES["carpet"].factor()), ("2", 2.0), ('"150 %"', 1.5)])
def test_a_floor_has_a_name_or_a_factor(campaign, said, factor):
    folder = campaign(runs=on(f"floor.rolling_factor = {said}"))
    assert check(folder) == []
    carpeted, hard = read(folder).runs
    np.testing.assert_allclose(carpeted.inputs["floor.rolling_factor"], factor)
    assert "floor.rolling_factor" not in hard.inputs


@pytest.mark.parametrize("axes", ["SAE-J670", "ISO-8855"])
def test_a_constant_slope_is_in_the_axes_of_the_campaign(campaign, axes):
    """The floor falls to the left by both: y is to the left in ISO 8855."""
    to_the_left = "-1 deg" if axes == "SAE-J670" else "1 deg"
    folder = campaign(
        head=HEAD.replace("SAE-J670", axes), runs=on(f'"floor.slope_x" = 0.02, "floor.slope_y" = "{to_the_left}"')
    )
    run = read(folder).runs[0]
    assert run.inputs["floor.slope_x"][0] == 0.02
    assert run.inputs["floor.slope_y"][0] == pytest.approx(np.radians(-1))


def test_a_ramp_may_be_a_column(campaign):
    data = motion()
    ramp = np.where(data[:, 0] < 1.0, 0.0, 3.0)
    cells = rows(np.column_stack([data, ramp]))
    folder = campaign(files={"a.csv": csv_text([*SI, "floor.slope_x [deg]"], cells)})
    assert check(folder) == []
    np.testing.assert_allclose(read(folder).runs[0].inputs["floor.slope_x"], np.radians(ramp))


@pytest.mark.parametrize(
    ("runs", "fact", "cure"),
    [
        (on('floor.rolling_factor = "carpte"'), "there is no floor 'carpte'", "did you mean 'carpet'"),
        (on('floor.slope_x = "2 m"'), "unit 'm' measures a length", "give a unit such as rad or deg"),
        (on("floor.slope_x = 2"), "floor.slope_x reaches 2 rad, above any plausible 0.5 rad", "is it deg?"),
        (
            RUNS.replace("u0 = 1.0\n", 'u0 = 1.0\nset = { "floor.rolling_factor" = 2 }\n', 1),
            "no parameter 'floor.rolling_factor'",
            'it is an input: write constant = { "floor.rolling_factor" = ... } in each run',
        ),
    ],
)
def test_what_is_no_floor_is_said_once(campaign, runs, fact, cure):
    (fault,) = check(campaign(runs=runs), known_parameters={"chair.m": (1.0, 500.0)})
    assert fact in fault.fact and cure in fault.cure
