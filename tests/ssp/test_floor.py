"""The floor as an FMU, against closed forms."""

from __future__ import annotations

import pytest

from tests.fmu.chair import chair

OUTPUTS = ("floor.slope_x", "floor.slope_y", "floor.rolling_factor")
BUILT = {
    "ramp.slope": -0.06,
    "ramp.x_from": 2.0,
    "ramp.x_to": 5.0,
    "cross.slope": 0.03,
    "cross.x_from": 4.0,
    "cross.x_to": 8.0,
    "cross.y_from": -1.0,
    "cross.y_to": 1.0,
    "carpet.rolling_factor": 2.0,
    "carpet.x_from": 10.0,
    "edge.length": 0.4,
}


def test_it_is_level_and_smooth_until_something_is_given(floor):
    with chair(floor) as f:
        f.start()
        for x, y in ((-3.0, 0.0), (2.0, 1.0), (50.0, -4.0)):
            f.set({"chair.x": x, "chair.y": y})
            assert f.get(*OUTPUTS) == [0.0, 0.0, 1.0]


@pytest.mark.parametrize(
    ("x", "y", "wanted"),
    [
        (0.0, 0.0, (0.0, 0.0, 1.0)),
        (3.0, 0.0, (-0.06, 0.0, 1.0)),
        (4.5, 0.0, (-0.06, 0.03, 1.0)),  # patches lie on one another
        (4.5, 1.5, (-0.06, 0.0, 1.0)),  # beside the corridor
        (2.0, 0.0, (-0.03, 0.0, 1.0)),  # half over the edge
        (1.9, 0.0, (-0.06 * 0.25**2 * (3 - 2 * 0.25), 0.0, 1.0)),
        (5.0, 0.0, (-0.03, 0.03, 1.0)),
        (1.8, 0.0, (0.0, 0.0, 1.0)),  # the edge begins half its length before
        (12.0, 0.0, (0.0, 0.0, 2.0)),
        (10.0, 0.0, (0.0, 0.0, 1.5)),
    ],
)
def test_patches_hold_inside_and_blend_at_their_edges(floor, x, y, wanted):
    with chair(floor) as f:
        f.start(BUILT)
        f.set({"chair.x": x, "chair.y": y})
        assert f.get(*OUTPUTS) == pytest.approx(wanted, abs=1e-12)
        assert f.step(0.01).get(*OUTPUTS) == pytest.approx(wanted, abs=1e-12)


def test_its_directional_derivative_is_the_slope_of_the_edge(floor):
    with chair(floor) as f:
        f.start({**BUILT, "chair.x": 2.0})
        known, unknown = (floor.reference(n) for n in ("chair.x", "floor.slope_x"))
        assert f.fmu.getDirectionalDerivative([unknown], [known], [1.0]) == pytest.approx([-0.06 * 1.5 / 0.4], rel=1e-12)
