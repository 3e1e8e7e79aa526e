"""A body that moves with each stroke, by a phase of its own: what the frame does is momentum's."""

from __future__ import annotations

import numpy as np
import pytest

from tests.model.effects.chair import SMOOTH, run


@pytest.mark.effect("stroke_motion")
def test_the_frame_recoils_from_a_body_and_the_centre_of_mass_goes_on():
    """Without forces the CM keeps its speed; the frame is where the CM is, less how far the body went, by θ = ω t."""
    c, d, omega = 0.01, -0.02, 7.0
    strokes = {"stroke.phase": lambda t: omega / (2 * np.pi) * t, "stroke.rate": omega / (2 * np.pi)}
    values = {**SMOOTH, "start.u": 1.2, "effect.stroke_motion.cos": c, "effect.stroke_motion.sin": d}
    result = run(values, strokes, T=3.0, n=301)
    t = result.time
    np.testing.assert_allclose(result["chair.u"], 1.2, atol=1e-9)
    away = np.hypot(c, d)
    lead = np.arctan2(c, d)
    np.testing.assert_allclose(result["sensor.x"], 1.2 * t - away * (np.sin(omega * t + lead) - np.sin(lead)), atol=1e-8)
    np.testing.assert_allclose(result["sensor.wheel_speed_r"], 1.2 - away * omega * np.cos(omega * t + lead), atol=1e-8)
    np.testing.assert_allclose(result["sensor.a_x"], away * omega**2 * np.sin(omega * t + lead), atol=1e-8)


@pytest.mark.effect("stroke_motion")
def test_a_body_rests_where_nobody_strokes():
    at_rest = {"stroke.phase": 3.0, "stroke.rate": 0.0}
    values = {"start.u": 1.0, "effect.stroke_motion.cos": 0.05, "effect.stroke_motion.sin": 0.05}
    with_it, without = run(values, at_rest, T=2.0, n=201), run({"start.u": 1.0}, T=2.0, n=201, among=("stroke_motion",))
    np.testing.assert_allclose(with_it.results, without.results, atol=1e-9)
