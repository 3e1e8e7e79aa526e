"""At rest, on the spot, in reverse and on slopes, where the paper's equations fail."""

from __future__ import annotations

import numpy as np
import pytest

from tests.kit import anywhere
from tests.model.effects.chair import snapshot
from wheelchair_fmu.contracts.places import Place, evaluate
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.model.variant import Variant


def run(values=None, inputs=None, T=10.0, n=1001, **how):
    simulator = Simulator(Variant().with_values(values or {}))
    t = np.linspace(0, T, n)
    forces = {k: v(t) if callable(v) else v for k, v in (inputs or {}).items()}
    return simulator.run(t, simulator.inputs(n, forces), **how)


def test_rest_stays_rest():
    result = run({"start.u": 0.0})
    np.testing.assert_array_equal(result.states, 0)


def test_coasting_stops_where_energy_says():
    """½ m u² = (D_r + D_f) x, and then nothing moves."""
    result = run()
    drag = 9.81 * (0.012 * 0.25 + 0.020 * 0.20) / 0.45
    assert result["chair.x"][-1] == pytest.approx(0.5 / drag, rel=1e-5)
    assert np.abs(result["chair.u"][700:]).max() < 1e-9


def test_straight_stays_straight():
    result = run(inputs={"push.F_rl": 10.0, "push.F_rr": 10.0})
    for name in ("chair.y", "chair.psi", "chair.v", "chair.psi_dot", "slip.rl"):
        np.testing.assert_array_equal(result[name], 0)


@pytest.mark.parametrize("u", [1.0, 0.0, -0.8])
def test_mirrored_pushes_give_a_mirrored_path(u):
    def wave(t):
        return 8 * np.sin(t)

    def other(t):
        return 3 * np.cos(t)

    one = run({"start.u": u}, {"push.F_rl": wave, "push.F_rr": other})
    two = run({"start.u": u}, {"push.F_rl": other, "push.F_rr": wave})
    np.testing.assert_allclose(one["chair.x"], two["chair.x"], atol=1e-9)
    np.testing.assert_allclose(one["chair.y"], -two["chair.y"], atol=1e-9)


def test_spin_on_the_spot_turns_about_the_rear_axle():
    result = run({"start.u": 0.0}, {"push.F_rl": 20.0, "push.F_rr": -20.0}, T=3)
    assert result["chair.psi_dot"][-1] > 1
    # the axle's middle, b behind the CM, is where hubs have no lateral velocity: v = b ψ'
    np.testing.assert_allclose(result["chair.v"][-1], 0.20 * result["chair.psi_dot"][-1], rtol=0.01)
    assert np.isfinite(result.results).all()


def test_reverse_is_forward_seen_from_behind_where_nothing_trails():
    """Without trail and camber and with all drag at the CM alike, backing up is symmetric to rolling on."""
    no_trail = {"tyre.C_m_lambda": 0.0, "resistance.f_f": 0.0}
    ahead = run({**no_trail, "start.u": 1.0}, T=4)
    back = run({**no_trail, "start.u": -1.0}, T=4)
    np.testing.assert_allclose(ahead["chair.x"], -back["chair.x"], atol=1e-9)


def test_torque_changes_sides_in_reverse():
    model, variant = Variant().model(), Variant()
    for u, expected in ((1.0, -1), (-1.0, 1)):
        x = np.array([0, 0, 0, u, 0.01, 0])
        M_t, lam = evaluate(
            model, Place(x, np.zeros(len(model.inputs)), variant.vector()), model.quantities["M_t"], model.quantities["lam"]
        )
        np.testing.assert_allclose(M_t, expected * 45.0 * lam, rtol=1e-3)


def test_camber_pushes_no_chair_at_rest():
    camber = {"effect.camber_misalignment.sum": 0.1, "start.u": 0.0}
    np.testing.assert_array_equal(run(camber).states, 0)


@pytest.mark.parametrize("share", [0.5, 0.9, 0.99, 0.999])
@pytest.mark.parametrize("axis", ["floor.slope_x", "floor.slope_y"])
def test_held_by_rolling_resistance_it_creeps_less_than_a_tenth_of_a_millimetre_a_second(share, axis):
    resistance = (0.012 * 0.25 + 0.020 * 0.20) / 0.45  # of the weight, straight
    slope = share * resistance if axis == "floor.slope_x" else 0.5 * share * resistance
    result = run({"start.u": 0.0}, {axis: slope}, T=20)
    speed = np.hypot(result["chair.u"], result["chair.v"])
    assert speed[100:].max() < 1e-4


