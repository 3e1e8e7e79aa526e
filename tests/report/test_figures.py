"""Figures show what they are given, in the units they say, and come out the same each time."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.report.figures import WATCHED, manoeuvre_figure, overlay_figure, staircase_figure, where_figure
from wheelchair_fmu.report.saving import save

TIME = np.linspace(0, 4, 401)


def columns(curvature: np.ndarray) -> dict[str, np.ndarray]:
    return {
        "chair.x": TIME,
        "chair.y": np.sin(TIME),
        "slip.rl": 0.01 * np.sin(TIME),
        "slip.rr": 0.02 * np.sin(TIME),
        "chair.curvature": curvature,
        **{name: 1 + 0 * TIME for name in WATCHED},
    }


def axis(figure, label: str):
    return next(ax for ax in figure.axes if label in ax.get_ylabel())


def test_the_path_has_y_to_the_right_x_up_and_equal_scales():
    figure = manoeuvre_figure("turn", TIME, columns(0.3 + 0 * TIME), "push.total_needed")
    ax = axis(figure, "x of the CM")
    assert "y of the CM" in ax.get_xlabel() and ax.get_aspect() == 1.0
    line = ax.lines[0]
    assert np.array_equal(line.get_xdata(), np.sin(TIME)) and np.array_equal(line.get_ydata(), TIME)
    assert {"start", "end"} <= {text.get_text() for text in ax.get_legend().get_texts()}


def test_slip_is_in_degrees_for_both_wheels():
    figure = manoeuvre_figure("turn", TIME, columns(0.3 + 0 * TIME), "chair.u")
    left, right = axis(figure, "slip angle λ [deg]").lines[:2]
    assert left.get_ydata().max() == pytest.approx(np.degrees(0.01), rel=1e-3)
    assert right.get_ydata().max() == pytest.approx(np.degrees(0.02), rel=1e-3)
    assert (left.get_linestyle(), left.get_color()) != (right.get_linestyle(), right.get_color())


def test_the_radius_breaks_where_the_path_is_straight():
    figure = manoeuvre_figure("slalom", TIME, columns(0.25 * np.cos(2 * TIME)), "chair.u")
    ax = axis(figure, "radius")
    radius = ax.lines[0].get_ydata()
    assert np.nanmin(np.abs(radius)) == pytest.approx(4.0) and np.isnan(radius).any()
    assert np.sign(radius[~np.isnan(radius)]).min() == -1 and ax.get_ylim()[0] < 0 < ax.get_ylim()[1]
    crossing = np.abs(np.diff(np.sign(radius)))
    assert not (crossing == 2).any(), "the line must not run from +∞ to −∞"


def test_a_straight_run_says_so():
    figure = manoeuvre_figure("coast", TIME, columns(0 * TIME), "chair.u")
    assert any("straight" in text.get_text() for text in axis(figure, "radius").texts)


def test_overlays_show_residuals_in_sigmas():
    measured = {"u": 1 + 0 * TIME, "yaw_rate": np.where(TIME > 2, np.nan, 0.1)}
    predicted = {"u": 0.9 + 0 * TIME, "yaw_rate": 0.1 + 0 * TIME}
    figure = overlay_figure("run 1", TIME, measured, predicted, {"u": 0.05, "yaw_rate": 0.01}, {"u": "m/s"})
    assert [ax.get_ylabel() for ax in figure.axes] == ["u [m/s]", "residual [σ]", "yaw_rate", "residual [σ]"]
    assert figure.axes[1].lines[0].get_ydata() == pytest.approx(2.0)
    low, high = figure.axes[3].get_ylim()
    assert low <= -4 and high >= 4


def test_an_estimated_offset_is_taken_off_and_said():
    measured, predicted = {"yaw_rate": 0.15 + 0 * TIME}, {"yaw_rate": 0.1 + 0 * TIME}
    figure = overlay_figure("run 1", TIME, measured, predicted, {"yaw_rate": 0.01}, {"yaw_rate": "rad/s"}, {"yaw_rate": 0.03})
    above, below = figure.axes
    assert above.lines[0].get_ydata() == pytest.approx(0.12)
    assert below.lines[0].get_ydata() == pytest.approx(2.0)
    assert above.get_title(loc="left") == "measured, less its estimated offset of 0.03 rad/s"


def test_the_staircase_marks_the_floor_and_takes_steps_without_held_out_runs():
    ladder = [{"step": "nominal", "fit": 5.0, "heldout": None}, {"step": "+camber", "fit": 1.1, "heldout": 1.2}]
    ax = staircase_figure(ladder).axes[0]
    assert any(np.all(np.asarray(line.get_ydata()) == 1.0) for line in ax.lines)
    assert {"5.00", "1.10", "1.20", "noise floor"} <= {text.get_text() for text in ax.texts}


def test_where_writes_each_number_once_and_leaves_gaps_white():
    ax = where_figure(["a", "b"], ["u", "v"], np.array([[1.0, 20.0], [np.nan, 3.14159]])).axes[0]
    assert sorted(text.get_text() for text in ax.texts) == ["1.00", "20.0", "3.14"]


@pytest.mark.parametrize("ending", [".svg", ".png"])
def test_the_same_data_give_the_same_bytes(tmp_path, ending):
    files = [tmp_path / f"{name}{ending}" for name in "ab"]
    for file in files:
        save(manoeuvre_figure("turn", TIME, columns(0.3 + 0 * TIME), "chair.u"), file)
    assert files[0].read_bytes() == files[1].read_bytes() and files[0].stat().st_size > 10_000
