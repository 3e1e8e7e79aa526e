"""Tyres that saturate, lag, feel load and pressure, lean or point aside, each against a truth its file does not contain."""

from __future__ import annotations

from pathlib import Path

import casadi as cs
import numpy as np
import pytest
from scipy.integrate import trapezoid

from tests.model.effects.chair import C_LAMBDA, C_M_LAMBDA, C_M_PHI, C_PHI, I_Z, MASS, SMOOTH, A, B, G, run, snapshot
from wheelchair_fmu.contracts.places import Place, evaluate
from wheelchair_fmu.model.variant import Variant

RIG = Path(__file__).parents[3] / "examples" / "rotating-disc.csv"
N_R = MASS * G * A / (A + B) / 2  # load of a rear wheel


def slipping(slip: float, values: dict, speed: float = 3.0) -> dict:
    """A chair that moves straight on, its rear tyres at this slip angle."""
    return snapshot({**SMOOTH, **values, "start.u": speed * np.cos(slip), "start.v": -speed * np.sin(slip)})


def lateral_modes(sigma: float, speed: float, **values: float) -> np.ndarray:
    """Eigenvalues of v, ψ' and the two lagged slips, straight ahead."""
    variant = Variant().with_values({**SMOOTH, "effect.relaxation_length.sigma": sigma, **values})
    model, x = variant.model(), np.array([0, 0, 0, speed, 0, 0, 0, 0])
    A, mass = evaluate(
        model, Place(x, np.zeros(len(model.inputs)), variant.vector()), cs.jacobian(model.f, model.x), model.mass
    )
    return np.linalg.eigvals((A / mass[:, None])[4:, 4:])


@pytest.mark.effect("tyre_saturation")
@pytest.mark.parametrize("slip", [0.001, 0.02, 0.1, 1.0])
def test_saturated_force_is_the_magic_formula_and_ends_at_mu_N(slip):
    force = slipping(slip, {"effect.tyre_saturation.inv_mu": 1 / 0.7})["force.F_srl"]
    D, C = 0.7 * N_R, 1.3
    assert force == pytest.approx(D * np.sin(C * np.arctan(C_LAMBDA / (C * D) * slip)), rel=1e-9)  # (1) with E = 0
    assert force < 0.7 * N_R


@pytest.mark.effect("tyre_saturation")
def test_a_chair_without_saturation_is_linear_exactly():
    now = slipping(0.1, {"effect.tyre_saturation.inv_mu": 0.0})
    assert now["force.F_srl"] == C_LAMBDA * now["slip.rl"]


@pytest.mark.effect("load_sensitivity")
@pytest.mark.parametrize("exponent", [0.0, 0.6, 1.0])
def test_forces_grow_with_the_load_as_the_exponent_says(exponent):
    """At the rig's load the rig's stiffness; on twice the load 2^exponent as much."""
    mass = 400 / N_R * MASS
    one, two = (slipping(0.01, {"effect.load_sensitivity.exponent": exponent, "chair.m": m}) for m in (mass, 2 * mass))
    assert one["force.F_srr"] == pytest.approx(C_LAMBDA * 0.01, rel=1e-9)
    assert two["force.F_srr"] / one["force.F_srr"] == pytest.approx(2**exponent, rel=1e-12)


@pytest.mark.effect("load_sensitivity")
def test_stiffness_in_proportion_to_load_makes_the_mass_drop_out():
    """Similarity: when all forces grow like the mass, twice the chair under twice the pushes moves alike."""
    motion = {
        "start.u": 1.2,
        "start.v": 0.05,
        "start.psi_dot": 0.4,
        "effect.load_sensitivity.exponent": 1.0,
        "effect.load_sensitivity.exponent_M": 1.0,
    }
    one, two = (
        snapshot({**motion, "chair.m": k * MASS, "chair.I_z": k * I_Z}, {"push.F_rl": k * 9.0, "push.F_rr": k * 4.0})
        for k in (1, 2)
    )
    for rate in ("u'", "v'", "psi_dot'"):
        assert two[rate] == pytest.approx(one[rate], rel=1e-12)


