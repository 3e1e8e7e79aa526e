"""What slows, turns or pulls a rolling chair, each against a truth its file does not contain."""

from __future__ import annotations

import numpy as np
import pytest

from tests.model.effects.chair import C_LAMBDA, C_M_LAMBDA, I_Z, MASS, SMOOTH, T_R, TOP, A, B, G, run, snapshot
from wheelchair_fmu.handling.trim import Chair, trim
from wheelchair_fmu.model.variant import Variant

ALL = (
    "aerodynamic_drag",
    "floor_cross_slope",
    "floor_slope",
    "pivot_torque",
    "rolling_resistance_asymmetry",
    "rolling_resistance_speed",
    "scrub_torque",
    "scrub_torque_viscous",
    "turn_slip",
)


def drive(values, inputs=None, **how):
    return run(values, inputs, among=ALL, **how)


@pytest.mark.effect("rolling_resistance_speed")
def test_rolling_resistance_speed_decays_exponentially():
    k = 20.0
    result = drive({**SMOOTH, "effect.rolling_resistance_speed.k": k})
    np.testing.assert_allclose(result["chair.u"], np.exp(-k / MASS * result.time), rtol=1e-7)


@pytest.mark.effect("rolling_resistance_speed")
def test_a_spin_on_the_spot_is_slowed_by_its_rolling_wheels():
    """All the weight on the rear axle of a top, each wheel with half of k at the arm t_r/2: I_z ψ'' = −k (t_r/2)² ψ'."""
    k, spin = 50.0, 2.0
    result = drive({**TOP, "start.psi_dot": spin, "effect.rolling_resistance_speed.k": k})
    expected = spin * np.exp(-k * (T_R / 2) ** 2 / I_Z * result.time)
    np.testing.assert_allclose(result["chair.psi_dot"], expected, rtol=1e-6)


@pytest.mark.effect("aerodynamic_drag")
@pytest.mark.parametrize("u", [3.0, -3.0])
def test_air_slows_a_coasting_chair_by_the_quadratic_law(u):
    """m u' = −k u |u|: 1/|u| grows linearly, the way like a logarithm; backward as forward."""
    k = 5.0
    result = drive({**SMOOTH, "start.u": u, "effect.aerodynamic_drag.k": k})
    growth = 1 + k * abs(u) / MASS * result.time
    np.testing.assert_allclose(result["chair.u"], u / growth, rtol=1e-7)
    np.testing.assert_allclose(result["chair.x"], np.sign(u) * MASS / k * np.log(growth), rtol=1e-7)


@pytest.mark.effect("aerodynamic_drag")
def test_down_a_slope_the_chair_ends_at_its_terminal_speed():
    k, slope = 20.0, 0.1
    result = drive({**SMOOTH, "start.u": 0.0, "effect.aerodynamic_drag.k": k}, {"floor.slope_x": slope}, T=30)
    terminal = np.sqrt(MASS * G * np.sin(slope) / k)
    np.testing.assert_allclose(
        result["chair.u"], terminal * np.tanh(G * np.sin(slope) / terminal * result.time), rtol=1e-6, atol=1e-9
    )


@pytest.mark.effect("scrub_torque")
def test_dry_scrub_stops_a_spin_at_its_time_and_angle():
    """I_z ψ'' = −M: linearly down to rest at t = I_z ψ'₀ / M, after the angle ½ I_z ψ'₀² / M that energy says."""
    M, spin = 1.0, 1.0
    result = drive({**TOP, "start.psi_dot": spin, "effect.scrub_torque.M": M, "effect.scrub_torque.rate": 1e-5})
    expected = np.maximum(spin - M / I_Z * result.time, 0)
    np.testing.assert_allclose(result["chair.psi_dot"], expected, atol=1e-5)  # the rate within which it builds up
    assert result["chair.psi"][-1] == pytest.approx(I_Z * spin**2 / (2 * M), rel=1e-5)


@pytest.mark.effect("scrub_torque")
def test_dry_scrub_holds_a_chair_against_a_weaker_torque():
    M = 1.0
    for share, turns in ((0.99, False), (1.5, True)):
        F = share * M / T_R
        result = drive({**TOP, "effect.scrub_torque.M": M, "effect.scrub_torque.rate": 1e-5}, {"push.F_rl": F, "push.F_rr": -F})
        expected = (share - 1) * M / I_Z * result.time[-1] if turns else 0.0
        assert result["chair.psi_dot"][-1] == pytest.approx(expected, rel=1e-4, abs=2e-5)


@pytest.mark.effect("scrub_torque_viscous")
def test_viscous_scrub_fades_a_spin_exponentially():
    """I_z ψ'' = −d ψ', which ends after the angle I_z ψ'₀ / d."""
    d, spin = 3.0, 2.0
    result = drive({**TOP, "start.psi_dot": spin, "effect.scrub_torque_viscous.d": d}, T=20)
    np.testing.assert_allclose(result["chair.psi_dot"], spin * np.exp(-d / I_Z * result.time), rtol=1e-6, atol=1e-8)
    assert result["chair.psi"][-1] == pytest.approx(I_Z * spin / d, rel=1e-6)


