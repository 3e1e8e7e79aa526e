"""A, B, C, D against derivations that share nothing with them: closed forms, the paper's equations, the FMU itself."""

from __future__ import annotations

from copy import copy

import fmpy
import numpy as np
import pytest
from fmpy.fmi2 import FMU2Slave
from scipy.linalg import expm

from tests.model.test_paper import right_hand_sides
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.fmu.build import with_chosen_effects
from wheelchair_fmu.handling.linearize import linearize, radius_sensitivities, radius_slopes
from wheelchair_fmu.handling.trim import Chair, trim
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import Choice
from wheelchair_fmu.studies import fmu_of

M, I_Z, A, B, T_R, C_L, C_M, F_F, G = 80.0, 3.08, 0.25, 0.20, 0.55, 5038.0, 45.0, 0.020, 9.81


@pytest.mark.parametrize("u", [0.4, 1.0, 3.0])
def test_straight_on_it_is_the_closed_form(u):
    """Both tyres' slip is −(v − b ψ')/u, both casters' drag D_f leans by (v + a ψ')/u."""
    k, s, D = 2 * C_L, 2 * C_M, F_F * B * G * M / (A + B)
    expected = [
        [-(k + D) / (M * u), (k * B - D * A) / (M * u) - u],
        [(k * B - D * A + s) / (I_Z * u), -(k * B**2 + D * A**2 + s * B) / (I_Z * u)],
    ]
    found = linearize(trim(Chair(Variant(Choice(equations="paper"))), u, 0.0))
    assert found.states == ("v", "psi_dot")
    np.testing.assert_allclose(found.A, expected, rtol=1e-12)
    push = [found.inputs.index(n) for n in ("push.F_rl", "push.F_rr")]
    np.testing.assert_allclose(found.B[:, push], [[0, 0], [T_R / 2 / I_Z, -T_R / 2 / I_Z]], rtol=1e-14)
    curvature = found.C[found.outputs.index("chair.curvature")]
    np.testing.assert_allclose(curvature, [0, 1 / np.hypot(u, 0.01)], rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("free", [False, True])
@pytest.mark.parametrize(("u", "delta_force"), [(1.0, 10.0), (0.5, -4.0), (2.0, 60.0)])
def test_in_a_turn_it_is_the_papers_equations_by_differences(u, delta_force, free):
    found = linearize(trim(Chair(Variant(Choice(equations="paper"))), u, delta_force), free_speed=free)
    s = found.trim
    first = 0 if free else 1
    at = np.array([u, s.v, s.psi_dot, s.w[0], s.w[1]])

    def rates(place):
        return np.array(right_hand_sides(*place, 0.0, 0.0)[0])[first:]

    columns = []
    for j in range(5):  # Richardson's extrapolation of central differences
        h = 1e-3 * np.eye(5)[j] * (1 if j < 3 else 100)
        coarse, fine = ((rates(at + g * h) - rates(at - g * h)) / (2 * g * h[j]) for g in (1, 0.5))
        columns.append((4 * fine - coarse) / 3)
    by = np.array(columns).T
    np.testing.assert_allclose(found.A, by[:, first:3], rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(found.B[:, :2], by[:, 3:], rtol=1e-8, atol=1e-10)
    assert found.states == ("u", "v", "psi_dot")[first:]


@pytest.mark.parametrize("free", [False, True])
def test_the_fmus_directional_derivatives_are_the_same(free, tmp_path):
    """C and D of every output. An accelerometer feels u' − v ψ' and v' + u ψ', and 1 m before the CM ψ'' more: A and B. The
    body's momentum p moves the CM at p/m in the frame, which so feels −p'/m ahead and, as that turns, −2 ψ' p/m aside."""
    variant = with_chosen_effects(Variant()).with_values({"effect.lateral_load_transfer.h": 0.5, "tyre.law": "magic_formula"})
    s = trim(Chair(variant), 1.2, 25.0)
    found = linearize(s, free_speed=free)
    C, D = directional(tmp_path, s, found)
    np.testing.assert_allclose(C, found.C, rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(D, found.D, rtol=1e-8, atol=1e-8)
    a_x, a_y = (found.outputs.index(f"sensor.a_{axis}") for axis in "xy")
    before, D_before = directional(tmp_path, s, found, {"effect.accelerometer_offset.x": 1.0})
    first = 0 if free else 1
    turning = np.array([[0, s.psi_dot, s.v], [-s.psi_dot, 0, -s.speed], [0, 0, 0]])[:, first:]
    A = np.array([C[a_x], C[a_y], before[a_y] - C[a_y]]) + turning
    np.testing.assert_allclose(A[first:], found.A, rtol=1e-8, atol=1e-8)
    gravity = G * (np.array(found.inputs) == [["floor.slope_x"], ["floor.slope_y"], [""]])  # which no accelerometer feels
    mass = s.chair.variant.vector()[[p.name for p in s.chair.variant.parameters()].index("chair.m")]
    body = np.array([[n == "rider.force", 2 * s.psi_dot * (n == "rider.momentum"), 0.0] for n in found.inputs]).T / mass
    B = np.array([D[a_x], D[a_y], D_before[a_y] - D[a_y]]) + gravity + body
    np.testing.assert_allclose(B[first:], found.B, rtol=1e-8, atol=1e-8)


def directional(folder, s, linear, more=None):
    """C and D as the FMU gives them in initialisation mode, where the start values are known variables."""
    path = str(fmu_of(s.chair.variant))
    description = fmpy.read_model_description(path)
    refer = {v.name: v.valueReference for v in description.modelVariables}
    fmu = FMU2Slave(
        guid=description.guid,
        unzipDirectory=fmpy.extract(path, str(folder)),
        instanceName="x",
        modelIdentifier=description.coSimulation.modelIdentifier,
    )
    fmu.instantiate()
    fmu.setupExperiment()
    values = {
        **s.chair.variant.values,
        "speed.u": s.speed,
        "start.u": s.speed,
        "start.v": s.v,
        "start.psi_dot": s.psi_dot,
        **dict(zip(linear.inputs, s.w.tolist(), strict=True)),
        **(more or {}),
    }
    values.pop("speed.mode")
    fmu.setInteger([refer["speed.mode"], refer["tyre.law"]], [1 if "u" in linear.states else 2, 3])
    fmu.setReal([refer[n] for n in values], list(values.values()))
    fmu.enterInitializationMode()
    unknown = [refer[n] for n in linear.outputs]
    known = (*(f"start.{n}" for n in linear.states), *linear.inputs)
    columns = [fmu.getDirectionalDerivative(unknown, [refer[n]], [1.0]) for n in known]
    fmu.exitInitializationMode()
    fmu.freeInstance()
    n = len(linear.states)
    return np.array(columns[:n]).T, np.array(columns[n:]).T


def test_small_motions_of_the_simulated_chair_follow_it():
    """With massless rows eliminated and states of effects: e^{At} against runs on either side of the trim."""
    values = {"effect.relaxation_length.sigma": 0.05, "effect.caster_trail.c": 0.05, "effect.lateral_load_transfer.h": 0.6}
    chair = Chair(Variant().with_values(values))
    s = trim(chair, 1.0, 20.0)
    found = linearize(s, free_speed=True)
    assert found.states[:3] == ("u", "v", "psi_dot") and len(found.states) == 7
    simulator = Simulator(chair.variant)
    t = np.linspace(0, 0.4, 41)
    inputs = np.tile(s.w, (len(t), 1))
    for j in range(7):
        step = 1e-4 * np.eye(7)[j]
        ends = []
        for sign in (1, -1):
            x = s.x.copy()
            x[3:10] += sign * step
            ends.append(simulator.run(t, inputs, tolerance=1e-12, start=x).states[-1, 3:10])
        np.testing.assert_allclose((ends[0] - ends[1]) / 2e-4, expm(0.4 * found.A)[:, j], atol=2e-5)


def test_an_algebraic_row_is_the_limit_of_a_quick_one():
    def eigenvalues(sigma):
        chair = Chair(Variant().with_effects(["relaxation_length"]).with_values({"effect.relaxation_length.sigma": sigma}))
        return linearize(trim(chair, 1.0, 10.0)).eigenvalues

    none, short = eigenvalues(0.0), eigenvalues(1e-6)
    assert len(none) == 2 and len(short) == 4
    np.testing.assert_allclose(short[:2], none, rtol=1e-3)


def test_the_radius_moves_as_trims_on_either_side_say():
    variant = with_chosen_effects(Variant())
    s = trim(Chair(variant), 1.0, 10.0)
    slopes = radius_slopes(s)
    for p in s.chair.model.parameters:
        if p.choices or p.name.startswith(("start.", "effect.floor_slope.")):
            assert p.name not in slopes
            continue
        if p.name == "speed.u":
            ends = [trim(s.chair, 1.0 + h, 10.0).radius for h in (1e-4, -1e-4)]
            assert slopes[p.name] == pytest.approx(np.log(ends[0] / ends[1]) / 2e-4, rel=1e-6)
            continue
        h = 1e-5 * p.nominal
        middle = max(s.chair.value(p.name), p.lower + h)
        ends = [trim(with_value(s.chair, p.name, middle + sign * h), 1.0, 10.0).radius for sign in (1, -1)]
        by_differences = np.log(ends[0] / ends[1]) / (2 * h)
        assert slopes[p.name] == pytest.approx(by_differences, rel=1e-3, abs=1e-7 / p.nominal), p.name
    relative = radius_sensitivities(s, slopes)
    assert relative["chair.m"] == pytest.approx(80 * slopes["chair.m"]) and relative["effect.scrub_torque.M"] == 0


def with_value(chair, name, value):
    """The same equations at another value; assembling them anew for each would take long."""
    other = copy(chair)
    other.p = chair.p.copy()
    other.p[chair.parameters.index(name)] = value
    return other


def test_sensitivities_are_without_dimension():
    """Force, mass, length and time scale out of d ln R / d ln p: with R₂ = R under doubled forces, torques and masses."""
    s = trim(Chair(Variant()), 1.0, 10.0)
    relative = radius_sensitivities(s, radius_slopes(s))
    force = trim(s.chair, 1.0, 10.0 * 1.0001)
    by_force = np.log(force.radius / s.radius) / np.log(1.0001)
    assert by_force + sum(relative[n] for n in ("chair.m", "tyre.C_lambda", "tyre.C_m_lambda")) == pytest.approx(0, abs=1e-3)


def test_straight_on_there_is_no_radius_to_move():
    assert radius_slopes(trim(Chair(Variant()), 1.0, 0.0)) == {}


def test_at_every_speed_the_chair_is_damped_and_has_all_sensitivities():
    chair, near = Chair(with_chosen_effects(Variant())), None
    for speed in np.linspace(0.1, 4, 200):
        near = trim(chair, speed, 10.0, near=near)
        assert linearize(near).eigenvalues.real.max() < 0 and len(radius_slopes(near)) > 40


def test_python_control_takes_it():
    control = pytest.importorskip("control")
    found = linearize(trim(Chair(Variant()), 1.0, 10.0))
    system = found.state_space()
    assert isinstance(system, control.StateSpace) and system.state_labels == ["v", "psi_dot"]
    assert system.input_labels[0] == "push_F_rl"
    assert np.sort(system.poles().real) == pytest.approx(np.sort(found.eigenvalues.real))