@pytest.mark.parametrize(("fall_x", "fall_y"), [(0.3, 0.0), (0.3, -0.4), (0.5, 0.5)])
def test_gravity_is_as_strong_on_a_slope_as_on_the_level(fall_x, fall_y):
    """Along the floor's axes, whichever way the chair stands, and into the floor, it is one vector of length g."""
    now = snapshot({"start.psi": 0.7}, {"floor.slope_x": fall_x, "floor.slope_y": fall_y})
    assert np.linalg.norm([now["g_x"], now["g_y"], now["g_z"]]) == pytest.approx(9.81, rel=1e-12)
    to_room = np.exp(0.7j) * (now["g_x"] + 1j * now["g_y"])
    assert (to_room.real, to_room.imag) == pytest.approx((9.81 * np.sin(fall_x), 9.81 * np.sin(fall_y)))


def test_it_rolls_where_the_slope_pulls_harder():
    result = run({"start.u": 0.0}, {"floor.slope_x": 0.03}, T=5)
    resistance = (0.012 * 0.25 + 0.020 * 0.20) / 0.45
    assert result["chair.u"][-1] == pytest.approx(5 * 9.81 * (np.sin(0.03) - resistance * np.cos(0.03)), rel=1e-4)


def test_brakes_hold_on_a_ramp():
    result = run({"start.u": 0.0}, {"floor.slope_x": 0.1, "brake.rl": 1.0, "brake.rr": 1.0}, T=10)
    assert np.abs(result["chair.u"]).max() < 1e-4


def test_accelerometers_do_not_feel_gravity_along_a_slope():
    """Coasting without resistance down a slope, the reading is zero."""
    result = run({"resistance.f_r": 0.0, "resistance.f_f": 0.0}, {"floor.slope_x": 0.02}, T=2)
    np.testing.assert_allclose(result["sensor.a_x"], 0, atol=1e-9)
    assert result["chair.u"][-1] == pytest.approx(1 + 2 * 9.81 * np.sin(0.02), rel=1e-6)


def test_energy_never_rises_without_a_push():
    """Without camber and self-aligning torque, at random states: m (u u' + v v') + I ψ' ψ'' ≤ 0."""
    variant = Variant().with_values({"tyre.C_m_lambda": 0.0})
    model, rng = variant.model(), np.random.default_rng(4)
    for speed in np.linspace(-2, 2, 200):
        place = anywhere(variant, rng, speed * rng.choice([1, 1e-3]), spread=0)
        still = Place(place.x, np.array([i.start for i in model.inputs]), place.p)
        (f,) = evaluate(model, still, model.f)
        assert f[3:6] @ place.x[3:6] <= 1e-12


def test_prescribed_speed_needs_the_push_that_free_speed_keeps():
    turn = {"push.F_rl": 10.0, "push.F_rr": -10.0}
    held = run({"speed.mode": "prescribed", "speed.u": 1.0}, turn, tolerance=1e-9)
    np.testing.assert_array_equal(held["chair.u"], 1.0)
    needed = held["push.total_needed"]
    free = run(
        {"start.u": 1.0}, {"push.F_rl": lambda t: 10 + needed / 2, "push.F_rr": lambda t: -10 + needed / 2}, tolerance=1e-9
    )
    np.testing.assert_allclose(free["chair.u"], 1.0, atol=2e-5)
    np.testing.assert_allclose(free["chair.psi_dot"][-1], held["chair.psi_dot"][-1], rtol=1e-4)


def test_axle_torque_pushes_with_its_arm():
    force = run(inputs={"push.F_rl": 10.0, "push.F_rr": 5.0})
    torque = run(inputs={"push.M_rl": 10.0 * 0.31, "push.M_rr": 5.0 * 0.31})
    np.testing.assert_allclose(torque.states, force.states, atol=1e-9)


def test_a_spin_has_finite_curvature_and_a_wheel_off_the_ground_is_said():
    assert np.isfinite(run({"start.u": 0.0}, {"push.F_rl": 10.0, "push.F_rr": -10.0})["chair.curvature"]).all()
    hard = run({"effect.lateral_load_transfer.h": 0.9, "start.u": 4.0, "start.psi_dot": 3.0}, T=0.02, n=3)
    assert hard["load.lifted"][0] == 1
    assert run()["load.lifted"].max() == 0
