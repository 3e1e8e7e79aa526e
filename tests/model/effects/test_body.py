"""Where the mass is and how it moves, each against a truth its file does not contain."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson

from tests.model.effects.chair import I_Z, MASS, SMOOTH, T_F, T_R, TOP, A, B, G, run, snapshot
from wheelchair_fmu.model.variant import Variant

PUSH = {"push.F_rl": 20.0, "push.F_rr": 20.0}


def overturning(now: dict) -> float:
    """Moment of the loads about the chair's long axis, positive where the left wheels carry more."""
    (rl, rr), (fl, fr) = now["N_r"], now["N_f"]
    return (rl - rr) * T_R / 2 + (fl - fr) * T_F / 2


def pitching(now: dict) -> float:
    """Moment of the loads about the CM's transverse axis, positive where the rear wheels carry more."""
    return sum(now["N_r"]) * B - sum(now["N_f"]) * A


def carried(now: dict) -> float:
    """What all four wheels carry."""
    return sum(now["N_r"]) + sum(now["N_f"])


@pytest.mark.effect("lateral_load_transfer")
def test_lateral_load_transfer_balances_the_overturning_moment():
    h = 0.5
    now = snapshot(
        {"effect.lateral_load_transfer.h": h, "start.u": 1.5, "start.v": 0.18, "start.psi_dot": 1.0, "start.psi": 0.7},
        {"floor.slope_x": 0.05},
    )
    assert abs(now["sensor.a_y"]) > 0.1
    assert overturning(now) == pytest.approx(MASS * now["sensor.a_y"] * h, rel=1e-9)
    assert carried(now) == pytest.approx(MASS * G * np.cos(0.05), rel=1e-9)


@pytest.mark.effect("longitudinal_load_transfer")
def test_longitudinal_load_transfer_balances_the_pitching_moment():
    h = 0.6
    for start, slope in (({}, 0.0), ({"start.psi": np.pi, "start.u": 0.5}, 0.05)):
        now = snapshot({**start, "effect.longitudinal_load_transfer.h": h}, {**PUSH, "floor.slope_x": slope})
        assert abs(now["sensor.a_x"]) > 0.1
        assert pitching(now) == pytest.approx(MASS * now["sensor.a_x"] * h, rel=1e-9)
        assert carried(now) == pytest.approx(MASS * G * np.cos(slope), rel=1e-9)


@pytest.mark.effect("longitudinal_load_transfer")
@pytest.mark.parametrize(("b", "a_x"), [(B, 3.27), (0.08, 1.31)], ids=["the paper's chair", "an active chair"])
def test_the_casters_lift_at_the_push_that_tips_the_chair(b, a_x):
    """About the rear contact patches: m a_x h = m g b."""
    h = 0.6
    values = {**SMOOTH, "effect.longitudinal_load_transfer.h": h, "chair.b": b}
    for share in (1 - 1e-6, 1 + 1e-6):
        each = share * MASS * G * b / h / 2
        now = snapshot(values, {"push.F_rl": each, "push.F_rr": each})
        assert now["load.lifted"] == (share > 1)
        assert now["sensor.a_x"] == pytest.approx(a_x, abs=0.005)


@pytest.mark.effect("cm_lateral_offset")
def test_cm_lateral_offset_balances_loads_and_turns_a_straight_push():
    y = 0.01
    now = snapshot({**SMOOTH, "effect.cm_lateral_offset.y": y}, PUSH)
    assert overturning(now) == pytest.approx(-MASS * G * y, rel=1e-9)
    assert now["M_z"] == pytest.approx(2 * 20.0 * y)  # the pushes pass 10 mm to the left of the CM


@pytest.mark.effect("cm_lateral_offset")
def test_resistance_in_proportion_to_load_does_not_turn_a_coasting_chair():
    """On each axle it acts where the load does, and that is in line with the CM, wherever this lies."""
    coasting = {"effect.cm_lateral_offset.y": 0.03, "start.u": 1.0}
    now, uneven = snapshot(coasting), snapshot({**coasting, "effect.rolling_resistance_asymmetry.D": 0.1})
    assert now["D_r"][1] > 1.1 * now["D_r"][0]
    assert now["M_z"] == pytest.approx(0, abs=1e-12)
    assert abs(uneven["M_z"]) > 0.01


