"""The independent chair's rider who swings: by momentum, energy and closed forms, and after the push is over."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.diagnosis.cases import Case, Plan
from benchmarks.independent.campaigns import reaching
from benchmarks.independent.chair import Chair, simulate

SMOOTH = replace(Chair(), f_r=0.0, f_f=0.0)
RIDER = replace(SMOOTH, lean=0.02)
TIME = np.arange(501) * 0.01
STROKE = np.where((TIME > 0.3) & (TIME < 0.8), 40.0, 0.0)  # of each hand


def body(chair: Chair, push: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far the frame is behind the CM, and how much slower it is, against the same chair with a rider who sits still."""
    moving, still = (simulate(c, push, push) for c in (chair, replace(chair, lean=0.0)))
    return still["x"] - moving["x"], still["u"] - moving["u"]


def test_the_push_moves_the_centre_of_mass_and_the_rider_the_frame_alone():
    """Without resistance the frame ends as fast as any other, and where it would be: no body leaves its place for good."""
    shift, rate = body(RIDER, STROKE)
    assert np.abs(shift).max() > 0.01 and np.abs(rate).max() > 0.05
    assert abs(shift[-1]) < 1e-3 and abs(rate[-1]) < 5e-3


def test_a_quarter_of_the_swing_and_more_comes_after_the_hands_let_go():
    _, rate = body(RIDER, STROKE)
    assert np.ptp(rate[TIME > 0.85]) > 0.25 * np.ptp(rate)


def test_a_small_swing_dies_out_as_a_damped_pendulum_does():
    """Of second order: with one frequency and a decrement, by its peaks; a lag would have neither."""
    chair = replace(SMOOTH, lean=2e-4, lean_drag=0.0)
    shift, _ = body(chair, STROKE)
    late = TIME > 1.0
    peaks = [i for i in np.flatnonzero(late) if 0 < i < 500 and abs(shift[i]) > max(abs(shift[i - 1]), abs(shift[i + 1]))]
    zeta = chair.lean_damping / 2
    half = 0.5 / (chair.lean_frequency * np.sqrt(1 - zeta**2))
    assert np.diff(TIME[peaks[:4]]) == pytest.approx(half, abs=0.011)
    ratios = np.abs(shift[peaks[1:4]]) / np.abs(shift[peaks[:3]])
    assert ratios == pytest.approx(np.exp(-np.pi * zeta / np.sqrt(1 - zeta**2)), rel=0.02)


def test_an_accelerometer_on_the_frame_feels_its_rate():
    out = simulate(RIDER, STROKE, STROKE)
    inside = (TIME > 0.9) & (TIME < 4.5)  # where no push jumps
    np.testing.assert_allclose(out["a_x"][inside], np.gradient(out["u"], TIME)[inside], atol=0.02)


@pytest.mark.parametrize("rider", [RIDER, replace(SMOOTH, trunk=0.02)], ids=["swings", "follows"])
def test_in_a_turn_too_every_instrument_is_on_the_frame(rider):
    """What is read is what one point does in the room: its velocity and acceleration by differences of its place."""
    smooth = 30 * np.sin(3 * TIME) ** 2 * (np.pi > TIME)
    out = simulate(replace(rider, C_m_lambda=0.0), 1.4 * smooth, smooth)
    place = out["x"] + 1j * out["y"]
    velocity = np.gradient(place, TIME)
    acceleration = np.gradient(velocity, TIME)
    turned = np.exp(-1j * out["yaw"])
    inside = slice(20, -20)
    np.testing.assert_allclose(((velocity * turned).imag)[inside], out["v"][inside], atol=2e-3)
    np.testing.assert_allclose(((velocity * turned).real)[inside], out["u"][inside], atol=2e-3)
    np.testing.assert_allclose(((acceleration * turned).real)[inside], out["a_x"][inside], atol=0.02)
    np.testing.assert_allclose(((acceleration * turned).imag)[inside], out["a_y"][inside], atol=0.02)


def test_who_pushes_twice_as_hard_leans_less_than_twice_as_far():
    (one, _), (two, _) = (body(RIDER, scale * STROKE) for scale in (1.0, 2.0))
    assert 1.1 < np.abs(two).max() / np.abs(one).max() < 1.9


def test_trials_have_it():
    (case,) = [c for c in Plan([1]).cases if c.kind == "rider" and c.times == 3.0]
    assert case == Case("rider", ("trunk_motion",), 3.0, seed=1, only="swing")
    assert case.hidden == {"trunk_motion": {"swing": pytest.approx(0.015)}}
    assert case.name == "rider-trunk_motion.swing-3-white-everyday-1"


def test_who_reaches_forward_is_ahead_of_the_hands():
    """Once in each stroke and back, though no push leans them; where nobody strokes, they sit still."""
    time = np.arange(1201) * 0.01
    push = np.where((time > 1) & (np.mod(time - 1, 1.1) < 0.55), 40.0, 0.0)
    urge = reaching(time, push, 0.03)
    assert urge.max() == pytest.approx(0.03, rel=1e-3) and not urge[time < 0.6].any()
    begins = time[np.flatnonzero(np.diff(push) > 0)]
    np.testing.assert_allclose(np.interp(begins - 0.35, time, urge), 0.0, atol=1e-4)
    np.testing.assert_allclose(np.interp(begins - 0.35 + 0.55, time, urge), 0.03, atol=1e-3)
    assert reaching(time, np.full(1201, 12.0), 0.03) is None and reaching(time, push, 0.0) is None
