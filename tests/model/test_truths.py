"""Signs, sides and starts of the model against truths that its equations do not contain: each has once been wrong unnoticed."""

from __future__ import annotations

import math

import casadi as cs
import numpy as np
import pytest

from tests.model.effects.chair import C_LAMBDA, C_M_LAMBDA, MASS, SMOOTH, T_F, T_R, A, B, G, run, snapshot
from wheelchair_fmu.contracts.places import Place, evaluate
from wheelchair_fmu.engine.kernel import kernel
from wheelchair_fmu.model.generic import terms
from wheelchair_fmu.model.smooth import sine_over
from wheelchair_fmu.model.variant import Variant

R, R_RIM = 0.31, 0.275
LEVER = 0.05  # of a caster, from its pivot back to its contact patch
N_R = MASS * G * A / (A + B) / 2


def pacejka(slip: float, stiffness: float, C: float, D: float, E: float) -> float:
    """The Magic Formula as it was published, D sin(C atan(Bx − E (Bx − atan Bx))), with B = stiffness / (C D)."""
    Bx = stiffness / (C * D) * slip
    return D * math.sin(C * math.atan(Bx - E * (Bx - math.atan(Bx))))


@pytest.mark.parametrize("slip", [-0.4, -0.03, 2e-5, 0.002, 0.1, 0.8])
@pytest.mark.parametrize(("C", "E"), [(1.3, -2.0), (1.7, 0.6), (1.3, 0.0)])
def test_force_and_torque_are_the_published_magic_formula(slip, C, E):
    """Also where the curvature E is not zero, and at slips so small that a series stands in."""
    law = {"tyre.law": "magic_formula", "tyre.mu": 0.8, "tyre.force.C": C, "tyre.force.E": E}
    torque = {"tyre.torque.C": C + 0.5, "tyre.torque.D": 1.7, "tyre.torque.E": E}
    now = snapshot({**SMOOTH, **law, **torque, "start.u": 3 * math.cos(slip), "start.v": -3 * math.sin(slip)})
    np.testing.assert_allclose(now["F_s"], pacejka(slip, C_LAMBDA, C, 0.8 * N_R, E), rtol=1e-8)
    np.testing.assert_allclose(now["M_t"], -pacejka(slip, C_M_LAMBDA, C + 0.5, 1.7, E), rtol=1e-8)


@pytest.mark.parametrize("E", [-3.0, 0.0, 0.9])
def test_where_the_series_stands_in_it_bends_as_the_formula_does(E):
    """What the bend takes is of order 1e-7 there, so it is compared by itself, on both sides of where the series begins."""
    C, z = 1.4, cs.SX.sym("z")
    bend = cs.Function("bend", [z], [sine_over(z, C, E)])
    for at in (3e-4, 9.9e-4, 1.01e-3, 3e-3):
        expected = 1 - math.sin(C * math.atan(at - E * (at - math.atan(at)))) / (C * at)
        assert 1 - float(bend(at)) == pytest.approx(expected, rel=1e-4)
        assert float(bend(-at)) == float(bend(at))


def test_hands_at_the_rims_push_with_the_torque_that_the_axles_need():
    """Their force is larger than the tyre's by R/R_rim: as axle torques of rim radius, it does keep the speed."""
    turn = {"push.F_rl": 6.0, "push.F_rr": -6.0}
    held = run({"speed.mode": "prescribed", "speed.u": 1.0}, turn)
    rim = held["push.rim_needed"]
    np.testing.assert_allclose(rim * R_RIM, held["push.total_needed"] * R, rtol=1e-12)
    assert rim.min() > held["push.total_needed"].max() > 0
    torque = rim / 2 * R_RIM
    free = run({}, {**turn, "push.M_rl": lambda t: torque, "push.M_rr": lambda t: torque})
    np.testing.assert_allclose(free["chair.u"], 1.0, atol=2e-5)


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("u", [1.5, -1.5])
def test_a_chair_turns_round_the_wheel_that_is_braked(side, u):
    """A force F_max against the motion at that hub alone: I_z ψ'' = ∓ F_max t_r/2, rolling ahead to that wheel's side. It is
    far below what friction holds, where the tyre passes it on whole."""
    now, free = (
        snapshot({**SMOOTH, "brake.F_max": 10.0, "start.u": u}, {"brake.rl" if side == "left" else "brake.rr": on})
        for on in (1.0, 0.0)
    )
    force = -math.copysign(10.0, u)
    assert now["sensor.a_x"] - free["sensor.a_x"] == pytest.approx(force / MASS, rel=1e-9)
    lever = 0.55 / 2 if side == "left" else -0.55 / 2  # a force ahead on the left wheel turns to the right
    assert now["psi_dot'"] - free["psi_dot'"] == pytest.approx(lever * force / 3.08, rel=1e-9)