@pytest.mark.effect("rolling_resistance_asymmetry")
def test_a_wheel_that_rolls_harder_is_held_by_as_much_more_push():
    """With D more on the left a chair coasts to the left, keeps its speed, and runs straight under D more push there."""
    D = 1.5
    values = {"effect.rolling_resistance_asymmetry.D": D}
    even, free = drive({}), drive(values)
    assert free["chair.psi"][100] < -0.01
    np.testing.assert_allclose(free["chair.u"][:2], even["chair.u"][:2], rtol=1e-6)
    held = drive(values, {"push.F_rl": D / 2, "push.F_rr": -D / 2})
    np.testing.assert_allclose(held["chair.u"], even["chair.u"], rtol=1e-5)
    np.testing.assert_allclose(held["chair.psi"], 0, atol=1e-12)


@pytest.mark.effect("rolling_resistance_asymmetry")
@pytest.mark.parametrize("D", [1.5, 5.0, 30.0, -50.0])
def test_however_unlike_no_wheel_drives(D):
    """The wheels differ by D; both share the chair's own 5.2 N until one has none left, and then the other has all of D."""
    now = snapshot({"effect.rolling_resistance_asymmetry.D": D})
    left, right = now["F_t"] - now["F_w"]
    own = 2 * 0.012 * MASS * G * A / (A + B) / 2
    assert left - right == pytest.approx(D, rel=1e-9)
    assert left + right == pytest.approx(max(own, abs(D)), rel=1e-4)
    assert min(left, right) >= 0


@pytest.mark.effect("rolling_resistance_asymmetry")
@pytest.mark.parametrize("start", [(0.02, 0.0), (0.0, 0.1), (-0.5, 1.0)])
def test_a_wheel_that_rolls_harder_takes_energy_from_any_motion(start):
    u, r = start
    result = drive(
        {"tyre.C_m_lambda": 0.0, "start.u": u, "start.psi_dot": r, "effect.rolling_resistance_asymmetry.D": 30.0}, T=3.0
    )
    energy = 0.5 * MASS * (result["chair.u"] ** 2 + result["chair.v"] ** 2) + 0.5 * I_Z * result["chair.psi_dot"] ** 2
    assert np.diff(energy).max() < 1e-9 * energy[0] + 1e-12
    assert energy[-1] < 0.5 * energy[0]


@pytest.mark.effect("floor_slope")
def test_a_floor_that_falls_along_its_diagonal_is_rolled_down_and_up():
    """Slopes x and y alike: heading 45° is the fall line, on which u' = √2 g sin; the floor does not turn with the chair."""
    fall = np.sqrt(2) * G * np.sin(0.02)
    floor = {**SMOOTH, "effect.floor_slope.x": 0.02, "effect.floor_slope.y": 0.02}
    down = drive({**floor, "start.psi": np.pi / 4, "start.u": 0.0})
    np.testing.assert_allclose(down["chair.u"], fall * down.time, rtol=1e-7, atol=1e-12)
    up = drive({**floor, "start.psi": np.pi / 4 + np.pi, "start.u": 1.0}, n=5001)
    highest = -(up["chair.x"] + up["chair.y"]).min() / np.sqrt(2)
    assert highest == pytest.approx(1.0 / (2 * fall), rel=1e-6)  # ½ u² = g h
    np.testing.assert_allclose(down["sensor.a_x"], 0, atol=1e-9)  # a free fall along the floor


@pytest.mark.effect("floor_cross_slope")
def test_across_a_slope_a_free_chair_turns_downhill_in_a_circle():
    """Without self-aligning torque the rear tyres can carry no force, so u ψ' = g sin θ, whatever the heading by then."""
    theta, u = 0.02, 1.0
    result = drive(
        {**SMOOTH, "tyre.C_m_lambda": 0.0, "speed.mode": "prescribed", "speed.u": u, "effect.floor_cross_slope.theta": theta},
        T=30,
    )
    late = result.time > 15
    np.testing.assert_allclose(result["chair.psi_dot"][late], G * np.sin(theta) / u, rtol=1e-6)
    np.testing.assert_allclose(result["sensor.a_y"][late], 0, atol=1e-6)
    assert result["chair.psi"][-1] > 5


@pytest.mark.effect("floor_cross_slope")
def test_across_a_slope_a_chair_is_kept_straight_by_the_arm_of_its_tyres():
    """The rear tyres carry m g sin θ at b and the pneumatic trail behind the CM, which the pushes must balance."""
    weight, slip = MASS * G * np.sin(0.02), -MASS * G * np.sin(0.02) / (2 * C_LAMBDA)
    difference = -weight * (B + C_M_LAMBDA / C_LAMBDA) / T_R
    result = drive(
        {**SMOOTH, "speed.mode": "prescribed", "effect.floor_cross_slope.theta": 0.02},
        {"push.F_rl": difference, "push.F_rr": -difference},
    )
    assert result["chair.psi_dot"][-1] == pytest.approx(0, abs=1e-5)
    assert result["slip.rl"][-1] == pytest.approx(slip, rel=1e-4)
    assert result["sensor.a_y"][-1] == pytest.approx(-G * np.sin(0.02), rel=1e-4)


