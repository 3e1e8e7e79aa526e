"""Pushes of one run with a clock of their own: found, told how far, and nobody else named."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.campaign.clocks import Signal, odd_ones_out, push_shifts

from .riding import coloured, ride, strokes
from .test_clocks import NOISE

READ = ("wheel_speed_l", "wheel_speed_r", "yaw_rate", "a_x")


def run(seed: int, early: float = 0.0, until: float = np.inf) -> list[Signal]:
    """One file, whose pushes stand `early` s before the motion that they make."""
    rng = np.random.default_rng(seed)
    truth = ride(rng, 9, until)
    t = np.arange(0, 9, 0.01)
    late = {q: early if q.startswith("F") else 0.0 for q in (*READ, "F_rl", "F_rr")}
    values = {q: np.interp(t + s, truth["t"], truth[q]) + coloured(rng, len(t), NOISE[q], 0.0) for q, s in late.items()}
    return [Signal("file", q, t, v) for q, v in values.items()]


@pytest.mark.parametrize("shift", [0.02, -0.1, 0.3, 1.3])
def test_a_shift_in_one_run_is_found_and_told(shift):
    found = odd_ones_out({f"run{i}": run(i, shift if i == 2 else 0.0) for i in range(4)})
    assert list(found) == ["run2"]
    assert found["run2"].seconds == pytest.approx(shift, abs=0.01)


def test_chairs_that_never_stop_tell_it_as_well():
    def moving(signals: list[Signal]) -> list[Signal]:
        return [Signal(s.device, s.quantity, s.time[300:], s.values[300:]) for s in signals]

    found = odd_ones_out({f"run{i}": moving(run(i, 0.1 if i == 1 else 0.0)) for i in range(4)})
    assert list(found) == ["run1"]
    assert found["run1"].seconds == pytest.approx(0.1, abs=0.01)


@pytest.mark.parametrize("common", [0.0, 0.03])
def test_what_all_runs_share_is_left_alone(common):
    runs = {f"run{i}": run(i, common) for i in range(4)}
    assert odd_ones_out(runs) == {}
    assert all(abs(s.seconds) < 0.01 for s in push_shifts(runs).values() if s.unique)


def test_a_run_without_pushes_tells_no_shift():
    runs = {f"run{i}": run(i) for i in range(3)} | {"coast": run(9, 0.3, until=0.0)}
    shifts = push_shifts(runs)
    assert "coast" not in shifts or not shifts["coast"].unique
    assert odd_ones_out(runs) == {}


def test_two_runs_cannot_tell_which_of_them_is_odd():
    assert odd_ones_out({"a": run(0), "b": run(1, 0.2)}) == {}


@pytest.mark.parametrize("shift", [0.0, 0.3])
def test_strokes_that_are_all_alike_tell_a_shift_but_for_whole_strokes(shift):
    rng = np.random.default_rng(0)
    t, force = strokes(rng, 9, regular=True)
    speed = np.cumsum(force - force.mean()) * 4e-5 + 1.0
    own = np.arange(0, 9, 0.01)
    alike = [
        Signal("file", q, own, np.interp(own + s, t, v) + coloured(rng, len(own), NOISE[q], 0.0))
        for q, s, v in (
            ("wheel_speed_l", 0, speed),
            ("wheel_speed_r", 0, speed),
            ("F_rl", shift, force),
            ("F_rr", shift, force),
        )
    ]
    runs = {f"run{i}": run(i) for i in range(3)} | {"strokes": alike}
    odd, told = odd_ones_out(runs), push_shifts(runs)["strokes"]
    assert list(odd) == (["strokes"] if shift else [])
    assert not told.unique
    assert min(abs(told.seconds - shift - whole) for whole in range(-3, 4)) < 0.01  # one stroke a second


def test_signals_of_two_devices_are_refused():
    with pytest.raises(ValueError, match="2 devices"):
        push_shifts({"a": [*run(0), Signal("other", "u", np.arange(9.0), np.arange(9.0))]})
