"""The pusher as an FMU, against closed forms."""

from __future__ import annotations

from math import exp, pi, sin

import numpy as np
import pytest

from tests.fmu.chair import chair
from wheelchair_fmu.errors import UsageError
from wheelchair_fmu.fmu.companions import build_pusher

from .conftest import RECORDING

FOLLOW = 2
HANDS = ("push.F_rl", "push.F_rr")


def stroke(t: float, cadence: float, contact: float) -> float:
    part = t * cadence % 1
    return sin(pi * part / contact) if t >= 0 and part < contact else 0.0


def test_strokes_are_half_sines_of_the_given_cadence_asymmetry_and_delay(pusher):
    values = {"stroke.cadence": 1.3, "stroke.force": 50.0, "stroke.contact": 0.4, "stroke.asymmetry": 0.2, "stroke.delay": 0.33}
    with chair(pusher) as p:
        p.start(values)
        for i in range(1, 300):
            left, right = p.step(0.011).get(*HANDS)
            here = 50 * stroke(i * 0.011 - 0.33, 1.3, 0.4)
            assert (left, right) == pytest.approx((1.2 * here, 0.8 * here), abs=1e-9)


def test_the_mean_of_a_cycle_is_what_follow_counts_on(pusher):
    with chair(pusher) as p:
        p.start({"stroke.force": 10.0, "stroke.contact": 0.5})
        mean = np.mean([p.step(0.001).get("push.F_rl")[0] for _ in range(1000)])
    assert mean == pytest.approx(10 * 0.5 * 2 / pi, rel=1e-5)


def test_nothing_depends_on_the_communication_step(pusher):
    ends = []
    for step in (0.001, 0.01, 0.05):
        with chair(pusher) as p:
            p.start({"pusher.mode": FOLLOW, "chair.u": 0.2, "chair.y": 0.1, "stroke.contact": 0.8})
            ends.append(p.step(step, round(0.7 / step)).get(*HANDS, "stroke.phase"))
    assert min(map(abs, ends[0])) > 0.1
    assert ends[1] == pytest.approx(ends[0], abs=1e-9) and ends[2] == pytest.approx(ends[0], abs=1e-9)


def test_the_hands_lag_behind_what_is_wanted(pusher):
    """At rest beside a straight path, with no turning wanted: c = gain · speed, reached as 1 − exp(−t/τ)."""
    values = {"pusher.mode": FOLLOW, "follow.speed": 0.5, "follow.speed_gain": 20.0, "follow.delay": 0.3, "stroke.force": 500.0}
    with chair(pusher) as p:
        p.start(values)
        t = 0.2
        found = p.step(0.01, 20).get(*HANDS)
    wanted = 20 * 0.5 * (1 - exp(-t / 0.3)) / (0.5 * 2 / pi) * sin(pi * t / 0.5)
    assert found == pytest.approx([wanted, wanted], rel=1e-7)


def test_no_stroke_is_stronger_than_the_person(pusher):
    with chair(pusher) as p:
        p.start({"pusher.mode": FOLLOW, "follow.speed": 3.0, "stroke.force": 25.0})
        pushes = [p.step(0.005).get("push.F_rl")[0] for _ in range(400)]
    assert max(pushes) == pytest.approx(25.0, rel=1e-3) and max(pushes) <= 25


def test_a_mirror_swaps_the_hands(pusher):
    where = {"chair.x": 1.0, "chair.y": 0.2, "chair.psi": -0.3, "chair.u": 0.8, "chair.psi_dot": 0.1}
    mirrored = {**where, "chair.y": -0.2, "chair.psi": 0.3, "chair.psi_dot": -0.1}
    course = {"pusher.mode": FOLLOW, "course.cones": 4.0, "stroke.asymmetry": 0.1, "stroke.force": 300.0}
    other = {**course, "course.clearance": -0.6, "stroke.asymmetry": -0.1}
    found = []
    for values, place in ((course, where), (other, mirrored)):
        with chair(pusher) as p:
            p.start({**values, **place})
            found.append(p.step(0.01, 21).get(*HANDS))
    assert found[0][0] != pytest.approx(found[0][1], abs=1)
    assert found[1] == pytest.approx(found[0][::-1], rel=1e-12)


def test_the_path_goes_round_the_cones_on_alternating_sides(pusher):
    course = {"course.cones": 3.0, "course.first": 3.0, "course.spacing": 2.0, "course.clearance": 0.6}
    places = {3.0: 0.6, 5.0: -0.6, 7.0: 0.6, 4.0: 0.0, 6.0: 0.0, 1.0: 0.0, 9.0: 0.0, -5.0: 0.0, 50.0: 0.0, 2.0: 0.3}
    with chair(pusher) as p:
        p.start(course)
        for x, y in places.items():
            p.set({"chair.x": x, "chair.y": 0.1})
            assert p.get("path.y", "path.deviation") == pytest.approx([y, 0.1 - y], abs=1e-12), x


def test_without_cones_the_path_is_straight(pusher):
    with chair(pusher) as p:
        p.start({"chair.x": 3.0})
        assert p.get("path.y") == [0.0]


def test_a_recording_is_replayed_linearly_and_ends(replaying):
    time = RECORDING.time - RECORDING.time[0]
    with chair(replaying) as p:
        p.start({"stroke.delay": 0.2})
        for i in range(1, 130):
            t = i * 0.01 - 0.2
            wanted = [np.interp(t, time, f, left=0, right=0) for f in (RECORDING.F_rl, RECORDING.F_rr)]
            assert p.step(0.01).get(*HANDS) == pytest.approx(wanted, abs=1e-9), t


def test_without_a_recording_there_is_no_replay(pusher, tmp_path):
    mode = next(v for v in pusher.description.modelVariables if v.name == "pusher.mode")
    assert int(mode.max) == 2
    with pytest.raises(UsageError, match="needs a recording; give one with --replay"):
        build_pusher(tmp_path / "p.fmu", {"pusher.mode": "replay"})


@pytest.mark.parametrize("mode", ["pusher", "replaying"])
def test_a_restored_state_goes_on_bit_for_bit(mode, request):
    with chair(request.getfixturevalue(mode)) as p:
        p.start({"chair.u": 0.4, "chair.y": 0.2})
        p.step(0.013, 20)
        state = p.fmu.getFMUState()
        at, first = p.time, p.step(0.013, 20).get(*HANDS)
        p.fmu.setFMUState(state)
        p.time = at
        assert p.step(0.013, 20).get(*HANDS) == first
        p.fmu.freeFMUState(state)
