"""What instruments get wrong, each against a truth its file does not contain."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import simpson
from scipy.spatial.transform import Rotation

from tests.model.effects.chair import I_Z, MASS, SMOOTH, T_R, TOP, G, run
from wheelchair_fmu.campaign import Campaign, Run
from wheelchair_fmu.engine.simulate import Trajectory
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.model.variant import Variant

ALL = (
    "accelerometer_bias",
    "accelerometer_offset",
    "accelerometer_tilt",
    "gyro_bias",
    "gyro_scale",
    "marker_offset",
    "push_force_gain",
    "wheel_radius_error",
)
SLOPE = 0.02
SETTLED = slice(100, -5)  # tyres take some 0.05 s to their force; differences are worse at the end


def lively(errors: Mapping[str, float]) -> Trajectory:
    """Pushes that speed up, turn, and turn back, on a slope."""
    return run(
        {**effects(errors), "start.psi": 0.3},
        {"push.F_rl": lambda t: 15 + 10 * np.sin(3 * t), "push.F_rr": lambda t: 12 - 9 * np.sin(3 * t), "floor.slope_x": SLOPE},
        T=2.0,
        n=2001,
        among=ALL,
    )


def whole_turn(errors: Mapping[str, float]) -> Trajectory:
    """One turn on the spot, at 2 rad/s."""
    return run({**TOP, **effects(errors), "start.psi_dot": 2.0}, T=np.pi, among=ALL)


def effects(errors: Mapping[str, float]) -> dict[str, float]:
    return {f"effect.{name}": value for name, value in errors.items()}


def specific_force(result: Trajectory, forward: float = 0.0, right: float = 0.0) -> np.ndarray:
    """(n, 2) what is felt along x_m and y_m at a point of the chair: its room velocity's slope, less the floor's pull."""
    u, v, psi, r = (result[f"chair.{name}"] for name in ("u", "v", "psi", "psi_dot"))
    to_room = np.exp(1j * psi)  # x + i y, clockwise as ψ is
    velocity = (u - right * r + 1j * (v + forward * r)) * to_room
    felt = (np.gradient(velocity, result.time, edge_order=2) - G * np.sin(SLOPE)) / to_room
    return np.column_stack([felt.real, felt.imag])


def readings(result: Trajectory) -> np.ndarray:
    return np.column_stack([result["sensor.a_x"], result["sensor.a_y"]])


@pytest.mark.effect("accelerometer_bias")
def test_a_biased_accelerometer_reads_the_path_and_its_bias():
    result = lively({"accelerometer_bias.x": 0.3, "accelerometer_bias.y": -0.2})
    off = readings(result) - specific_force(result)
    np.testing.assert_allclose(off[SETTLED] - [0.3, -0.2], 0, atol=2e-6)


@pytest.mark.effect("accelerometer_offset")
def test_an_accelerometer_beside_the_cm_feels_its_own_path():
    result = lively({"accelerometer_offset.x": 0.4, "accelerometer_offset.y": -0.3})
    felt = specific_force(result, 0.4, -0.3)
    assert np.abs(felt - specific_force(result)).max() > 0.1
    np.testing.assert_allclose(readings(result)[SETTLED], felt[SETTLED], atol=2e-6)


@pytest.mark.effect("marker_offset")
def test_a_marker_beside_the_cm_draws_its_own_path():
    """It stays as far from the CM as it was mounted, and its path's slope, turned into the chair, is the speed it has."""
    result = lively({"marker_offset.x": -0.2, "marker_offset.y": 0.15})
    to_room = np.exp(1j * result["chair.psi"])
    marker, cm = (result[f"{of}.x"] + 1j * result[f"{of}.y"] for of in ("sensor", "chair"))
    np.testing.assert_allclose(np.abs(marker - cm), 0.25, rtol=1e-9)
    np.testing.assert_allclose(((marker - cm) / to_room).imag, 0.15, atol=1e-9)
    speed = np.gradient(marker, result.time, edge_order=2) / to_room
    np.testing.assert_allclose((result["sensor.u"] + 1j * result["sensor.v"])[SETTLED], speed[SETTLED], atol=2e-6)


