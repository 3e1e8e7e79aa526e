"""Rear wheels whose spin is a state: when they lock and spin, what friction then does, and the limits in which they roll."""

from __future__ import annotations

import numpy as np
import pytest

from tests.model.effects.chair import I_Z, MASS, SMOOTH, T_R, A, B, G, run, snapshot
from wheelchair_fmu.model.choice import Choice

N_R = MASS * G * A / (A + B) / 2  # load of a rear wheel
INERTIA, R = 0.14, 0.31
SPUN = INERTIA / R**2  # kg, of one wheel at its rim
SPINNING = Choice(wheel="spinning")
BOTH = {"brake.rl": 1.0, "brake.rr": 1.0}
HARD = {**SMOOTH, "brake.F_max": 3000.0}
LIGHT = {"wheel.I": 1e-3, "tyre.C_kappa": 1e6}
STANDING = {"rim.rl": 0.0, "rim.rr": 0.0}


def stopped(values: dict, seconds: float = 3.0):
    return run({**HARD, **values}, BOTH, T=seconds, n=601, choice=SPINNING)


@pytest.mark.parametrize(("u", "mu"), [(2.0, 1.0), (2.0, 0.5), (1.0, 0.3), (-1.5, 0.6)])
def test_locked_wheels_stop_a_chair_within_the_braking_distance(u, mu):
    """u²/(2 μ g) over the rear axle's share of the weight, a/(a + b); a little more while the wheels' own spin is stopped."""
    result = stopped({"start.u": u, "tyre.mu": mu})
    assert abs(result["chair.u"][-1]) < 1e-4
    assert abs(result["chair.x"][-1]) == pytest.approx(u * u / (2 * mu * G * A / (A + B)), rel=0.015)
    locked = result.time > 0.1
    assert np.abs(result["sensor.wheel_speed_l"][locked]).max() < 1e-3


def test_a_brake_below_friction_locks_no_wheel():
    """It slows chair and spin together, by the brakes' force over the mass of both."""
    result = run({**SMOOTH, "brake.F_max": 60.0, "start.u": 2.0}, BOTH, T=0.5, choice=SPINNING)
    rate = 2 * 60.0 / (MASS + 2 * SPUN)
    np.testing.assert_allclose(result["chair.u"], 2 - rate * result.time, atol=0.003)
    np.testing.assert_allclose(result["sensor.wheel_speed_r"], result["chair.u"], rtol=0.01)


def test_a_locked_wheel_slides_with_its_friction_against_its_way():
    way = np.array([0.8, -0.6])
    now = snapshot({**HARD, "start.u": way[0], "start.v": way[1]}, BOTH, STANDING, SPINNING)
    for F_x, F_y in zip(now["F_w"], now["F_s"], strict=True):
        np.testing.assert_allclose([F_x, F_y], -N_R * way, rtol=1e-5)
    np.testing.assert_allclose(now["M_t"], 0, atol=1e-3)


def test_one_locked_wheel_pulls_the_chair_round():
    """To its own side, by μN at the arm t_r/2, while the other one rolls on."""
    now = snapshot(HARD, {"brake.rl": 1.0}, {"rim.rl": 0.0}, SPINNING)
    assert MASS * now["u'"] == pytest.approx(-N_R, rel=1e-6)
    assert I_Z * now["psi_dot'"] == pytest.approx(-N_R * T_R / 2, rel=1e-6)
    result = run({**HARD, "start.u": 1.0}, {"brake.rl": 1.0}, T=1.0, choice=SPINNING)
    assert result["chair.psi"][-1] < -0.5
    assert abs(result["sensor.wheel_speed_l"][-1]) < 1e-3 < 0.1 < result["sensor.wheel_speed_r"][-1]


@pytest.mark.parametrize("push", [120.0, -120.0])
def test_a_push_beyond_friction_spins_the_wheels(push):
    """On a wet floor: the chair gets μN of each, either way, and the rest turns the wheel."""
    mu = 0.3
    result = run({**SMOOTH, "tyre.mu": mu, "start.u": 0.0}, {"push.F_rl": push, "push.F_rr": push}, T=0.5, choice=SPINNING)
    held = np.copysign(mu * N_R, push)
    late = result.time > 0.1
    u, rim = (np.polyfit(result.time[late], result[name][late], 1)[0] for name in ("chair.u", "sensor.wheel_speed_r"))
    assert u == pytest.approx(2 * held / MASS, rel=1e-3)
    assert rim == pytest.approx((push - held) / SPUN, rel=1e-3)


@pytest.mark.parametrize("side", ["l", "r"])
@pytest.mark.parametrize("push", [1.0, -1.0])
def test_the_law_without_spin_says_when_a_push_would_spin_a_wheel(side, push):
    """At μN and not before, whichever way; a brake takes its part of the push. Wheels that can spin need no such word."""
    for share, said in ((0.99, 0), (1.01, 1)):
        inputs = {f"push.F_r{side}": push * share * 0.3 * N_R}
        for choice in (Choice(), SPINNING):
            result = run({"tyre.mu": 0.3, "start.u": push}, inputs, T=0.1, n=3, choice=choice)
            assert np.all(result["push.beyond_friction"] == (said if choice == Choice() else 0))
    braked = {f"push.F_r{side}": push * 0.35 * N_R, f"brake.r{side}": 0.1 * N_R / 300}
    assert not run({"tyre.mu": 0.3, "start.u": push}, braked, T=0.1, n=3)["push.beyond_friction"].any()


