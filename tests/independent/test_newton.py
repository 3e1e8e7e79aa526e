"""The whole model against Newton's law in room axes: vectors at contact points, SciPy's integrator, nothing of its stages."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.model.variant import Variant

A, B, T_R, T_F, M, I_Z, G = 0.25, 0.20, 0.55, 0.45, 80.0, 3.08, 9.81  # Table 1
C, C_M, F_R, F_F, F_MAX, R = 5038.0, 45.0, 0.012, 0.020, 300.0, 0.31
N_R, N_F = M * G * A / (A + B) / 2, M * G * B / (A + B) / 2  # on a level floor
MU = 1.0  # of the tyres: what a brake uses of μN is lost to the side, on a circle


@dataclass(frozen=True)
class Case:
    """Pushes and brakes of the left and right wheel, slopes of the floor, and how the chair starts."""

    push: tuple[float, float] = (0.0, 0.0)
    torque: tuple[float, float] = (0.0, 0.0)
    brake: tuple[float, float] = (0.0, 0.0)
    slope: tuple[float, float] = (0.0, 0.0)
    psi: float = 0.0
    u: float = 1.5
    v: float = 0.0
    spin: float = 0.0
    seconds: float = 1.0  # within which no wheel comes to rest, where a force without smoothing would flicker

    @property
    def time(self) -> np.ndarray:
        return np.linspace(0, self.seconds, 101)


CASES = {
    "left brake": Case(brake=(0.08, 0.0)),
    "right brake": Case(brake=(0.0, 0.08)),
    "left push": Case(push=(25.0, 0.0)),
    "right torque": Case(torque=(0.0, 6.0)),
    "left brake in reverse": Case(brake=(0.04, 0.0), u=-1.5, seconds=0.2),
    "slopes across": Case(slope=(0.02, -0.03), psi=0.6),
    "spinning start": Case(v=0.1, spin=0.9, psi=-2.0),
    "all": Case((5.0, -8.0), (-2.0, 1.0), (0.02, 0.05), (0.01, 0.02), 1.1, 1.5, -0.1, -0.8),
}


def forces(case: Case, state: np.ndarray, headings: np.ndarray | None) -> tuple[np.ndarray, float]:
    """All that acts on the chair: force in the room's axes, moment about the CM, turning from x to y."""
    ahead, right = axes(state[2])
    total, moment = M * G * np.sin(np.array(case.slope)), 0.0
    upright = float(np.prod(np.cos(case.slope)))  # share of the weight that the floor carries
    for side in (0, 1):
        arm, velocity = point(state, -B, (side - 0.5) * T_R)
        rolls = np.sign(velocity @ ahead)
        slip = -np.arctan2(velocity @ right, abs(velocity @ ahead))
        held = F_MAX * case.brake[side]
        grip = np.cos(np.arcsin(held / (MU * N_R * upright)))
        along = case.push[side] + case.torque[side] / R - rolls * (F_R * N_R * upright + held)
        force = along * ahead + grip * C * slip * right
        total, moment = total + force, moment + cross(arm, force) - rolls * grip * C_M * slip
    for side in (0, 1):
        arm, velocity = point(state, A, (side - 0.5) * T_F)
        goes = velocity / np.hypot(*velocity)
        if headings is not None:
            goes = np.array([np.cos(headings[side]), np.sin(headings[side])])
            goes = goes * np.sign(velocity @ goes)
        force = -F_F * N_F * upright * goes
        total, moment = total + force, moment + cross(arm, force)
    return total, moment


def axes(psi: float) -> tuple[np.ndarray, np.ndarray]:
    return np.array([np.cos(psi), np.sin(psi)]), np.array([-np.sin(psi), np.cos(psi)])


def point(state: np.ndarray, forward: float, rightward: float) -> tuple[np.ndarray, np.ndarray]:
    """A point of the chair from the CM, and its velocity, both in the room's axes."""
    ahead, right = axes(state[2])
    arm = forward * ahead + rightward * right
    return arm, state[3:5] + state[5] * np.array([-arm[1], arm[0]])


