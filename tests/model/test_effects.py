"""One independent truth for each effect: a closed form that its file does not contain."""

from __future__ import annotations

import casadi as cs
import numpy as np
import pytest

from tests.kit import Place, evaluate
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.model.variant import Variant

SMOOTH = {"resistance.f_r": 0.0, "resistance.f_f": 0.0}


def run(values, inputs=None, T=5.0, n=501):
    simulator = Simulator(Variant().with_values(values))
    t = np.linspace(0, T, n)
    return simulator.run(t, simulator.inputs(n, inputs or {}), tolerance=1e-9)


def results(variant: Variant, x, **inputs) -> dict[str, float]:
    """Outputs at states (u, v, ψ'), algebraic states in place."""
    simulator = Simulator(variant)
    start = dict(zip(("start.u", "start.v", "start.psi_dot"), x, strict=True))
    p = variant.with_values(start).vector()
    named = {name.replace("__", "."): value for name, value in inputs.items()}
    trajectory = simulator.run(np.array([0.0]), simulator.inputs(1, named), p)
    return {name: trajectory[name][0] for name in trajectory.names}


def test_rolling_resistance_speed_decays_exponentially():
    result = run({**SMOOTH, "effect.rolling_resistance_speed.k": 20.0})
    np.testing.assert_allclose(result["chair.u"], np.exp(-20.0 / 80.0 * result.time), rtol=1e-7)


def test_floor_slope_accelerates_by_g_sin():
    result = run({**SMOOTH, "effect.floor_slope.x": 0.02, "start.u": 0.0})
    np.testing.assert_allclose(result["chair.u"], 9.81 * np.sin(0.02) * result.time, rtol=1e-7, atol=1e-12)
    across = results(Variant().with_values({"effect.floor_slope.y": 0.02, "start.psi": np.pi / 2}), (0.0, 0.0, 0.0))
    assert across["sensor.a_x"] == pytest.approx(-9.81 * np.sin(0.02), abs=0.2)


def test_wheel_inertia_is_mass_ahead_and_in_the_turn():
    ahead = run({**SMOOTH, "effect.wheel_inertia.m": 3.0, "start.u": 0.0}, {"push.F_rl": 10.0, "push.F_rr": 10.0})
    np.testing.assert_allclose(ahead["chair.u"], 20.0 / 83.0 * ahead.time, rtol=1e-8, atol=1e-12)
    variant = Variant().with_values({"effect.wheel_inertia.m": 3.0})
    model = variant.model()
    (mass,) = evaluate(model, Place(np.zeros(6), np.zeros(9), variant.vector()), model.mass)
    assert mass[5] == pytest.approx(3.08 + 2 * 1.5 * 0.275**2)  # two wheels of 1.5 kg at t_r/2


def test_camber_thrust_starts_a_straight_chair_sideways():
    variant = Variant().with_values({**SMOOTH, "effect.camber_misalignment.phi_r": 0.02,
                                     "effect.camber_misalignment.phi_l": 0.01})  # fmt: skip
    here = results(variant, (1.0, 0.0, 0.0))
    assert here["force.F_srr"] == pytest.approx(464 * 0.02, rel=2e-4)
    assert here["sensor.a_y"] == pytest.approx(464 * 0.03 / 80, rel=2e-4)


def test_saturated_force_is_the_magic_formula_and_ends_at_mu_N():
    variant = Variant().with_values({"effect.tyre_saturation.inv_mu": 1 / 0.7})
    N = 80 * 9.81 * 0.25 / 0.45 / 2
    for slip in (0.001, 0.02, 0.1, 1.0):
        here = results(variant, (np.cos(slip) * 3, -np.sin(slip) * 3, 0.0))
        D, C = 0.7 * N, 1.3
        expected = D * np.sin(C * np.arctan(5038.0 / (C * D) * slip))  # (1) with E = 0
        assert here["force.F_srl"] == pytest.approx(expected, rel=1e-4)
        assert here["force.F_srl"] < 0.7 * N