@pytest.mark.effect("marker_offset")
def test_channels_that_other_instruments_read_are_read_where_those_are():
    """Each of y, u and v as a marker there would have it, and a_y as an accelerometer there."""
    at = {"x": (-0.2, 0.15), "y": (0.1, -0.2), "u": (0.3, 0.25), "v": (-0.1, 0.05), "a_x": (0.4, -0.3), "a_y": (0.1, 0.2)}
    errors = {"marker_offset.x": -0.2, "marker_offset.y": 0.15, "accelerometer_offset.x": 0.4, "accelerometer_offset.y": -0.3}
    for channel, first, effect in (*((c, "x", "marker_offset") for c in "yuv"), ("a_y", "a_x", "accelerometer_offset")):
        ahead, right = np.subtract(at[channel], at[first])
        errors |= {f"{effect}.{channel}_ahead": ahead, f"{effect}.{channel}_right": right}
    result = lively(errors)
    for channel, (x, y) in at.items():
        names = [f"{'accelerometer' if 'a_' in channel else 'marker'}_offset.{axis}" for axis in "xy"]
        alone = lively(dict(zip(names, (x, y), strict=True)))
        np.testing.assert_allclose(result[f"sensor.{channel}"], alone[f"sensor.{channel}"], atol=1e-9, err_msg=channel)


@pytest.mark.effect("marker_offset")
@pytest.mark.parametrize("b", [0.05, 0.2])
def test_markers_on_the_axle_are_read_there_wherever_the_cm_is(b):
    """Its middle hardly slips, and is b behind the CM."""
    result = run({"chair.b": b, "effect.marker_offset.from_axle": 1.0, "effect.marker_offset.y": 0.02}, among=ALL)
    to_room = np.exp(1j * result["chair.psi"])
    marker, cm = (result[f"{of}.x"] + 1j * result[f"{of}.y"] for of in ("sensor", "chair"))
    np.testing.assert_allclose((marker - cm) / to_room, -b + 0.02j, atol=1e-9)


@pytest.mark.effect("accelerometer_tilt")
@pytest.mark.parametrize(("roll", "pitch"), [(0.2, 0.0), (0.0, 0.3), (-0.3, 0.2)])
def test_a_tilted_accelerometer_reads_along_its_own_axes(roll, pitch):
    """The box is rolled, then pitched about its own axle; z points down, so the floor's support is felt as −g cos along it."""
    result = lively({"accelerometer_tilt.roll": roll, "accelerometer_tilt.pitch": pitch})
    felt = np.column_stack([specific_force(result), np.full(2001, -G * np.cos(SLOPE))])
    box = Rotation.from_euler("XY", [roll, pitch])
    np.testing.assert_allclose(readings(result)[SETTLED], box.inv().apply(felt)[SETTLED, :2], atol=2e-6)


@pytest.mark.effect("accelerometer_tilt")
def test_a_tilted_accelerometer_at_rest_tells_its_tilt():
    up, right_down = (
        run({"start.u": 0.0, f"effect.accelerometer_tilt.{axis}": 0.1}, T=0.1, n=2, among=ALL) for axis in ("pitch", "roll")
    )
    assert up["sensor.a_x"][-1] == pytest.approx(G * np.sin(0.1))
    assert right_down["sensor.a_y"][-1] == pytest.approx(-G * np.sin(0.1))


@pytest.mark.effect("gyro_bias")
def test_a_biased_gyro_drifts_in_heading():
    result = lively({"gyro_bias.b": 0.05})
    assert simpson(result["sensor.yaw_rate"], x=result.time) == pytest.approx(
        result["chair.psi"][-1] - result["chair.psi"][0] + 0.05 * 2.0, abs=1e-7
    )