@pytest.mark.effect("turn_slip")
@pytest.mark.parametrize("way", [1, -1])
def test_turned_patches_slow_a_spin_evenly(way):
    """On the spot each hub goes round at t_r/2 whatever the rate, so the torque is constant: M / √(1 + (t_r/2L)²) each."""
    M, L, spin = 1.5, 0.4, 2.0
    values = {"effect.turn_slip.M": M, "effect.turn_slip.L": L, "effect.turn_slip.rate": 1e-5}
    result = drive({**TOP, "start.psi_dot": way * spin, **values}, T=1.0)
    slowing = 2 * M / np.sqrt(1 + (T_R / 2 / L) ** 2) / I_Z
    np.testing.assert_allclose(result["chair.psi_dot"], way * (spin - slowing * result.time), rtol=1e-6)


@pytest.mark.effect("pivot_torque")
@pytest.mark.parametrize("left", [True, False])
def test_a_wheel_that_the_chair_turns_about_is_held_and_the_other_is_not(left):
    """About the standing wheel the torque is M; the other goes round it at t_r, by which its torque is less, by L / t_r."""
    M, L, turn = 3.0, 0.04, 0.8
    side = 1 if left else -1
    motion = {"start.psi_dot": turn, "start.u": -side * turn * T_R / 2, "tyre.C_m_lambda": 0.0}
    own = {"effect.pivot_torque.M": M, "effect.pivot_torque.L": L, "effect.pivot_torque.rate": 1e-5}
    torque = snapshot({**SMOOTH, **motion, **own})["M_t"]
    held, rolling = torque if left else torque[::-1]
    assert held == pytest.approx(-M, rel=1e-6)
    assert rolling == pytest.approx(-M * L / np.hypot(T_R, L), rel=1e-6)


@pytest.mark.effect("turn_slip")
@pytest.mark.parametrize("u", [0.5, -0.5, 2.0])
def test_a_patch_on_a_wide_arc_resists_by_its_curvature(u):
    """Twice as fast a yaw at twice the speed is the same arc, and the same torque M L / R of each wheel."""
    M, L, radius = 2.0, 0.6, 50.0
    motion = {"start.u": u, "start.psi_dot": abs(u) / radius, "tyre.C_m_lambda": 0.0}
    torque = snapshot({**SMOOTH, **motion, "effect.turn_slip.M": M, "effect.turn_slip.L": L, "effect.turn_slip.rate": 1e-5})[
        "M_t"
    ]
    hub = radius + np.array([T_R / 2, -T_R / 2]) * np.sign(u)
    np.testing.assert_allclose(torque, -M * L / hub, rtol=1e-3)


@pytest.mark.effect("turn_slip")
@pytest.mark.parametrize(("u", "wider"), [(1.0, (0.10, 0.17)), (0.5, (0.45, 0.55))])
def test_patches_that_take_some_newton_metres_on_the_spot_leave_a_turn_nearly_as_it_was(u, wider):
    """The paper's turn, 10 N to each side: 10 to 17 % wider at 1 m/s and half as much again at 0.5 m/s, where 5 N m that do not
    fall with the radius would make it ten times as wide."""

    def radius(**torque):
        values = {f"effect.{id}.M": torque.get(id, 0.0) for id in ("turn_slip", "scrub_torque")}
        return trim(Chair(Variant().with_values(values)), u, 10.0).radius

    without = radius()
    assert wider[0] < radius(turn_slip=2.5) / without - 1 < wider[1]
    assert radius(scrub_torque=5.0) > 10 * without
    if u == 1.0:
        assert radius(scrub_torque=5.0) == pytest.approx(36.2, abs=0.1)


@pytest.mark.effect("turn_slip")
@pytest.mark.parametrize("law", ["ideal", "swivelling"])
def test_a_turned_caster_is_held_by_a_force_behind_its_pivot(law):
    """In a steady turn both laws give F = T / c across each caster, and no moment at its bearing."""
    T, L, trail, u, turn = 0.8, 0.1, 0.05, 1.0, 0.5
    values = {"caster.trail": trail, "start.u": u, "start.psi_dot": turn}
    if law == "swivelling":
        values |= {"effect.caster_trail.c": trail - 1e-3}
    now, without = (
        snapshot({**SMOOTH, **values, "effect.turn_slip.M_f": M, "effect.turn_slip.L_f": L, "effect.turn_slip.rate": 1e-5})
        for M in (T, 0.0)
    )
    across = np.hypot(now["F_xf"] - without["F_xf"], now["F_yf"] - without["F_yf"])
    pivot = np.hypot(now["v_xf"], now["v_yf"])
    turning = now["psi_dot"] if law == "ideal" else now["turning"]
    rolling = pivot if law == "ideal" else now["rolling"]
    expected = T * L * np.abs(turning) / np.hypot(rolling, L * turning)
    np.testing.assert_allclose(across * trail, expected, rtol=1e-6)
    np.testing.assert_allclose(now["M_f"], 0.0, atol=1e-12)