@pytest.mark.effect("inflation_pressure")
def test_a_pressure_not_stated_is_as_good_as_one_stated():
    for slip in (0.01, -0.05):
        told = slipping(slip, {"tyre.pressure": 2.0, "effect.inflation_pressure.dp": 0.0})
        found = slipping(slip, {"tyre.pressure": 4.0, "effect.inflation_pressure.dp": -2.0})
        np.testing.assert_allclose(found["F_s"], told["F_s"], rtol=1e-12)
        np.testing.assert_allclose(found["M_t"], told["M_t"], rtol=1e-12)


@pytest.mark.effect("inflation_pressure")
@pytest.mark.parametrize("law", ["dugoff", "magic_formula"])
def test_a_soft_tyre_turns_back_harder_under_every_law(law):
    """As in Fig. 6.2, and at small slip as much as under the linear law, whether the pressure is stated or found."""
    slip = 0.002
    linear = slipping(slip, {"tyre.pressure": 2.0})["M_t"] / slipping(slip, {})["M_t"]
    for soft in ({"tyre.pressure": 2.0}, {"effect.inflation_pressure.dp": -2.0}):
        ratio = slipping(slip, {"tyre.law": law, **soft})["M_t"] / slipping(slip, {"tyre.law": law})["M_t"]
        assert linear.min() > 1.5
        np.testing.assert_allclose(ratio, linear, rtol=1e-3)


@pytest.mark.effect("inflation_pressure")
def test_a_soft_tyre_rolls_harder_as_was_measured():
    """Of the rear axle's 5.2 N, 1 to 2.6 N more at half the pressure, and in proportion at a quarter; casters are solid."""

    def drag(**values):
        return -MASS * snapshot({"start.u": 1.0, **{k.replace("__", "."): v for k, v in values.items()}})["u'"]

    rated, half, quarter = (drag(tyre__pressure=p) for p in (4.0, 2.0, 1.0))
    assert rated == pytest.approx(MASS * G * (0.012 * A + 0.020 * B) / (A + B), rel=1e-6)
    assert 1.0 < half - rated < 2.6
    rear = 0.012 * 2 * N_R
    assert (quarter - rated + rear) / (half - rated + rear) == pytest.approx((half - rated + rear) / rear, rel=1e-6)
    assert drag(effect__inflation_pressure__dp=-2.0) == pytest.approx(half, rel=1e-12)


@pytest.mark.effect("load_sensitivity")
@pytest.mark.parametrize("law", ["linear", "dugoff"])
def test_the_torque_follows_its_own_exponent_of_the_load(law):
    """On twice the load 2^exponent_M as much torque, whatever the force does; slips so small that no law bends."""
    exponents = {"effect.load_sensitivity.exponent": 0.7, "effect.load_sensitivity.exponent_M": 0.2, "tyre.law": law}
    one, two = (slipping(1e-4, {**exponents, "chair.m": m}) for m in (MASS, 2 * MASS))
    np.testing.assert_allclose(two["M_t"] / one["M_t"], 2**0.2, rtol=1e-9)
    np.testing.assert_allclose(two["F_s"] / one["F_s"], 2**0.7, rtol=1e-9)


@pytest.mark.effect("inflation_pressure")
def test_half_the_pressure_makes_of_force_and_torque_what_the_rig_measured():
    """Figs. 6.1, 6.2: slopes at zero slip of tyre A at 400 N, by odd cubics through readings up to 3°."""
    table = np.genfromtxt(RIG, delimiter=",", skip_header=1, dtype=None, encoding="utf-8")
    slopes = []
    for pressure in (2, 4):
        rows = [r for r in table.tolist() if r[:4] == ("A", "side slip", pressure, 400) and r[4] == 4 and abs(r[5]) <= 3]
        slip, force, torque = np.array([(r[5], r[7], r[8]) for r in rows]).T
        odd = np.column_stack([slip, slip**3])
        slopes.append([np.linalg.lstsq(odd, y, rcond=None)[0][0] for y in (force, torque)])
    soft, stated = (slipping(0.001, {"tyre.pressure": 4.0, "effect.inflation_pressure.dp": dp}) for dp in (-2.0, 0.0))
    assert soft["F_s"][0] / stated["F_s"][0] == pytest.approx(slopes[0][0] / slopes[1][0], rel=0.05)
    assert soft["M_t"][0] / stated["M_t"][0] == pytest.approx(slopes[0][1] / slopes[1][1], rel=0.05)