def cross(arm: np.ndarray, force: np.ndarray) -> float:
    return float(arm[0] * force[1] - arm[1] * force[0])


def newton(case: Case, trail: float = 0.0) -> np.ndarray:
    """States (n, 6) x, y, ψ, x', y', ψ' at the case's times; with a trail also the casters' headings θ in the
    room, whose patches do not slip sideways: c θ' is the pivot's velocity across the caster."""

    def rates(_: float, state: np.ndarray) -> np.ndarray:
        total, moment = forces(case, state, state[6:] if trail else None)
        turning = []
        for side, heading in enumerate(state[6:]):
            _, velocity = point(state, A, (side - 0.5) * T_F)
            turning.append(velocity @ axes(heading)[1] / trail)
        return np.array([*state[3:6], *(total / M), moment / I_Z, *turning])

    ahead, right = axes(case.psi)
    start = np.array([0.0, 0.0, case.psi, *(case.u * ahead + case.v * right), case.spin])
    if trail:
        pivots = [point(start, A, (side - 0.5) * T_F)[1] for side in (0, 1)]
        start = np.append(start, [np.arctan2(velocity[1], velocity[0]) for velocity in pivots])
    found = solve_ivp(rates, (0, case.seconds), start, "LSODA", case.time, rtol=1e-9, atol=1e-10)
    return found.y.T


def model(case: Case, trail: float = 0.0):
    values = {
        "start.psi": case.psi,
        "start.u": case.u,
        "start.v": case.v,
        "start.psi_dot": case.spin,
        "regularisation.slip_speed": 1e-5,
        **({"effect.caster_trail.c": trail - 1e-3} if trail else {}),
    }
    simulator = Simulator(Variant().with_values(values))
    inputs = {
        **dict(zip(("push.F_rl", "push.F_rr"), case.push, strict=True)),
        **dict(zip(("push.M_rl", "push.M_rr"), case.torque, strict=True)),
        **dict(zip(("brake.rl", "brake.rr"), case.brake, strict=True)),
        **dict(zip(("floor.slope_x", "floor.slope_y"), case.slope, strict=True)),
    }
    return simulator.run(case.time, simulator.inputs(len(case.time), inputs), tolerance=1e-9)


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_the_chair_goes_where_newton_sends_it(case):
    true, found = newton(case), model(case)
    for i, name in enumerate(("chair.x", "chair.y", "chair.psi")):
        np.testing.assert_allclose(found[name], true[:, i], atol=2e-6)
    np.testing.assert_allclose(found["chair.psi_dot"], true[:, 5], atol=2e-5)


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_each_instrument_reads_its_own_side(case):
    """Hubs' velocities along the chair, and what acts on the chair but for gravity, over its mass."""
    true, found = newton(case), model(case)
    for k in (0, 40, 100):
        state = true[k]
        ahead, right = axes(state[2])
        for side, name in enumerate(("sensor.wheel_speed_l", "sensor.wheel_speed_r")):
            assert found[name][k] == pytest.approx(point(state, -B, (side - 0.5) * T_R)[1] @ ahead, abs=2e-5)
        felt = forces(case, state, None)[0] / M - G * np.sin(np.array(case.slope))
        assert found["sensor.a_x"][k] == pytest.approx(felt @ ahead, abs=1e-3)
        assert found["sensor.a_y"][k] == pytest.approx(felt @ right, abs=1e-3)


@pytest.mark.parametrize("name", ["spinning start", "left push", "all"])
def test_casters_with_a_trail_swing_as_their_patches_roll(name):
    case = CASES[name]
    true, found = newton(case, 0.06), model(case, 0.06)
    for side, caster in enumerate(("caster.fl", "caster.fr")):
        np.testing.assert_allclose(found[caster], true[:, 6 + side] - true[:, 2], atol=1e-5)
    np.testing.assert_allclose(found["chair.psi_dot"], true[:, 5], atol=2e-5)
