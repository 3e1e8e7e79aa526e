"""Casters may swing round where a chair backs up or turns back on the spot, and nowhere else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.inference.evidence.flipping import may_swing_round
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import Choice

T_R = 0.55
FORWARD, BACK, RIGHT, LEFT = (0.6, 0.6), (-0.3, -0.3), (0.3, -0.3), (-0.3, 0.3)  # m/s of the left and the right wheel
CURVE, TO_LEFT = (0.8, 0.5), (0.5, 0.8)


def rolling(sample, *parts, chance=None):
    """A run whose wheels roll so, for two seconds each, with a standing second before."""
    time = np.arange(0, 1 + 2 * len(parts), 0.02)
    wheels = np.array([(0.0, 0.0), *parts])[np.where(time < 1, 0, 1 + ((time - 1) // 2).astype(int))].T
    noise = chance.normal(0, 0.01, wheels.shape) if chance else 0.0
    channels = dict(zip(("wheel_speed_l", "wheel_speed_r"), wheels + noise, strict=True))
    return replace(sample.runs[0], time=time, channels=channels, inputs={}, set={})


@pytest.mark.parametrize(
    ("parts", "swings"),
    [
        ((FORWARD, CURVE, TO_LEFT, FORWARD), False),
        (((0.6, 0.1),), False),
        ((RIGHT,), True),  # the right pivot moves back on its circle
        ((FORWARD, RIGHT), True),
        ((FORWARD, BACK), True),
        ((BACK,), True),
        ((RIGHT, LEFT), True),
        ((FORWARD, CURVE, BACK), True),
    ],
)
def test_ways_of_wheels_tell(sample, parts, swings):
    for chance in (None, np.random.default_rng(3)):
        assert may_swing_round(rolling(sample, *parts, chance=chance), {"chair.t_r": T_R}) is swings


def test_casters_that_start_turned_round_swing_as_soon_as_the_chair_rolls(sample):
    run = rolling(sample, FORWARD)
    assert not may_swing_round(run, {"chair.t_r": T_R})
    assert may_swing_round(run, {"chair.t_r": T_R, "start.caster_l": 3.0})


def test_what_a_variant_says_of_the_start_counts_as_well(sample):
    chair = Variant(Choice(caster="slipping"))
    assert not Likelihood(sample, chair, columns=()).may_flip
    assert Likelihood(sample, chair.with_values({"start.caster_l": 3.0}), columns=()).may_flip


@pytest.mark.parametrize(("parts", "swings"), [((FORWARD, CURVE), False), ((FORWARD, BACK), True), ((RIGHT, LEFT), True)])
def test_so_do_speed_and_yaw_rate(sample, parts, swings):
    run = rolling(sample, *parts)
    left, right = run.channels.values()
    told = replace(run, channels={"u": (left + right) / 2, "yaw_rate": (left - right) / T_R})
    assert may_swing_round(told, {}) is swings


def test_so_may_those_of_a_run_that_does_not_tell_how_it_rolls(sample):
    run = rolling(sample, FORWARD)
    assert may_swing_round(replace(run, channels={"yaw_rate": np.zeros(len(run.time))}), {"chair.t_r": T_R})


@pytest.mark.parametrize(("push", "grows"), [(40.0, False), (-40.0, True)])
def test_what_disturbs_a_caster_dies_out_unless_it_leads(sample, push, grows):
    """By the model itself: two casters that differ by a ten-thousandth are together at once, or come apart."""
    chair = Variant().with_effects(["caster_trail"])
    simulator, time = Simulator(chair), np.arange(0, 3, 0.01)
    inputs = simulator.inputs(len(time), {"push.F_rl": np.full(len(time), push), "push.F_rr": np.full(len(time), push)})
    known = {"chair.t_r": T_R, "effect.caster_trail.c": 0.05}
    ways = []
    for start in (0.05, 0.0501):
        there = simulator.run(time, inputs, chair.vector({**known, "start.caster_l": start, "start.caster_r": 0.05}))
        ways.append(there["swivel.fl"])
    wheels = {f"wheel_speed_{side}": there[f"sensor.wheel_speed_{side}"] for side in "lr"}
    apart = np.abs(ways[1] - ways[0])
    assert (apart.max() > 10 * apart[0]) == grows
    assert may_swing_round(replace(sample.runs[0], time=time, channels=wheels, inputs={}, set={}), known) is grows
