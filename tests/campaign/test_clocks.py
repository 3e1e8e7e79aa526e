"""Clocks of loggers: offsets that are known, standard errors that hold, and silence where nothing is sure."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import find_peaks

from wheelchair_fmu.campaign.clocks import Signal, alike, offsets
from wheelchair_fmu.campaign.clocks.lag import summits
from wheelchair_fmu.campaign.clocks.network import _errors
from wheelchair_fmu.campaign.clocks.scatter import long_run
from wheelchair_fmu.campaign.syncing import RunClocks

from .riding import coloured, ride, strokes

NOISE = {"wheel_speed_l": 0.01, "wheel_speed_r": 0.01, "u": 0.01, "yaw_rate": 0.01, "a_x": 0.1, "F_rl": 0.5, "F_rr": 0.5}


def recorded(rng, truth, device, quantities, rate, start, seconds=10.0, a=0.0, drift=0.0):
    """Signals of a device whose clock was started at true time `start`, and whose seconds are 1 + drift of true ones."""
    own = np.arange(0, seconds, 1 / rate)
    true = start + (1 + drift) * own
    values = {q: np.interp(true, truth["t"], truth[q]) + coloured(rng, len(own), NOISE[q], a) for q in quantities}
    return [Signal(device, q, own, v) for q, v in values.items()]


def test_the_offset_is_what_is_added_to_a_devices_time_to_get_the_references():
    rng = np.random.default_rng(1)
    truth = ride(rng, 12)
    signals = [
        *recorded(rng, truth, "frame", ["u", "yaw_rate"], 150, 0.3),
        *recorded(rng, truth, "left", ["wheel_speed_l"], 240, 0.9),
        *recorded(rng, truth, "right", ["wheel_speed_r"], 100, -0.2),
    ]
    clocks = offsets(signals)
    for name, offset in (("left", 0.6), ("right", -0.5)):
        assert clocks[name].sure, clocks[name].why
        assert abs(clocks[name].offset - offset) < min(3 * clocks[name].se, 0.005)
    assert clocks["frame"].offset == 0.0
    other = offsets(signals, reference="left")
    assert other["right"].offset == pytest.approx(clocks["right"].offset - clocks["left"].offset, abs=0.002)


@pytest.mark.parametrize("a", [0.0, 0.9])
def test_standard_errors_of_a_lag_cover_the_truth(a):
    z = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        t, force = strokes(rng, 12, start=1.2 + rng.uniform(0, 0.5))
        truth = {"t": t, "u": np.cumsum(force - force.mean() * (t > 1)) * 2e-5}
        lag = rng.uniform(-0.8, 0.8)
        (one,), (other,) = recorded(rng, truth, "a", ["u"], 100, 0.0, a=a), recorded(rng, truth, "b", ["u"], 150, lag, a=a)
        match = alike(one, other)
        assert match is not None and match.unique
        z.append((match.lag - lag) / match.se)
    assert np.mean(np.abs(z) < 1.96) >= 0.85
    assert 0.75 < np.sqrt(np.mean(np.square(z))) < 1.35


def test_the_variance_of_a_sum_counts_what_hangs_together():
    rng = np.random.default_rng(0)
    for whitened in (True, False):
        found = np.mean([long_run(coloured(rng, 2000, 1.0, 0.8), whitened)[0] for _ in range(40)])
        assert found == pytest.approx(2000 * 1.8 / 0.2, rel=0.3)  # white noise would have 2000


def test_strokes_that_are_all_alike_are_not_unique_and_a_first_movement_makes_them_so():
    rng = np.random.default_rng(2)
    t, force = strokes(rng, 12, regular=True)
    speed = np.cumsum(force - force.mean()) * 4e-5
    for first, unique in ((-9.0, False), (1.5, True)):
        truth = {"t": t, "u": np.where(t < first, 0.0, speed - np.interp(first, t, speed))}
        (one,), (other,) = recorded(rng, truth, "a", ["u"], 100, 0.0), recorded(rng, truth, "b", ["u"], 100, 0.4)
        match = alike(one, other)
        assert match is not None and match.unique is unique


def test_devices_that_share_nothing_are_not_sure_and_the_sentence_says_the_cure():
    rng = np.random.default_rng(3)
    truth = ride(rng, 12)
    still = Signal("box", "a_x", np.arange(0, 10, 0.01), rng.normal(size=1000))
    clocks = offsets([*recorded(rng, truth, "frame", ["u", "yaw_rate"], 100, 0.0), still])
    assert not clocks["box"].sure and "by hand" in clocks["box"].why and clocks["frame"].sure
    only = offsets([*recorded(rng, truth, "frame", ["u"], 100, 0.0), Signal("box", "a_y", still.time, still.values)])
    assert not only["box"].sure and np.isnan(only["box"].offset)


def test_a_device_whose_signals_contradict_each_other_is_not_believed():
    rng = np.random.default_rng(4)
    truth = ride(rng, 12)
    a = recorded(rng, truth, "a", ["wheel_speed_l", "u", "yaw_rate"], 100, 0.0)
    b = recorded(rng, truth, "b", ["wheel_speed_l"], 100, 0.3) + recorded(rng, truth, "b", ["a_x"], 100, 0.6)
    c = recorded(rng, truth, "c", ["a_x"], 100, 0.0) + recorded(rng, truth, "c", ["u", "yaw_rate"], 100, 0.0)
    clocks = offsets([*a, *b, *c])
    assert not clocks["b"].sure and "agree" in clocks["b"].why


def test_a_wrong_sign_a_wrong_unit_and_the_other_wheel_show_in_gain_and_correlation():
    rng = np.random.default_rng(5)
    truth = ride(rng, 12)
    (left,), (right,) = (recorded(rng, truth, "w", [q], 100, 0.0) for q in ("wheel_speed_l", "wheel_speed_r"))
    (again,) = recorded(rng, truth, "imu", ["wheel_speed_l"], 100, 0.4)
    turned = Signal("imu", "wheel_speed_l", again.time, -3.6 * again.values)
    match, wrong_side = alike(left, turned), alike(right, turned)
    assert match.gain == pytest.approx(-1 / 3.6, rel=0.02) and match.correlation < -0.99
    assert abs(wrong_side.correlation) < abs(match.correlation)
    assert match.lag == pytest.approx(0.4, abs=0.005)


def test_pushes_and_motion_tell_each_others_clock():
    rng = np.random.default_rng(6)
    truth = ride(rng, 12)
    clocks = offsets(
        [
            *recorded(rng, truth, "wheels", ["wheel_speed_l", "wheel_speed_r"], 100, 0.0),
            *recorded(rng, truth, "amplifier", ["F_rl", "F_rr"], 200, -0.25),
        ]
    )
    assert clocks["amplifier"].sure and clocks["amplifier"].offset == pytest.approx(-0.25, abs=0.02)


def test_drift_is_told_where_the_record_is_long_and_left_alone_where_it_is_short():
    rng = np.random.default_rng(7)
    truth = ride(rng, 310)
    long, short = (
        offsets(recorded(rng, truth, "a", ["u"], 50, 0.0, s) + recorded(rng, truth, "b", ["u"], 50, 0.4, s, drift=120e-6))["b"]
        for s in (300, 10)
    )
    assert long.drift == pytest.approx(120e-6, abs=4 * long.drift_se) and long.drift_se < 30e-6
    assert long.offset == pytest.approx(0.4, abs=4 * long.se)
    assert short.drift == 0.0


def test_an_offset_beside_which_no_drift_is_written_is_right_in_the_middle():
    """Without its drift, the offset at a clock's zero puts all of the run off by what the drift adds up to until its middle."""
    rng, seconds, drift = np.random.default_rng(11), 70.0, 40e-6
    truth = ride(rng, 80)
    one = recorded(rng, truth, "a", ["u"], 50, 0.0, seconds)
    clock = offsets(one + recorded(rng, truth, "b", ["u"], 50, 0.4, seconds, drift=drift))["b"]
    assert 0 < abs(clock.drift) < 3 * clock.drift_se
    written = RunClocks(None, "a", {"b": clock}, middles={"b": seconds / 2}).sure["b"]
    assert "drift" not in written
    assert written["offset"] == pytest.approx(0.4 + drift * seconds / 2, abs=1e-3)


