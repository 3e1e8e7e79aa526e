"""Brakes within the friction circle: closed forms of the stop, what is left of side grip, and energy."""

from __future__ import annotations

import numpy as np
import pytest

from tests.model.effects.chair import C_LAMBDA, I_Z, MASS, SMOOTH, A, B, G, run, snapshot
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.model.variant import Variant

N_R = MASS * G * A / (A + B) / 2  # load of a rear wheel
BOTH = {"brake.rl": 1.0, "brake.rr": 1.0}


def test_locked_wheels_stop_the_chair_with_their_friction():
    """2 μ N of the rear axle, however strong the brakes: at half the friction half as fast."""
    for mu in (1.0, 0.5):
        now = snapshot({**SMOOTH, "tyre.mu": mu, "brake.F_max": 3000.0}, BOTH)
        assert -MASS * now["u'"] == pytest.approx(2 * mu * N_R, rel=1e-6)
        np.testing.assert_allclose(now["read_wheel_speed"], 0, atol=1e-6)


def test_the_usual_brake_is_stronger_than_the_tyres_and_locks_them():
    """300 N where a tyre holds 218 N: all but 1 % of μN is used along the wheel, and of the side grip hardly more is left. The
    rim is slowed to a fourteenth of the hub's speed; `spinning` has the wheel that stands."""
    sliding = {**SMOOTH, "start.v": -0.02}
    now, free = snapshot(sliding, BOTH), snapshot(sliding)
    np.testing.assert_allclose(free["N_r"], 218.0, atol=0.01)
    np.testing.assert_allclose(now["braking"], N_R, rtol=0.01)
    assert -MASS * now["u'"] == pytest.approx(2 * N_R, rel=0.01)
    assert np.all(np.abs(now["side"]) < 0.01)
    assert np.all(now["read_wheel_speed"] < 1 / 13)


@pytest.mark.parametrize("share", [0.01, 0.1, 0.3])
def test_a_light_hand_on_the_brake_is_felt_whole(share):
    """Far from the 218 N that a tyre holds, the brake's force is what is said, and side grip hardly less."""
    force = share * N_R
    values = {**SMOOTH, "start.u": 2.0, "start.v": -0.02, "brake.F_max": force}
    now, free = snapshot(values, BOTH), snapshot(values)
    assert MASS * (free["u'"] - now["u'"]) == pytest.approx(2 * force, rel=2e-4)
    np.testing.assert_allclose(now["F_s"] / free["F_s"], np.sqrt(1 - share**2), rtol=2e-4)
    np.testing.assert_allclose(now["read_wheel_speed"], 2.0, rtol=2e-4)


@pytest.mark.parametrize("law", ["dugoff", "magic_formula"])
@pytest.mark.parametrize("brake", [0.2, 0.5, 0.7, 0.8, 1.0])
def test_no_tyre_pulls_harder_than_friction_lets_it(law, brake):
    """At any slip and any brake: a tyre of a law that saturates stays in the circle μN."""
    for slip in (0.0, 0.02, 0.1, 0.5, 1.4):
        values = {**SMOOTH, "tyre.law": law, "start.u": 2 * np.cos(slip), "start.v": -2 * np.sin(slip)}
        now = snapshot(values, {"brake.rl": brake, "brake.rr": brake})
        assert np.all(np.hypot(now["F_w"], now["F_s"]) <= N_R * (1 + 1e-6))


def test_a_locked_wheel_slides_with_its_friction_against_its_way():
    """Under the linear law, too, which knows no other limit; it then neither steers nor turns back."""
    way = np.array([0.8, -0.6])
    now = snapshot({**SMOOTH, "brake.F_max": 3000.0, "start.u": way[0], "start.v": way[1]}, BOTH)
    for F_x, F_y in zip(now["F_w"], now["F_s"], strict=True):
        np.testing.assert_allclose([F_x, F_y], -N_R * way, rtol=1e-5)
    np.testing.assert_allclose(now["M_t"], 0, atol=1e-3)


def test_one_locked_wheel_pulls_the_chair_round():
    """With the left brake only the chair slows by μN, and begins to turn to the left by that with the arm t_r/2."""
    now = snapshot({**SMOOTH, "brake.F_max": 3000.0}, {"brake.rl": 1.0})
    assert MASS * now["u'"] == pytest.approx(-N_R, rel=1e-6)
    assert I_Z * now["psi_dot'"] == pytest.approx(-N_R * 0.55 / 2, rel=1e-6)


def test_brakes_hold_as_far_as_friction_and_no_farther():
    """Parked on ice of μ = 0.1: the rear axle holds μ of its load, so up to tan θ = μ a/(a + b)."""
    hold = 0.1 * A / (A + B)
    for share, slides in ((0.8, False), (1.2, True)):
        slope = np.arctan(share * hold)
        result = run({**SMOOTH, "tyre.mu": 0.1, "start.u": 0.0}, {**BOTH, "floor.slope_x": slope}, T=4.0)
        assert (result["chair.u"][-1] > 0.05) == slides
        if not slides:
            assert np.abs(result["chair.u"]).max() < 1e-4


@pytest.mark.parametrize("start", [(1.5, 0.0, 1.5), (1.0, 0.4, -1.0), (-0.8, 0.2, 2.0), (0.0, 0.3, 0.0)])
@pytest.mark.parametrize("brakes", [(1.0, 1.0), (1.0, 0.0), (0.5, 0.7)])
def test_braking_never_drives(start, brakes):
    values = {"tyre.C_m_lambda": 0.0, **dict(zip(("start.u", "start.v", "start.psi_dot"), start, strict=True))}
    result = run(values, dict(zip(("brake.rl", "brake.rr"), brakes, strict=True)), T=3.0)
    energy = 0.5 * MASS * (result["chair.u"] ** 2 + result["chair.v"] ** 2) + 0.5 * I_Z * result["chair.psi_dot"] ** 2
    assert np.diff(energy).max() < 1e-9 * energy[0]
    assert energy[-1] < 0.2 * energy[0]


def test_an_open_brake_is_none():
    """And the smallest touch of it changes nothing by a jump."""
    values = {**SMOOTH, "start.v": 0.01}
    free, touched = snapshot({**values, "brake.F_max": 0.0}, BOTH), snapshot(values, {"brake.rl": 1e-9, "brake.rr": 1e-9})
    assert free["F_s"][0] == C_LAMBDA * free["lam"][0]
    np.testing.assert_allclose(touched["F_s"], free["F_s"], rtol=1e-12)
    np.testing.assert_allclose(touched["F_w"], free["F_w"], atol=1e-6)


@pytest.mark.parametrize("share", [0.3, 0.6])
def test_a_drag_that_builds_up_lets_a_chair_creep_under_a_light_push(share):
    """Far below the onset's speed the drag is v/v_onset of itself, so that the chair goes at that share of it."""
    onset = 0.01
    chair = Simulator(Variant().with_values({"resistance.onset": onset, "start.u": 0.0}))
    drag = 80.0 * 9.81 * (0.012 * 0.25 + 0.020 * 0.20) / 0.45
    time = np.linspace(0, 5, 501)
    inputs = {"push.F_rl": np.full(501, share * drag / 2), "push.F_rr": np.full(501, share * drag / 2)}
    result = chair.run(time, chair.inputs(501, inputs))
    assert result["chair.u"][-1] == pytest.approx(share * onset, rel=0.02)
    braked = chair.run(time, chair.inputs(501, {**inputs, "brake.rl": np.ones(501), "brake.rr": np.ones(501)}))
    assert abs(braked["chair.u"][-1]) < 1e-4
