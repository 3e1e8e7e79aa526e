"""Steady turns: balanced to rounding, where a simulation ends up, mirrored, and refused in words where there is none."""

from __future__ import annotations

import re
from itertools import pairwise

import numpy as np
import pytest

from tests.model.test_paper import right_hand_sides
from wheelchair_fmu.engine.simulate import Simulator
from wheelchair_fmu.errors import Failure, UsageError
from wheelchair_fmu.handling.trim import Chair, branch, crossing, outside, trim
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import Choice


def chair(equations="extended", effects=(), **values) -> Chair:
    return Chair(Variant(Choice(equations=equations)).with_effects(effects).with_values(values))


@pytest.mark.parametrize(("speed", "delta_force"), [(0.3, 2.0), (1.0, 10.0), (1.0, -40.0), (2.5, 60.0)])
def test_the_papers_own_equations_vanish_there(speed, delta_force):
    s = trim(chair("paper"), speed, delta_force)
    rates, slips, _, _, curvature = right_hand_sides(speed, s.v, s.psi_dot, s.w[0], s.w[1], 0.0, 0.0)
    assert rates == pytest.approx([0, 0, 0], abs=1e-10)
    assert s.w[0] - s.w[1] == pytest.approx(2 * delta_force, rel=1e-14)
    assert s.w[0] + s.w[1] == pytest.approx(s.results["push.total_needed"], rel=1e-12)
    assert [s.results["slip.rl"], s.results["slip.rr"]] == pytest.approx(slips, rel=1e-12)
    assert s.curvature == pytest.approx(curvature, rel=1e-14)


@pytest.mark.parametrize("effects", [(), ("relaxation_length", "caster_trail", "lateral_load_transfer")])
def test_a_simulation_ends_up_there(effects):
    values = {"effect.relaxation_length.sigma": 0.05, "effect.caster_trail.c": 0.05, "effect.lateral_load_transfer.h": 0.6}
    values = {name: v for name, v in values.items() if name.split(".")[1] in effects}
    s = trim(chair(effects=effects, **values), 1.0, 10.0)
    simulator = Simulator(s.chair.variant.with_values({"speed.mode": "prescribed", "speed.u": 1.0}))
    t = np.linspace(0, 20, 2001)
    run = simulator.run(t, simulator.inputs(len(t), {"push.F_rl": 10.0, "push.F_rr": -10.0}), tolerance=1e-10)
    for name in ("chair.v", "chair.psi_dot", "chair.curvature", "slip.rl", "slip.rr", "push.total_needed", "load.rl"):
        assert run[name][-1] == pytest.approx(s.results[name], rel=1e-7), name


def test_left_is_the_mirror_of_right_and_radius_the_inverse_of_force():
    c = chair()
    right, left = trim(c, 1.0, 10.0), trim(c, 1.0, -10.0)
    assert left.v == -right.v and left.psi_dot == -right.psi_dot and left.radius == -right.radius
    for state in (right, left):
        again = trim(c, 1.0, radius=state.radius)
        assert again.delta_force == pytest.approx(state.delta_force, rel=1e-12)
        assert again.radius == pytest.approx(state.radius, rel=1e-14)


def test_straight_on_and_with_wheels_that_lean():
    assert trim(chair(), 1.0, 0.0).radius == np.inf
    leaning = chair(effects=["camber_misalignment"], **{"effect.camber_misalignment.sum": 0.01})
    assert trim(leaning, 1.0, 0.0).radius > 0  # leans to the right, turns to the right
    straight = trim(leaning, 1.0, radius=np.inf)
    assert straight.straight and straight.delta_force < 0


def test_in_reverse_and_on_the_spot():
    backward = trim(chair(), -1.0, 10.0)
    assert backward.psi_dot < 0 and backward.results["push.total_needed"] < 0  # unstable, but steady
    on_the_spot = trim(chair(), 0.0, 8.0)
    assert 0 < on_the_spot.psi_dot < 1e-3  # held by rolling resistance, it creeps


@pytest.mark.parametrize(
    "choice",
    [Choice(tyre="dugoff"), Choice(tyre="magic_formula"), Choice("dugoff", equations="paper"), Choice(equations="paper")],
)
def test_beyond_the_last_steady_turn_the_nearest_is_named_and_exists(choice):
    c = Chair(Variant(choice))
    with pytest.raises(Failure) as refused:
        trim(c, 1.0, 1500.0)
    found = re.search(r"no steady turn at 1 m/s with ΔF = 1500 N: .+; the nearest has ΔF = ([\d.]+) N", str(refused.value))
    assert found, refused.value
    nearest = float(found[1])
    assert trim(c, 1.0, nearest).delta_force == pytest.approx(nearest)
    with pytest.raises(Failure):
        trim(c, 1.0, 1.02 * nearest)


def test_a_radius_that_no_turn_has_names_the_tightest():
    with pytest.raises(Failure, match=r"a radius of 0\.1 m: .*inner one stands still.*; the nearest has ΔF = .* of 0\.3\d+ m"):
        trim(chair("paper"), 1.0, radius=0.1)


def test_on_a_slope_nothing_but_straight_on_is_steady():
    tilted = chair(effects=["floor_slope"], **{"effect.floor_slope.x": 0.02})
    with pytest.raises(Failure, match=r"floor that slopes.*--radius inf"):
        trim(tilted, 1.0, 10.0)
    down = trim(tilted, 1.0, radius=np.inf)
    gravity, level = 80 * 9.81 * np.sin(0.02), trim(chair(), 1.0, 0.0).results["push.total_needed"]
    assert down.results["push.total_needed"] == pytest.approx(level * np.cos(0.02) - gravity)


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"speed": 1.0}, "give one of --delta-force and --radius"),
        ({"speed": 1.0, "delta_force": 1.0, "radius": 2.0}, "give one of --delta-force and --radius"),
        ({"speed": float("nan"), "delta_force": 1.0}, "--speed nan m/s is outside ±20 m/s"),
        ({"speed": 1.0, "delta_force": float("nan")}, "--delta-force nan N is outside ±2000 N"),
        ({"speed": 1.0, "radius": 0.0}, "--radius 0 m is no turn"),
        ({"speed": 1.0, "radius": float("nan")}, "--radius nan m is no turn"),
        ({"speed": 0.0, "radius": 1.0}, "a spin on the spot has no radius to choose"),
    ],
)
def test_what_cannot_be_asked_is_refused(options, sentence):
    with pytest.raises(UsageError) as refused:
        trim(chair(), **options)
    assert sentence in str(refused.value) and "\n" not in str(refused.value)


def test_the_paper_has_no_standstill():
    with pytest.raises(UsageError, match="the paper divides by the forward speed"):
        trim(chair("paper"), 0.0, 1.0)


def test_a_crossing_is_found_between_neighbours():
    before, after = next(pair for pair in pairwise(branch(chair(), 1.0)) if pair[1].results["slip.rr"] > 0.01)
    assert not outside(after)
    found = crossing(before, after, lambda s: s.results["slip.rr"] - 0.01)
    assert found.results["slip.rr"] == pytest.approx(0.01, rel=1e-6)