@pytest.mark.parametrize("levels", [2, 3, 10])
def test_summits_of_a_profile_are_scipys_peaks_flat_ones_by_their_middle(levels):
    rng = np.random.default_rng(levels)
    for n in (1, 2, 3, 4, 50, 200):
        heights = rng.integers(0, levels, n).astype(float)
        np.testing.assert_array_equal(summits(heights), find_peaks(heights)[0])
    assert summits(np.array([0.0, 2.0, 2.0, 2.0, 1.0, 3.0])).tolist() == [2]


def test_gaps_are_not_read():
    rng = np.random.default_rng(8)
    truth = ride(rng, 12)
    (one,), (other,) = recorded(rng, truth, "a", ["u"], 150, 0.0), recorded(rng, truth, "b", ["u"], 100, 0.35)
    values = one.values.copy()
    values[600:700] = np.nan
    match = alike(Signal("a", "u", one.time, values), other)
    assert match.lag == pytest.approx(0.35, abs=4 * match.se)


FIRST = [True, False, False, False]  # which of the devices the others are held against


def test_what_all_offsets_have_in_common_is_the_references_error():
    """Beside a clock that is unsure by 2 ms, three others that are unsure by 1, 0.5 and 0.2 ms each."""
    own, shared = np.array([1e-3, 5e-4, 2e-4]), 2e-3
    covariance = np.zeros((4, 4))
    covariance[1:, 1:] = np.diag(own**2) + shared**2
    se, parts = _errors(FIRST[:4], covariance)
    np.testing.assert_allclose(se, [0.0, *np.hypot(own, shared)])
    np.testing.assert_allclose(parts, [shared, *own])
    two = np.array([[0.0, np.nan, 0.0], [np.nan, np.nan, np.nan], [0.0, np.nan, 4e-6]])  # the second was led to by nothing
    se, parts = _errors(FIRST[:3], two)
    np.testing.assert_allclose([se[2], parts[0], parts[2]], [shared, 0.0, shared])
    apart = np.array([[0.0, 0.0, 0.0], [0.0, 1e-6, -5e-7], [0.0, -5e-7, 1e-6]])
    assert _errors(FIRST[:3], apart)[1][0] == 0.0