@pytest.mark.effect("relaxation_length")
def test_relaxation_length_adds_the_string_models_eigenvalue():
    """Straight ahead: m v' = −m u r + 2Cα, I r' = −2(b C + C_m) α, σ α' = −u α − (v − b r)."""
    u, sigma = 1.2, 0.1
    expected = np.linalg.eigvals(
        [[0, -u, 2 * C_LAMBDA / MASS], [0, 0, -2 * (B * C_LAMBDA + C_M_LAMBDA) / I_Z], [-1 / sigma, B / sigma, -u / sigma]]
    )
    found = lateral_modes(sigma, u)
    for value in (*expected, -u / sigma):  # left and right tyre alike: against each other they only forget, −u/σ
        assert np.abs(found - value).min() < 1e-8 * abs(value)


def energies(result, sigma: float) -> tuple[np.ndarray, np.ndarray]:
    """The chair's kinetic energy, and the work that the deflections ∫ C atan(y/σ) dy of both tyres have taken."""
    u, v, r = (result[f"chair.{name}"] for name in ("u", "v", "psi_dot"))
    ways = [sigma * result[f"effect.relaxation_length.lagged_slip.{side}"] for side in ("rl", "rr")]
    wound = [C_LAMBDA * (y * np.arctan(y / sigma) - sigma / 2 * np.log1p((y / sigma) ** 2)) for y in ways]
    return 0.5 * MASS * (u**2 + v**2) + 0.5 * I_Z * r**2, np.sum(wound, axis=0)


SLIDES = [(0.0, 0.0, 0.5), (0.0, 0.002, 0.0), (0.0, 1.0, 0.0), (1.0, 1.0, 0.0), (0.1, -1.0, 2.0), (-1.0, 0.3, 1.0)]


@pytest.mark.effect("relaxation_length")
@pytest.mark.parametrize(("u", "v", "r"), SLIDES)
@pytest.mark.parametrize("sigma", [0.05, 0.3])
def test_a_deflected_tyre_gives_back_no_more_than_it_was_given(u, v, r, sigma):
    """From rest, spinning, sliding sideways, backward: energy never rises, and hardly any is in the tyres to begin with."""
    start = {"start.u": u, "start.v": v, "start.psi_dot": r}
    result = run({**SMOOTH, "tyre.C_m_lambda": 0.0, **start, "effect.relaxation_length.sigma": sigma}, T=2.0, n=2001)
    chair, tyres = energies(result, sigma)
    assert tyres[0] < 0.03 * chair[0]
    assert chair.max() < 1.02 * chair[0]
    assert np.diff(chair + tyres).max() < 1e-8 * chair[0] + 1e-9  # J; steps are good to a relative 1e-9 of 1 m/s


@pytest.mark.effect("relaxation_length")
def test_a_start_that_is_known_to_a_millimetre_a_second_is_no_blow():
    """At rest but for v = 2 mm/s or ψ' = 0.01 rad/s: tyres that have not rolled hold nothing yet."""
    for start in ({"start.v": 0.002}, {"start.psi_dot": 0.01}):
        now = snapshot({**SMOOTH, "start.u": 0.0, **start, "effect.relaxation_length.sigma": 0.1})
        assert np.abs(now["F_s"]).max() < 1.0
        assert abs(now["sensor.a_y"]) < 0.02


@pytest.mark.effect("relaxation_length")
@pytest.mark.parametrize("u", [1.0, -1.0])
@pytest.mark.parametrize("mode", ["free", "prescribed"])
def test_a_chair_that_starts_in_a_turn_starts_with_the_slips_of_its_wheels(u, mode):
    """Each hub's own, at the speed that holds, as if it had rolled for long: nothing is left to catch up with."""
    v, r = 0.115, 0.6  # all but b ψ', as in a turn: m u ψ' of side force
    held = {"speed.mode": mode, "start.u": u if mode == "free" else 0.0, "speed.u": u, "start.v": v, "start.psi_dot": r}
    now = snapshot({**SMOOTH, **held, "effect.relaxation_length.sigma": 0.1})
    hubs = np.abs([u + r * 0.55 / 2, u - r * 0.55 / 2])
    np.testing.assert_allclose(now["lam_F"], np.arctan(-(v - B * r) / hubs), rtol=1e-3)
    np.testing.assert_allclose(now["lam_F"], now["lam"], rtol=1e-3)