def test_a_chair_without_saturation_is_linear_exactly():
    here = results(Variant().with_values({"effect.tyre_saturation.inv_mu": 0.0}), (1.0, -0.1, 0.0))
    assert here["force.F_srl"] == 5038.0 * here["slip.rl"]


def test_relaxation_length_adds_the_string_models_eigenvalue():
    """Straight ahead: m v' = −m u r + 2Cα, I r' = −2bCα − 2C_m α, σ α' = −u α − (v − b r)."""
    u, sigma, m, I_z, b, C, C_m = 1.2, 0.1, 80.0, 3.08, 0.2, 5038.0, 45.0
    expected = np.linalg.eigvals(
        [[0, -u, 2 * C / m], [0, 0, -2 * (b * C + C_m) / I_z], [-1 / sigma, b / sigma, -u / sigma]]
    )
    variant = Variant().with_values({**SMOOTH, "effect.relaxation_length.sigma": sigma, "regularisation.slip_speed": 1e-5})
    model = variant.model()
    x = np.zeros(8)
    x[3] = u
    A, mass = evaluate(model, Place(x, np.zeros(9), variant.vector()), cs.jacobian(model.f, model.x), model.mass)
    A = (A / mass[:, None])[3:, 3:]
    # left and right tyre alike: the antisymmetric mode −u/σ and speed's 0 come on top
    found = np.linalg.eigvals(A)
    for value in (*expected, -u / sigma, 0):
        assert np.abs(found - value).min() < 1e-3 * (1 + abs(value))


def test_lateral_load_transfer_balances_the_overturning_moment():
    h, u, r = 0.5, 1.5, 1.0
    variant = Variant().with_values({"effect.lateral_load_transfer.h": h})
    here = results(variant, (u, 0.18 * r, r))
    moment = (here["load.rl"] - here["load.rr"]) * 0.55 / 2 + (here["load.fl"] - here["load.fr"]) * 0.45 / 2
    assert moment == pytest.approx(80.0 * here["sensor.a_y"] * h, rel=1e-9)
    assert abs(here["sensor.a_y"]) > 0.1
    assert sum(here[f"load.{w}"] for w in ("rl", "rr", "fl", "fr")) == pytest.approx(80 * 9.81)


def test_cm_lateral_offset_balances_loads_and_turns_a_straight_push():
    variant = Variant().with_values({**SMOOTH, "effect.cm_lateral_offset.y": 0.01})
    here = results(variant, (0.0, 0.0, 0.0))
    moment = (here["load.rr"] - here["load.rl"]) * 0.55 / 2 + (here["load.fr"] - here["load.fl"]) * 0.45 / 2
    assert moment == pytest.approx(80 * 9.81 * 0.01, rel=1e-9)
    model = variant.model()
    w = np.array([i.start for i in model.inputs])
    w[:2] = 10.0
    M_z = evaluate(model, Place(np.zeros(6), w, variant.vector()), model.quantities["M_z"])[0]
    assert M_z.item() == pytest.approx(2 * 10.0 * 0.01)  # the pushes pass 10 mm to the left of the CM


def test_push_force_gain_divides_the_record():
    result = run({**SMOOTH, "effect.push_force_gain.r": 0.25, "effect.push_force_gain.l": 0.25, "start.u": 0.0},
                 {"push.F_rl": 10.0, "push.F_rr": 10.0})  # fmt: skip
    np.testing.assert_allclose(result["chair.u"], 16.0 / 80.0 * result.time, rtol=1e-8, atol=1e-12)


def test_gyro_scale_is_in_the_reading_only():
    here = results(Variant().with_values({"effect.gyro_scale.k": 0.05}), (1.0, 0.1, 0.5))
    assert here["sensor.yaw_rate"] == pytest.approx(1.05 * 0.5)
    assert here["chair.psi_dot"] == 0.5