@pytest.mark.parametrize("side", ["l", "r"])
def test_the_wheel_that_is_braked_is_the_one_that_creeps(side):
    values = {**SMOOTH, "brake.F_max": 100.0, "start.u": 2.0, "effect.longitudinal_slip.compliance": 1e-3}
    now = snapshot(values, {f"brake.r{side}": 0.2})
    other = "r" if side == "l" else "l"
    assert now[f"sensor.wheel_speed_{side}"] == pytest.approx(2.0 * (1 - 1e-3 * 20.0), rel=1e-6)
    assert now[f"sensor.wheel_speed_{other}"] == pytest.approx(2.0, rel=1e-9)


@pytest.mark.parametrize("u", [1.0, -1.0])
def test_a_torque_on_a_caster_is_felt_as_a_force_at_its_patch(u):
    """A massless caster under a bearing's torque M_w stands still only by a force M_w/c at its patch, c behind the pivot. All
    that the floor does to chair and casters together is that force, so its moment about the CM is the chair's."""
    torque, v, spin = 0.3, 0.3, 0.5
    effect = terms()["generic_M_w_one_sided"].effect()
    variant = Variant(catalogue={effect.id: effect}).with_effects([effect.id])
    motion = {**SMOOTH, "caster.trail": LEVER, "start.u": u, "start.v": v, "start.psi_dot": spin}
    moved = []
    for size in (torque, 0.0):
        chair = variant.with_values({**motion, f"effect.{effect.id}.q": size})
        model, p = chair.model(), chair.vector()
        w = np.array([i.start for i in model.inputs])
        x = kernel(model).functions["start"](p, w).full().ravel()
        moved.append(np.ravel(evaluate(model, Place(x, w, p), *(model.quantities[n] for n in SUMS))))
    expected = np.zeros(3)
    for pivot in (np.array([A, -T_F / 2]), np.array([A, T_F / 2])):
        velocity = np.array([u - pivot[1] * spin, v + pivot[0] * spin])
        heading = velocity / np.hypot(*velocity)  # an ideal caster trails its pivot
        force = torque / LEVER * np.array([-heading[1], heading[0]])
        patch = pivot - LEVER * heading
        expected += [*force, patch[0] * force[1] - patch[1] * force[0]]
    np.testing.assert_allclose(moved[0] - moved[1], expected, rtol=1e-6)


SUMS = ("F_x", "F_y", "M_z")


@pytest.mark.parametrize("spin", [0.7, -0.7])
@pytest.mark.parametrize("u", [1.2, -1.2])
def test_casters_start_where_their_pivots_go(u, spin):
    """Each along the velocity of its own pivot, a before the CM and half the tread beside it: as an ideal caster stands."""
    motion = {**SMOOTH, "start.u": u, "start.v": 0.05, "start.psi_dot": spin}
    started, ideal = snapshot({**motion, "effect.caster_trail.c": LEVER}), snapshot(motion)
    for caster, y in (("caster.fl", -T_F / 2), ("caster.fr", T_F / 2)):
        assert started[caster] == pytest.approx(math.atan2(0.05 + A * spin, u - y * spin), abs=1e-7)
        assert started[caster] == pytest.approx(ideal[caster], abs=1e-7)
    assert abs(started["caster.fl"] - started["caster.fr"]) > 0.01


@pytest.mark.parametrize("spin", [0.7, -0.7])
@pytest.mark.parametrize("u", [1.2, -1.2])
def test_tyres_that_lag_start_as_if_they_had_rolled_so_for_long(u, spin):
    """Each with the slip of its own hub, b behind the CM, which goes v − b ψ' to the right; as without any lag."""
    aside = 0.001
    motion = {**SMOOTH, "start.u": u, "start.v": B * spin + aside, "start.psi_dot": spin}
    started, prompt = snapshot({**motion, "effect.relaxation_length.sigma": 0.2}), snapshot(motion)
    slips = []
    for wheel, y in (("rl", -T_R / 2), ("rr", T_R / 2)):
        slips.append(-math.atan2(aside, abs(u - y * spin)))
        assert started[f"effect.relaxation_length.lagged_slip.{wheel}"] == pytest.approx(math.tan(slips[-1]), rel=1e-9)
    assert abs(slips[0] - slips[1]) > 1e-4
    np.testing.assert_allclose(started["F_s"], C_LAMBDA * np.array(slips), rtol=1e-9)
    np.testing.assert_allclose(started["F_s"], prompt["F_s"], rtol=1e-9)
