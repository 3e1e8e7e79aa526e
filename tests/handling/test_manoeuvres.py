"""The manoeuvres: signs and shapes as the paper has them, and every option refused that cannot be."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.errors import UsageError
from wheelchair_fmu.handling.key_numbers import key_numbers
from wheelchair_fmu.handling.manoeuvres import INTERVAL, MANOEUVRES, manoeuvre


@pytest.mark.parametrize("name", MANOEUVRES)
def test_time_is_even_and_every_input_fits_it(name):
    m = manoeuvre(name, time=3.0)
    assert m.name == name and m.time[0] == 0 and m.time[-1] == pytest.approx(3.0)
    assert np.allclose(np.diff(m.time), INTERVAL)
    assert all(column.shape == m.time.shape and np.isfinite(column).all() for column in m.inputs.values())


def test_steady_turn_is_a_constant_difference_of_two_delta_f():
    m = manoeuvre("steady-turn", speed=1.5, delta_force=7.0)
    assert np.all(m.inputs["push.F_rl"] - m.inputs["push.F_rr"] == 14.0)
    assert m.values == {"speed.mode": "prescribed", "speed.u": 1.5, "start.u": 1.5}


def test_slalom_is_a_cosine_of_period_t():
    m = manoeuvre("slalom", period=2.0, delta_force=5.0, time=4.0)
    difference = m.inputs["push.F_rl"] - m.inputs["push.F_rr"]
    assert difference[[0, 50, 100, 200]] == pytest.approx([10.0, 0.0, -10.0, 10.0], abs=1e-12)


def test_start_stop_pushes_pulls_and_brakes_from_rest():
    m = manoeuvre("start-stop")
    left, right = m.inputs["push.F_rl"], m.inputs["push.F_rr"]
    assert np.array_equal(left, right) and left.max() == pytest.approx(40, rel=1e-3) and left.min() < -39
    assert m.values["start.u"] == 0.0 and m.inputs["brake.rl"][0] == 0.0 and m.inputs["brake.rl"][-1] == 1.0


def test_spin_turns_right_then_left_without_a_net_push():
    m = manoeuvre("spin", delta_force=9.0)
    assert np.all(m.inputs["push.F_rl"] + m.inputs["push.F_rr"] == 0)
    assert m.inputs["push.F_rl"].max() == 9.0 and m.inputs["push.F_rl"].min() == -9.0 and m.inputs["push.F_rl"][-1] == 0


@pytest.mark.parametrize(
    ("name", "options", "sentence"),
    [
        ("stedy-turn", {}, "no manoeuvre 'stedy-turn'; did you mean 'steady-turn'?"),
        ("steady-turn", {"speed": float("nan")}, "--speed nan m/s is impossible here; give a number above 0, at most 20 m/s"),
        ("slalom", {"speed": 0.0}, "--speed 0 m/s is impossible here"),
        ("slalom", {"speed": -1.0}, "--speed -1 m/s is impossible here"),
        ("slalom", {"speed": 21.0}, "at most 20 m/s"),
        ("slalom", {"period": 0.0}, "--period 0 s is impossible here; give a number above 0"),
        ("slalom", {"period": -4.0}, "--period -4 s"),
        ("slalom", {"period": 0.02}, "--period 0.02 s is shorter than ten samples"),
        ("slalom", {"period": float("inf")}, "--period inf s"),
        ("slalom", {"delta_force": float("nan")}, "--delta-force nan N is outside ±2000 N"),
        ("spin", {"delta_force": 1e4}, "--delta-force 10000 N is outside ±2000 N"),
        ("coast-down", {"speed": 0.0}, "a coast-down starts in motion"),
        ("coast-down", {"speed": float("inf")}, "--speed inf m/s"),
        ("coast-down", {"period": 4.0}, "coast-down has no --period; it takes --speed, --time"),
        ("start-stop", {"speed": 1.0}, "start-stop has no --speed; it takes --time"),
        ("spin", {"time": 0.0}, "--time 0 s is impossible here"),
        ("spin", {"time": 0.015}, "--time 0.015 s is shorter than two samples"),
        ("spin", {"time": 1e9}, "--time 1e+09 s is impossible here"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(name, options, sentence):
    with pytest.raises(UsageError) as refused:
        manoeuvre(name, **options)
    assert sentence in str(refused.value) and "\n" not in str(refused.value)


def test_key_numbers_of_a_circle():
    n = 11
    columns = {
        "chair.u": np.full(n, 2.0),
        "chair.psi_dot": np.full(n, 0.5),
        "slip.rl": np.full(n, 0.01),
        "slip.rr": np.full(n, 0.02),
        "chair.x": np.arange(n) * 1.0,
        "chair.y": np.zeros(n),
        "chair.curvature": np.full(n, 0.25),
        "push.total_needed": np.full(n, 11.0),
    }
    numbers = {k.meaning: k for k in key_numbers(columns, held=True)}
    assert numbers["radius of curvature R_c"].end == 4.0
    assert numbers["slip angle, right"].end == pytest.approx(np.degrees(0.02))
    assert numbers["path x, forward"].greatest == 10.0 and numbers["push needed"].mean == 11.0
    assert "push needed" not in {k.meaning for k in key_numbers(columns, held=False)}
    columns["chair.curvature"] = np.zeros(n)
    assert key_numbers(columns, held=False)[0].end == np.inf