def test_wheels_that_spin_have_no_side_grip():
    """Friction goes with the patch's way, which is all but along the wheel."""
    aside, spin = 0.1, 20.0
    grip, spun = (
        snapshot({**SMOOTH, "start.v": aside}, None, {"rim.rl": rim, "rim.rr": rim}, SPINNING) for rim in (1.0, spin + 1)
    )
    np.testing.assert_allclose(spun["F_s"], -N_R * aside / np.hypot(spin, aside), rtol=1e-4)
    assert np.all(np.abs(spun["F_s"]) < 0.01 * np.abs(grip["F_s"]))


@pytest.mark.parametrize("law", ["dugoff", "magic_formula"])
def test_no_tyre_pulls_harder_than_friction_lets_it(law):
    rng = np.random.default_rng(3)
    for _ in range(5):
        u, v, rim = rng.normal(size=3) * rng.choice([0.1, 1.0, 3.0], 3)
        values = {**SMOOTH, "tyre.law": law, "start.u": u, "start.v": v, "tyre.mu": 0.7}
        now = snapshot(values, None, {"rim.rl": rim, "rim.rr": u + 0.02 * rim}, SPINNING)
        assert np.all(np.hypot(now["F_w"], now["F_s"]) <= 0.7 * N_R * (1 + 1e-6))


PUSHES = {
    "push.F_rl": lambda t: 25 * np.sin(3 * t),
    "push.F_rr": lambda t: 20 * np.sin(3 * t + 0.4),
    "brake.rl": lambda t: 0.05 * (t > 2) * (t - 2),
}


def test_light_wheels_on_stiff_patches_roll():
    """As the law without spin says, also through rest, under brakes and in reverse."""
    one = run({**LIGHT, "start.u": 0.3}, PUSHES, T=4.0, choice=SPINNING)
    other = run({"start.u": 0.3}, PUSHES, T=4.0)
    for name in ("chair.u", "chair.psi_dot", "chair.x", "chair.y", "sensor.wheel_speed_l", "sensor.wheel_speed_r"):
        np.testing.assert_allclose(one[name], other[name], atol=2e-3 * np.abs(other[name]).max(), err_msg=name)


def test_heavy_wheels_that_roll_are_the_effect_of_their_inertia():
    heavy = {"wheel.I": 1.0, "tyre.C_kappa": 1e6}
    one = run({**heavy, "start.u": 0.8}, PUSHES, T=2.0, choice=SPINNING)
    other = run({"start.u": 0.8, "effect.wheel_inertia.m": 2 * 1.0 / R**2}, PUSHES, T=2.0)
    without = run({"start.u": 0.8}, PUSHES, T=2.0)
    for name in ("chair.u", "chair.psi_dot"):
        apart = np.abs(without[name] - other[name]).max()
        np.testing.assert_allclose(one[name], other[name], atol=0.01 * apart, err_msg=name)


def test_a_soft_patch_creeps_as_the_effect_of_its_slip():
    """A driven wheel turns faster by F/C_κ, once its spin has come up with the push."""
    push, stiffness = 40.0, 5000.0
    one = run(
        {**SMOOTH, "wheel.I": 1e-3, "tyre.C_kappa": stiffness}, {"push.F_rl": push, "push.F_rr": push}, 1.0, choice=SPINNING
    )
    assert one["sensor.wheel_speed_l"][-1] / one["chair.u"][-1] - 1 == pytest.approx(push / stiffness, rel=1e-2)


@pytest.mark.parametrize("start", [(1.5, 0.0, 1.5), (1.0, 0.4, -1.0), (-0.8, 0.2, 2.0), (0.0, 0.3, 0.0)])
@pytest.mark.parametrize("brakes", [(1.0, 1.0), (1.0, 0.0), (0.5, 0.7)])
def test_energy_of_chair_and_wheels_together_never_rises(start, brakes):
    values = {"tyre.C_m_lambda": 0.0, **dict(zip(("start.u", "start.v", "start.psi_dot"), start, strict=True))}
    result = run(values, dict(zip(("brake.rl", "brake.rr"), brakes, strict=True)), T=3.0, choice=SPINNING)
    energy = 0.5 * MASS * (result["chair.u"] ** 2 + result["chair.v"] ** 2) + 0.5 * I_Z * result["chair.psi_dot"] ** 2
    energy += 0.5 * SPUN * (result["rim.rl"] ** 2 + result["rim.rr"] ** 2)
    assert np.diff(energy).max() < 1e-9 * energy[0]
    assert energy[-1] < 0.2 * energy[0]


def test_brakes_hold_on_a_ramp_as_far_as_friction():
    hold = 0.1 * A / (A + B)
    for share, slides in ((0.8, False), (1.2, True)):
        inputs = {**BOTH, "floor.slope_x": np.arctan(share * hold)}
        result = run({**SMOOTH, "tyre.mu": 0.1, "start.u": 0.0}, inputs, T=4.0, choice=SPINNING)
        assert (result["chair.u"][-1] > 0.05) == slides
        if not slides:
            assert np.abs(result["chair.u"]).max() < 2e-4


def test_with_the_speed_held_the_push_is_what_the_drags_take():
    """Spin or none, once the rims have come to the hubs' speed."""
    held = {"speed.mode": "prescribed", "speed.u": 1.0}
    one, other = run(held, {}, T=1.0, choice=SPINNING), run(held, {}, T=1.0)
    assert one["push.total_needed"][-1] == pytest.approx(other["push.total_needed"][-1], rel=1e-6)


def test_with_the_paper_s_equations_wheels_roll():
    letter = Choice(wheel="spinning", equations="paper")
    one, other = (snapshot({}, {"push.F_rl": 20.0}, choice=c) for c in (letter, Choice(equations="paper")))
    assert one["psi_dot'"] == other["psi_dot'"] and "rim.rl" not in one