@pytest.mark.effect("gyro_scale")
def test_a_gyro_with_a_wrong_scale_counts_too_much_of_a_turn():
    result = whole_turn({"gyro_scale.k": 0.05})
    assert result["chair.psi"][-1] == pytest.approx(2 * np.pi)
    assert simpson(result["sensor.yaw_rate"], x=result.time) == pytest.approx(1.05 * 2 * np.pi)


@pytest.mark.effect("wheel_radius_error")
def test_wheels_of_another_radius_count_too_much_of_a_turn():
    """On the spot each wheel rolls π t_r, the left one forward; an odometer takes it for that times its error."""
    result = whole_turn({"wheel_radius_error.mean": 0.005, "wheel_radius_error.difference": 0.07})
    for side, rolled in (("l", 0.97 * np.pi * T_R), ("r", -1.04 * np.pi * T_R)):
        assert simpson(result[f"sensor.wheel_speed_{side}"], x=result.time) == pytest.approx(rolled)


@pytest.mark.effect("push_force_gain")
def test_push_force_gain_divides_the_record():
    result = run(
        {**SMOOTH, "effect.push_force_gain.mean": 0.25, "start.u": 0.0}, {"push.F_rl": 10.0, "push.F_rr": 10.0}, among=ALL
    )
    np.testing.assert_allclose(result["chair.u"], 16.0 / MASS * result.time, rtol=1e-8, atol=1e-12)


@pytest.mark.effect("push_force_gain")
def test_a_sensor_that_reads_too_much_is_behind_a_turn_to_its_side():
    """Records alike with the right sensor reading a quarter too much: on the spot the left pushes 10 N, the right −8 N."""
    result = run(
        {
            **TOP,
            "effect.push_force_gain.mean": 0.125,
            "effect.push_force_gain.difference": 0.25,
            "speed.mode": "prescribed",
            "speed.u": 0.0,
        },
        {"push.F_rl": 10.0, "push.F_rr": -10.0},
        among=ALL,
    )
    np.testing.assert_allclose(result["chair.psi_dot"], T_R / 2 * 18.0 / I_Z * result.time, rtol=1e-7, atol=1e-12)


@pytest.mark.effect("push_force_delay")
@pytest.mark.parametrize("tau", [0.05, -0.03])
def test_a_record_that_is_early_by_tau_is_read_that_much_later(tau):
    """A stroke F₀ (1 − cos 2π(t − ½)) on each wheel from ½ s to 1½ s: u = 2 F₀/m (t − ½ − sin 2π(t − ½)/2π)."""
    t, F = np.linspace(0, 2, 1001), 20.0

    def stroke(time):
        return F * np.where(np.abs(time - 1) < 0.5, 1 - np.cos(2 * np.pi * (time - 0.5)), 0.0)

    since = np.clip(t - 0.5, 0, 1)
    speed = 2 * F / MASS * (since - np.sin(2 * np.pi * since) / (2 * np.pi))
    early = {name: stroke(t + tau) for name in ("push.F_rl", "push.F_rr")}
    recorded = Run("stroke", Path("stroke.csv"), "push", "fit", 0.0, {}, t, early, {"wheel_speed_l": speed})
    campaign = Campaign(
        "stroke",
        Path(),
        "SAE-J670",
        dict(SMOOTH),
        {},
        {"F_rl": 0.0, "F_rr": 0.0, "wheel_speed_l": 0.01},
        frozenset(),
        (),
        {},
        (recorded,),
        "",
    )
    likelihood = Likelihood(campaign, Variant().with_effects(["push_force_delay"]))
    seen = likelihood.evidence(campaign.runs, {"effect.push_force_delay.tau": tau}).runs[0].predicted[:, 0]
    np.testing.assert_allclose(seen, speed, atol=2e-5)
