"""The rider's body moves against the frame, as measured: what the chair does is Newton's, and instruments are on the frame."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import cumulative_simpson

from tests.model.effects.chair import MASS, SMOOTH, A, B, G, run, snapshot

OMEGA = 2 * np.pi * 1.3
BODY, SWING = 60.0, 0.03  # kg and m


def swinging(mass: float = BODY, swing: float = SWING) -> dict:
    """A mass that swings by s = swing sin ωt, as position, momentum and force."""
    return {
        "rider.s": lambda t: swing * np.sin(OMEGA * t),
        "rider.momentum": lambda t: mass * swing * OMEGA * np.cos(OMEGA * t),
        "rider.force": lambda t: -mass * swing * OMEGA**2 * np.sin(OMEGA * t),
    }


def test_no_motion_of_the_body_moves_the_centre_of_mass():
    """Without forces the CM goes on, and the frame recoils by p/m."""
    result = run({**SMOOTH, "start.u": 1.2, "rider.m": BODY}, swinging(), T=2.0, n=401)
    p = BODY * SWING * OMEGA * np.cos(OMEGA * result.time)
    np.testing.assert_allclose(result["chair.u"], 1.2, atol=1e-9)
    np.testing.assert_allclose(result["sensor.wheel_speed_l"], 1.2 - p / MASS, atol=1e-9)
    np.testing.assert_allclose(result["sensor.u"], 1.2 - p / MASS, atol=1e-9)
    s = SWING * np.sin(OMEGA * result.time)
    np.testing.assert_allclose(result["sensor.x"], 1.2 * result.time - BODY * s / MASS, atol=1e-8)


def test_where_the_body_is_there_is_its_weight():
    s = 0.05
    now = snapshot({"rider.m": BODY}, {"rider.s": s})
    assert sum(now["N_r"]) * B - sum(now["N_f"]) * A == pytest.approx(-BODY * G * s, rel=1e-9)
    assert sum(now["N_r"]) + sum(now["N_f"]) == pytest.approx(MASS * G)


def test_a_scale_of_the_motion_is_more_of_the_same_motion():
    twice = run({"rider.m": BODY, "rider.scale": 2.0}, swinging(), T=1.0, n=201)
    larger = run({"rider.m": 2 * BODY}, swinging(2 * BODY), T=1.0, n=201)
    np.testing.assert_allclose(twice.results, larger.results, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("u", [1.0, -0.6])
def test_instruments_on_the_frame_tell_one_story(u):
    """A marker, an accelerometer and the wheels move as one rigid body, in a turn with strokes."""
    result = run(
        {**SMOOTH, "start.u": u, "start.psi_dot": 1.0, "start.v": B, "rider.m": BODY},
        {**swinging(), "push.F_rl": lambda t: 44 * np.sin(np.pi * t) ** 2, "push.F_rr": lambda t: 36 * np.sin(np.pi * t) ** 2},
        T=2.0,
        n=4001,
    )
    to_room = np.exp(1j * result["chair.psi"])
    velocity = np.gradient(result["sensor.x"] + 1j * result["sensor.y"], result.time, edge_order=2)
    felt = np.gradient(velocity, result.time, edge_order=2) / to_room
    inside = slice(100, -100)
    off = result["sensor.a_x"] + 1j * result["sensor.a_y"] - felt
    assert np.quantile(np.abs(off[inside]), 0.99) < 5e-4  # but for the moments in which drag turns round with a wheel
    seen = result["sensor.u"] + 1j * result["sensor.v"]
    np.testing.assert_allclose(seen[inside], (velocity / to_room)[inside], atol=2e-5)


def test_drag_works_against_the_frame_that_rolls_and_not_against_the_centre_of_mass():
    """A chair at rest whose rider swings rolls to and fro: its drag takes turns, and its CM hardly moves."""
    result = run({"start.u": 0.0, "rider.m": BODY}, swinging(), T=3.0, n=3001)
    rolled = result["sensor.wheel_speed_l"]
    assert rolled.min() < -0.1 < 0.1 < rolled.max()
    momentum = MASS * (result["chair.u"] - result["chair.u"][0])
    drag = -np.gradient(momentum, result.time)
    moving = np.abs(rolled) > 0.05
    assert (np.sign(drag[moving]) == np.sign(rolled[moving])).mean() > 0.99


def test_a_scale_moves_nothing_where_no_motion_is_given():
    plain, scaled = (run({"rider.scale": k, "rider.m": 100.0 * k}, {"push.F_rl": 20.0}, T=0.5, n=51) for k in (1.0, 3.0))
    np.testing.assert_array_equal(plain.results, scaled.results)


def test_the_accelerometer_adds_up_to_the_frames_speed():
    result = run({**SMOOTH, "start.u": 1.0, "rider.m": BODY}, swinging(), T=2.0, n=2001)
    added = cumulative_simpson(result["sensor.a_x"], x=result.time, initial=0)
    np.testing.assert_allclose(result["sensor.wheel_speed_l"] - result["sensor.wheel_speed_l"][0], added, atol=2e-6)


@pytest.mark.parametrize(("c", "d"), [(0.02, 0.0), (-0.01, 0.015)])
def test_a_body_that_moves_with_each_stroke_is_one_whose_motion_was_measured(c, d):
    """The whole person as a mass that moves by c (cos θ − 1) + d sin θ, in a turn with strokes."""
    rate = 2 * np.pi * 1.1
    by_stroke = {"stroke.phase": lambda t: 1.1 * t, "stroke.rate": 1.1}
    measured = {
        "rider.s": lambda t: c * (np.cos(rate * t) - 1) + d * np.sin(rate * t),
        "rider.momentum": lambda t: MASS * rate * (d * np.cos(rate * t) - c * np.sin(rate * t)),
        "rider.force": lambda t: -MASS * rate**2 * (c * np.cos(rate * t) + d * np.sin(rate * t)),
    }
    values = {**SMOOTH, "start.u": 1.0, "start.psi_dot": 0.4}
    pushes = {"push.F_rl": lambda t: 25 * np.sin(rate * t / 2) ** 2, "push.F_rr": lambda t: 15 * np.sin(rate * t / 2) ** 2}
    one = run({**values, "effect.stroke_motion.cos": c, "effect.stroke_motion.sin": d}, {**pushes, **by_stroke}, T=2.0, n=2001)
    other = run({**values, "rider.m": MASS}, {**pushes, **measured}, T=2.0, n=2001)
    for name in ("sensor.wheel_speed_l", "sensor.a_x", "sensor.a_y", "sensor.x", "sensor.y", "sensor.yaw", "chair.u"):
        np.testing.assert_allclose(one[name], other[name], atol=2e-5, err_msg=name)
    assert np.ptp(one["sensor.wheel_speed_l"] - one["chair.u"]) > 0.1