@pytest.mark.parametrize("rise", [0.0, 1 / 12, 0.5])
def test_a_slope_carries_the_cosine_of_the_weight(rise):
    """Along the chair's way, across it and in the diagonal; up to the steepest that is allowed, about 1 in 2."""
    angle = np.arctan(rise)
    for heading, slopes in ((0.0, ("floor.slope_x",)), (0.7, ("floor.slope_y",)), (2.0, ("floor.slope_x", "floor.slope_y"))):
        now = snapshot({"start.psi": heading}, dict.fromkeys(slopes, angle))
        assert carried(now) == pytest.approx(MASS * G * np.sqrt(1 - len(slopes) * np.sin(angle) ** 2), rel=1e-12)
        assert sum(now["N_r"]) * B == pytest.approx(sum(now["N_f"]) * A, rel=1e-12)
    across = snapshot({"effect.floor_cross_slope.theta": 0.1}, {"floor.slope_x": angle})
    assert carried(across) == pytest.approx(MASS * G * np.cos(angle) * np.cos(0.1), rel=1e-12)


def test_no_slope_that_is_allowed_takes_the_loads_away():
    """The inputs, and both effects besides, which make it as good as a wall: the floor still carries, and no number is lost."""
    steepest = {i.name: i.upper for i in Variant().model().inputs if i.name.startswith("floor.slope")}
    assert all(0.3 < slope < 0.6 for slope in steepest.values())
    values = {"effect.floor_slope.x": 0.3, "effect.floor_slope.y": 0.3, "effect.floor_cross_slope.theta": 0.3}
    for more, least in (({}, 100), (values, 10)):
        now = snapshot({**more, "start.psi": 0.8}, steepest)
        assert min(*now["N_r"], *now["N_f"]) > least


@pytest.mark.effect("wheel_inertia")
def test_wheel_inertia_is_mass_ahead_and_in_the_turn():
    """Two wheels of 0.14 kg m² on 0.31 m: ahead both add I/R² to the mass, on the spot at the arm t_r/2 to I_z."""
    I, R, F = 0.14, 0.31, 10.0  # noqa: E741
    values = {**TOP, "effect.wheel_inertia.m": 2 * I / R**2}
    ahead = run(values, {"push.F_rl": F, "push.F_rr": F})
    np.testing.assert_allclose(ahead["chair.u"], 2 * F / (MASS + 2 * I / R**2) * ahead.time, rtol=1e-8, atol=1e-12)
    spin = run(values, {"push.F_rl": F, "push.F_rr": -F})
    inertia = I_Z + 2 * I / R**2 * (T_R / 2) ** 2
    np.testing.assert_allclose(spin["chair.psi_dot"], T_R * F / inertia * spin.time, rtol=1e-8, atol=1e-12)


