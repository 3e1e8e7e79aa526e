"""What acts from outside: as hands do on a chair whose rider sits still, and nothing that the rider's body answers."""

from __future__ import annotations

import numpy as np
import pytest

from tests.model.effects.chair import MASS, SMOOTH, run

TREAD = 0.55  # m, the rear wheels' of the paper's chair


def pulled(t: float) -> float:
    return 30 * np.sin(np.pi * t) ** 2


def turned(t: float) -> float:
    return 6 * np.sin(2 * np.pi * t)


def test_a_force_from_outside_moves_the_centre_of_mass():
    """Newton's second law, on a chair that nothing holds back."""
    result = run({**SMOOTH, "start.u": 0.5}, {"external.force": pulled}, T=2.0, n=401)
    t = result.time
    np.testing.assert_allclose(result["chair.u"], 0.5 + (15 * t - 7.5 * np.sin(2 * np.pi * t) / np.pi) / MASS, atol=1e-5)


def test_force_and_moment_from_outside_do_what_both_hands_do():
    start = {"start.u": 0.8}
    outside = run(start, {"external.force": pulled, "external.moment": turned}, T=2.0, n=401)
    hands = run(
        start,
        {"push.F_rl": lambda t: pulled(t) / 2 + turned(t) / TREAD, "push.F_rr": lambda t: pulled(t) / 2 - turned(t) / TREAD},
        T=2.0,
        n=401,
    )
    for name in ("chair.u", "chair.v", "chair.psi_dot", "sensor.a_x", "sensor.a_y", "caster.fl"):
        np.testing.assert_allclose(outside[name], hands[name], atol=2e-6, err_msg=name)
    assert np.ptp(outside["chair.psi_dot"]) > 0.02, "it turns"


@pytest.mark.parametrize("size", ["effect.trunk_motion.swing", "effect.trunk_motion.amplitude"])
def test_a_body_that_answers_the_hands_does_not_answer_what_acts_from_outside(size):
    values = {**SMOOTH, "start.u": 0.5, size: 0.02}
    pushed = run(values, {"push.F_rl": pulled, "push.F_rr": pulled}, T=2.0, n=401)
    drawn = run(values, {"external.force": lambda t: 2 * pulled(t)}, T=2.0, n=401)
    assert np.abs(pushed["sensor.u"] - pushed["chair.u"]).max() > 0.01
    np.testing.assert_allclose(drawn["sensor.u"], drawn["chair.u"], atol=1e-12)
