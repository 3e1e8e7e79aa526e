"""What orders a force that nobody recorded: what does is told, and where nothing does, nothing is."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.loop.disturbance import strength
from wheelchair_fmu.loop.evidence import Bench
from wheelchair_fmu.loop.fit import Fit
from wheelchair_fmu.loop.unexplained import unexplained
from wheelchair_fmu.model.variant import Variant

from .forces import T_R, ridden, wandering


def left_of(campaign):
    """What the chair of the sample lacks on a campaign, as it is given."""
    bench = Bench(campaign, Variant())
    evidence = bench.evidence(campaign.fit, {}, ())
    needed = strength(evidence, T_R)
    return unexplained(bench, Fit((), {}, np.zeros((0, 0)), evidence, 0.0, np.zeros((0, 0))), needed, needed)


def spring(run, without):
    return 0 * run.time, -2.0 * (without["caster.fl"] + without["caster.fr"]) / 2


def lumpy(run, without):
    """A flat spot: the drag goes up once a turn of the left wheel."""
    angle = np.cumsum(without["sensor.wheel_speed_l"] * np.gradient(run.time)) / 0.31
    return 4 * np.cos(angle), 0 * run.time


def to_one_side(run, without):
    return 0 * run.time, 0.4 + 0 * run.time


@pytest.mark.parametrize(
    ("forces", "of", "by"),
    [(spring, "moment", "caster angle"), (lumpy, "force", "left wheel's angle"), (to_one_side, "moment", "constant")],
)
def test_what_a_force_goes_with_is_told(sample, forces, of, by):
    found = left_of(ridden(sample, np.random.default_rng(1), forces))
    assert found.orders and (found.orders[0].of, found.orders[0].by) == (of, by)
    assert found.orders[0].share > 0.5
    assert any(w.startswith(f"The missing {of} ") for w in found.words)


def test_a_hand_on_the_rim_is_told_by_run_and_time(sample):
    def hand(run, without):
        held = (run.time > 3.4) & (run.time < 4.2) & (run.name == "slalom-slow")
        return -12.0 * held, 1.5 * held

    found = left_of(ridden(sample, np.random.default_rng(2), hand))
    assert {o.by for o in found.orders} == {"run"}
    assert all("run slalom-slow from 2." in o.words or "run slalom-slow from 3." in o.words for o in found.orders)


@pytest.mark.parametrize("seed", [3, 4])
def test_a_floor_is_ordered_by_nothing(sample, seed):
    rng = np.random.default_rng(seed)
    found = left_of(ridden(sample, rng, lambda run, without: (wandering(rng, run.time, 2.5), wandering(rng, run.time, 0.4))))
    assert found.orders == () and found.like_a_floor
    assert "it is nobody's effect" in found.words[1]
    shallow = [f"{found.after.force:.2g} N", f"{found.after.moment:.2g} N m"]
    assert all(figure in found.words[0] for figure in shallow)