@pytest.mark.effect("trunk_motion")
def test_a_steady_push_moves_the_trunk_ahead_and_the_frame_back():
    """The CM obeys Newton; the frame is the CM less s = s₁ (1 − exp(−t/T)), and carries the instruments."""
    F, lag, amplitude = 40.0, 0.15, 0.02
    result = run({**SMOOTH, "start.u": 0.0, "effect.trunk_motion.amplitude": amplitude}, PUSH, T=1.0, n=101)
    t, s1 = result.time, amplitude * F / 80
    fading = np.exp(-t / lag)
    np.testing.assert_allclose(result["chair.x"], F / MASS * t**2 / 2, rtol=1e-7, atol=1e-12)
    np.testing.assert_allclose(result["effect.trunk_motion.lean"], s1 * (1 - fading), rtol=1e-7, atol=1e-12)
    np.testing.assert_allclose(result["sensor.wheel_speed_l"], F / MASS * t - s1 / lag * fading, rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(result["sensor.a_x"], F / MASS + s1 / lag**2 * fading, rtol=1e-6)


@pytest.mark.effect("trunk_motion")
def test_a_trunk_that_swings_goes_on_after_the_push():
    """Of a push that begins at once, s = s₁ (1 − e^(−ζωt) (cos ω_d t + ζω/ω_d sin ω_d t)); the frame recoils at −s'."""
    F, swing, zeta, omega = 40.0, 0.02, 0.2, 2 * np.pi * 1.3
    result = run({**SMOOTH, "start.u": 0.0, "effect.trunk_motion.swing": swing}, PUSH, T=2.0, n=201)
    t, s1, turning = result.time, swing * F / 80, omega * np.sqrt(1 - zeta**2)
    fading = np.exp(-zeta * omega * t)
    s = s1 * (1 - fading * (np.cos(turning * t) + zeta * omega / turning * np.sin(turning * t)))
    speed = s1 * fading * omega**2 / turning * np.sin(turning * t)
    np.testing.assert_allclose(result["effect.trunk_motion.swung"], s, atol=1e-8)
    np.testing.assert_allclose(result["sensor.wheel_speed_l"], F / MASS * t - speed, atol=1e-7)
    np.testing.assert_allclose(result["chair.x"] - result["sensor.x"], s, atol=1e-8)
    assert result["sensor.a_x"][0] == pytest.approx(F / MASS - s1 * omega**2)


@pytest.mark.effect("trunk_motion")
@pytest.mark.parametrize("sizes", [{"swing": 0.01}, {"amplitude": 0.02}])
def test_a_chair_gains_and_loses_within_a_stroke_what_was_recorded_of_people(sizes):
    """0.15 to 0.34 m/s of the frame against the CM, by a centimetre or two in strokes of 75 N a hand, one in 1.1 s."""

    def stroke(t):
        phase = np.mod(t, 1.1)
        return np.where(phase < 0.55, 75 * np.sin(np.pi * phase / 0.55), 0.0)

    values = {f"effect.trunk_motion.{name}": size for name, size in sizes.items()}
    result = run(values, dict.fromkeys(PUSH, stroke), T=6.0, n=1201)
    assert 0.15 < np.ptp((result["sensor.wheel_speed_l"] - result["chair.u"])[400:]) < 0.34


@pytest.mark.effect("trunk_motion")
def test_a_trunk_that_leans_moves_the_load_with_it():
    s = 0.03
    now = snapshot({"effect.trunk_motion.amplitude": 0.02}, states={"effect.trunk_motion.lean": s})
    assert pitching(now) == pytest.approx(-MASS * G * s, rel=1e-9)  # about where the CM was
    assert carried(now) == pytest.approx(MASS * G)


@pytest.mark.effect("trunk_motion")
def test_the_frame_stays_rigid_while_the_trunk_leans():
    """Hubs and pivots keep their distances, and all of the frame falls back against the CM as fast as the trunk leans."""
    turning = {"start.u": 1.0, "start.v": 0.1, "start.psi_dot": 0.8}
    leaning = snapshot({**turning, "effect.trunk_motion.amplitude": 0.02}, PUSH, {"effect.trunk_motion.lean": 0.004})
    lean_rate = leaning["effect.trunk_motion.lean'"]
    assert lean_rate > 0.01
    for velocity, arms in ((leaning["v_xf"], T_F / 2), (leaning["v_xr"], T_R / 2)):
        np.testing.assert_allclose(velocity, 1.0 - lean_rate + 0.8 * arms * np.array([1, -1]), rtol=1e-12)
    np.testing.assert_allclose(leaning["v_yf"] - leaning["v_yr"], 0.8 * (A + B), rtol=1e-12)


def turning_strokes(u: float):
    """Strokes of 80 N in all, the left the stronger, in a turn to the right, of a trunk that leans 30 mm and swings."""
    return run(
        {
            **SMOOTH,
            "start.u": u,
            "start.psi_dot": 1.0,
            "start.v": B,
            "effect.trunk_motion.amplitude": 0.03,
            "effect.trunk_motion.swing": 0.01,
        },
        {"push.F_rl": lambda t: 44 * np.sin(np.pi * t) ** 2, "push.F_rr": lambda t: 36 * np.sin(np.pi * t) ** 2},
        T=2.0,
        n=4001,
    )


@pytest.mark.effect("trunk_motion")
@pytest.mark.parametrize("u", [1.0, -0.6])
def test_instruments_on_the_frame_tell_one_story(u):
    """A marker, an accelerometer and the wheels move as one rigid body, which is not the CM's."""
    result = turning_strokes(u)
    to_room = np.exp(1j * result["chair.psi"])  # x + i y, clockwise as ψ is
    frame = result["sensor.x"] + 1j * result["sensor.y"]
    velocity = np.gradient(frame, result.time, edge_order=2)
    felt = np.gradient(velocity, result.time, edge_order=2) / to_room
    inside = slice(100, -100)
    off = result["sensor.a_x"] + 1j * result["sensor.a_y"] - felt
    assert np.quantile(np.abs(off[inside]), 0.99) < 2e-4  # but for the moments in which drag turns round with a wheel
    wheels = (result["sensor.wheel_speed_l"] + result["sensor.wheel_speed_r"]) / 2
    np.testing.assert_allclose(wheels[inside], (velocity / to_room).real[inside], atol=2e-5)
    seen = result["sensor.u"] + 1j * result["sensor.v"]
    np.testing.assert_allclose(seen[inside], (velocity / to_room)[inside], atol=2e-5)


@pytest.mark.effect("trunk_motion")
def test_instruments_that_were_read_at_the_cm_would_be_far_off():
    """30 mm and strokes of 80 N: the frame is more than 2 cm behind the CM at times, and feels 0.09 m/s² aside that the CM
    does not, in a turn backward."""
    straight = run(
        {"effect.trunk_motion.amplitude": 0.03}, dict.fromkeys(PUSH, lambda t: 40 * np.sin(np.pi * t) ** 2), T=3.0, n=301
    )
    assert 0.02 < (straight["chair.x"] - straight["sensor.x"]).max() < 0.03
    turning = turning_strokes(-0.6)
    turn = turning["chair.psi_dot"]
    of_the_cm = np.gradient(turning["chair.v"], turning.time) + turning["chair.u"] * turn
    assert np.abs(turning["sensor.a_y"] - of_the_cm)[100:-100].max() > 0.09


@pytest.mark.effect("trunk_motion")
def test_a_marker_on_the_frame_stays_behind_while_the_trunk_leans():
    """80 N held for long lean the trunk by the amplitude: the frame is that much behind the CM, along the heading."""
    values = {**SMOOTH, "start.u": 0.0, "start.psi": 2.0, "effect.trunk_motion.amplitude": 0.03}
    now = run(values, {"push.F_rl": 40.0, "push.F_rr": 40.0}, T=3.0, n=31)
    behind = now["chair.x"] - now["sensor.x"] + 1j * (now["chair.y"] - now["sensor.y"])
    assert behind[-1] == pytest.approx(0.03 * np.exp(2j), rel=1e-6)


@pytest.mark.effect("trunk_motion")
def test_an_accelerometer_on_the_frame_adds_up_to_the_frames_speed():
    result = run(
        {**SMOOTH, "effect.trunk_motion.amplitude": 0.02},
        dict.fromkeys(PUSH, lambda t: 40 * np.sin(np.pi * t) ** 2),
        T=2.0,
        n=4001,
    )
    assert np.ptp(result["sensor.wheel_speed_l"] - result["chair.u"]) > 0.02
    added = cumulative_simpson(result["sensor.a_x"], x=result.time, initial=0)
    np.testing.assert_allclose(result["sensor.wheel_speed_l"] - result["sensor.wheel_speed_l"][0], added, atol=5e-6)