@pytest.mark.effect("relaxation_length")
def test_without_length_a_tyre_follows_at_once_in_any_slide():
    for u, v in ((1.0, 0.01), (0.3, -0.9), (-0.5, 2.0)):
        now = snapshot({"start.u": u, "start.v": v, "effect.relaxation_length.sigma": 0.0})
        np.testing.assert_allclose(now["lam_F"], now["lam"], rtol=1e-12)


@pytest.mark.effect("relaxation_length")
@pytest.mark.parametrize("speed", [0.5, 2.0])
def test_the_yaw_mode_turns_unstable_where_routh_says(speed):
    """Without self-aligning torque beyond σ = b + I_z/(m b), at any speed and stiffness."""
    limit = B + I_Z / (MASS * B)
    below, above = (lateral_modes(k * limit, speed, **{"tyre.C_m_lambda": 0.0}).real.max() for k in (1 - 1e-6, 1 + 1e-6))
    assert below < 0 < above


@pytest.mark.effect("pneumatic_trail_decay")
def test_the_trail_halves_at_the_slip_named_and_the_torque_levels_off():
    sharp = {"effect.pneumatic_trail_decay.inv_slip": 20.0, "effect.pneumatic_trail_decay.rounding": 1e-8}

    def trail(slip):
        now = slipping(slip, sharp)
        return -now["M_t"][0] / now["F_s"][0]

    assert trail(1e-7) == pytest.approx(C_M_LAMBDA / C_LAMBDA, rel=1e-5)
    assert trail(0.05) == trail(-0.05) == pytest.approx(C_M_LAMBDA / C_LAMBDA / 2, rel=1e-6)
    torques = np.array([-slipping(slip, sharp)["M_t"][0] for slip in (0.1, 0.4, 1.5)])
    assert np.all(np.diff(torques) > 0)
    assert torques[-1] == pytest.approx(C_M_LAMBDA / 20, rel=1 / (20 * 1.5))  # all but what is left of 1/(1 + 30)


def leaning(right: float, left: float) -> dict:
    return {
        **SMOOTH,
        "effect.camber_misalignment.sum": right + left,
        "effect.camber_misalignment.difference": right - left,
        "speed.mode": "prescribed",
        "speed.u": 1.0,
    }


@pytest.mark.effect("camber_misalignment")
def test_camber_thrust_starts_a_straight_chair_sideways():
    now = snapshot(leaning(0.02, 0.01))
    assert now["force.F_srr"] == pytest.approx(C_PHI * 0.02, rel=1e-8)
    assert now["sensor.a_y"] == pytest.approx(C_PHI * 0.03 / MASS, rel=1e-8)


@pytest.mark.effect("camber_misalignment")
def test_cambered_wheels_roll_the_circle_that_balances_them():
    """2 (C λ + C_φ φ) = m u² / R,  b (C λ + C_φ φ) = −C_m λ + C_mφ φ."""
    phi, u = 1e-3, 1.0
    slip = -phi * (B * C_PHI - C_M_PHI) / (B * C_LAMBDA + C_M_LAMBDA)
    result = run(leaning(phi, phi), T=20)
    assert (result["slip.rl"][-1] + result["slip.rr"][-1]) / 2 == pytest.approx(slip, rel=1e-5)
    assert result["chair.curvature"][-1] == pytest.approx(2 * (C_LAMBDA * slip + C_PHI * phi) / (MASS * u**2), rel=1e-5)


@pytest.mark.effect("camber_misalignment")
def test_wheels_that_lean_against_each_other_run_straight():
    """Section 6.3: "equal camber rotations with opposite signs of the two wheels do not generate a net camber force"."""
    result = run(leaning(0.03, -0.03))
    for name in ("chair.y", "chair.psi"):
        np.testing.assert_allclose(result[name], 0, atol=1e-12)


def toe(right: float, left: float) -> dict:
    return {"effect.toe_misalignment.sum": right + left, "effect.toe_misalignment.difference": right - left}


@pytest.mark.effect("toe_misalignment")
@pytest.mark.parametrize("u", [1.0, -1.0])
def test_parallel_wheels_that_point_aside_roll_where_they_point(u):
    """A crab: no slip, no force, no drag when v = u tan τ, forward as backward."""
    tau = 0.05
    now = snapshot({**SMOOTH, **toe(tau, tau), "start.u": u, "start.v": u * np.tan(tau)})
    np.testing.assert_allclose([*now["lam"], now["u'"], now["v'"], now["psi_dot'"]], 0, atol=1e-7)
    freed = snapshot({**SMOOTH, **toe(tau, tau), "start.u": u})  # straight ahead it is pushed that way
    assert freed["v'"] * u > 0


@pytest.mark.effect("toe_misalignment")
@pytest.mark.parametrize("tau", [0.015, 0.2])
def test_wheels_that_point_aside_push_where_they_point(tau):
    """At rest, of two wheels alike: m v' = 2 F sin τ, m u' = 2 F cos τ, and the axle is b behind the CM."""
    F = 7.2
    now = snapshot({**SMOOTH, **toe(tau, tau), "start.u": 0.0}, {"push.F_rl": F, "push.F_rr": F})
    assert now["v'"] == pytest.approx(2 * F * np.sin(tau) / MASS, rel=1e-12)
    assert now["u'"] == pytest.approx(2 * F * np.cos(tau) / MASS, rel=1e-12)
    assert now["psi_dot'"] == pytest.approx(-B * 2 * F * np.sin(tau) / I_Z, rel=1e-12)


@pytest.mark.effect("toe_misalignment")
@pytest.mark.parametrize(("u", "v", "r"), [(1.0, 0.1, 0.3), (0.05, -0.4, 1.0), (0.0, 0.3, -2.0), (-0.7, 0.1, 0.9)])
def test_wheels_that_point_aside_never_drive_the_chair(u, v, r):
    """However far, their forces stand in their own planes, in which they roll and slip."""
    now = snapshot({**toe(0.2, -0.15), "tyre.C_m_lambda": 0.0, "start.u": u, "start.v": v, "start.psi_dot": r})
    assert MASS * (u * now["u'"] + v * now["v'"]) + I_Z * r * now["psi_dot'"] < 0


@pytest.mark.effect("toe_misalignment")
def test_toe_drags_like_its_square_and_as_much_as_was_measured():
    """VanderWiel2016, 2021: 1° adds a quarter to the rolling resistance, the community's mean of 0.92° about 3 N."""

    def drag(degrees):
        return -MASS * snapshot(toe(-np.radians(degrees), np.radians(degrees)))["u'"]

    rolling = drag(0)
    assert drag(1) / rolling == pytest.approx(1.25, abs=0.02)
    assert drag(0.92) - rolling == pytest.approx(3.0, rel=0.2)
    assert (drag(2) - rolling) / (drag(1) - rolling) == pytest.approx(4, rel=1e-3)
    assert drag(-1) == pytest.approx(drag(1), rel=1e-12)  # toe-out as toe-in


@pytest.mark.effect("longitudinal_slip")
@pytest.mark.parametrize("u", [0.0, -3.0])
def test_wheels_turn_further_than_they_roll_by_compliance_times_work(u):
    """∫ F |v| compliance dt: pushing from rest, and braking a chair that rolls back with the same pushes."""
    compliance, F = 1e-3, 20.0
    result = run({**SMOOTH, "start.u": u, "effect.longitudinal_slip.compliance": compliance}, {"push.F_rl": F, "push.F_rr": F})
    work = F * abs(result["chair.x"][-1])  # of one wheel's push, whichever its sign
    turned = trapezoid(result["sensor.wheel_speed_l"], result.time)
    assert turned - result["chair.x"][-1] == pytest.approx(compliance * work, rel=1e-6)


@pytest.mark.effect("longitudinal_slip")
@pytest.mark.parametrize("u", [2.0, -2.0])
def test_a_braked_wheel_turns_less_far_than_it_rolls(u):
    """By compliance times the brake's force all the way: 0.1 of 100 N, both ways."""
    compliance, brake = 1e-3, 0.1
    result = run(
        {**SMOOTH, "start.u": u, "brake.F_max": 100.0, "effect.longitudinal_slip.compliance": compliance},
        {"brake.rl": brake, "brake.rr": brake},
    )
    turned = trapezoid(result["sensor.wheel_speed_l"], result.time)
    assert turned / result["chair.x"][-1] == pytest.approx(1 - compliance * brake * 100.0, rel=1e-4)
