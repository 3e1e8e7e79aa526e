"""Steady turning: gradients by closed form and by differences, limits where statics puts them, the root locus."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.errors import UsageError
from wheelchair_fmu.handling.steady import Gradients, gradients, limits, root_locus, turns
from wheelchair_fmu.handling.trim import Chair, trim
from wheelchair_fmu.model.variant import Variant
from wheelchair_fmu.model.wheelchair import Choice

H = "effect.lateral_load_transfer.h"


def chair(tyre="linear", **values) -> Chair:
    return Chair(Variant(Choice(tyre=tyre)).with_values(values))


def test_gradients_are_the_differences_of_trims_on_either_side():
    c = chair()
    s = trim(c, 1.0, 10.0)
    found, h = gradients(s), 1e-4
    faster, slower = (trim(c, 1.0 + step, radius=s.radius) for step in (h, -h))
    a_y = [t.speed * t.psi_dot for t in (faster, slower)]
    assert found.at_radius == pytest.approx((faster.delta_force - slower.delta_force) / (a_y[0] - a_y[1]), rel=1e-6)
    assert found.of_force == pytest.approx(np.log(faster.delta_force / slower.delta_force) / (2 * h), rel=1e-6)
    more, less = (trim(c, 1.0, 10.0 + step) for step in (h, -h))
    assert found.at_speed == pytest.approx(2 * h / (more.psi_dot - less.psi_dot), rel=1e-6)
    faster, slower = (trim(c, 1.0 + step, 10.0) for step in (h, -h))
    assert found.of_radius == pytest.approx(np.log(faster.radius / slower.radius) / (2 * h), rel=1e-6)


def test_without_drag_a_gentle_turn_has_the_closed_form():
    """m (b + C_mλ/C_λ)/t_r: the CM before the axle, and the pneumatic trail."""
    c = chair(**{"resistance.f_r": 0.0, "resistance.f_f": 0.0})
    assert gradients(trim(c, 1.0, 0.1)).at_radius == pytest.approx(80 * (0.20 + 45 / 5038) / 0.55, rel=1e-3)


def test_a_chair_whose_centre_lies_over_the_axle_is_neutral():
    c = chair(**{"chair.b": 0.001, "tyre.C_m_lambda": 0.0, "effect.scrub_torque.M": 2.0, "effect.scrub_torque.rate": 1e-3})
    assert gradients(trim(c, 1.0, radius=3.0)).character == "neutral"
    assert gradients(trim(chair(), 1.0, radius=3.0)).character == "understeer"
    assert Gradients(-1.0, 1.0, -0.5, -0.5).character == "oversteer"


def test_left_has_the_gradients_of_right():
    right, left = (gradients(trim(chair(), 1.0, force)) for force in (12.0, -12.0))
    for name in ("at_radius", "at_speed", "of_force", "of_radius"):
        assert getattr(left, name) == pytest.approx(getattr(right, name), rel=1e-12)


@pytest.mark.parametrize(("speed", "radius"), [(1.0, np.inf), (0.0, None)])
def test_without_a_turn_there_is_nothing_to_judge(speed, radius):
    state = trim(chair(), speed, None if radius else 5.0, radius)
    with pytest.raises(UsageError, match="no turn to judge"):
        gradients(state)


@pytest.mark.parametrize("right", [True, False])
def test_a_wheel_lifts_where_statics_says(right):
    """m_axle a_y h / t = m_axle g / 2 at the narrower axle: a_y = g t_f / (2 h)."""
    c = chair(**{H: 0.6})
    lift = limits(c, 0.02)[-1]
    end = turns(c, 1.0, [lift], right)
    assert end.limit is lift and abs(end.last.speed * end.last.psi_dot) == pytest.approx(9.81 * 0.45 / 1.2, rel=1e-9)
    assert (end.last.psi_dot > 0) == right


def test_slip_and_friction_limits_are_met_exactly_and_the_first_ends_the_turns():
    c = chair(**{"tyre.mu": 0.8})
    slip, friction = limits(c, np.radians(1.0))  # no height, so that no wheel can lift
    at_slip, at_friction = turns(c, 1.0, [slip]).last, turns(c, 1.0, [friction]).last
    assert max(at_slip.results["slip.rl"], at_slip.results["slip.rr"]) == pytest.approx(np.radians(1.0), rel=1e-7)
    assert at_friction.results["force.F_srr"] == pytest.approx(0.8 * at_friction.results["load.rr"], rel=1e-7)
    both = turns(c, 1.0, [friction, slip])
    assert both.limit is slip and both.last.radius == pytest.approx(at_slip.radius, rel=1e-9)


def test_where_the_tyres_are_spent_the_turns_end():
    end = turns(chair("magic_formula"), 1.0, [])
    assert end.limit is None and "gives no more" in end.why
    forces = [s.delta_force for s in end.states]
    assert forces[-1] == max(forces) and end.last.delta_force == pytest.approx(163.7, abs=5)


def test_the_root_locus_is_that_of_each_speed_alone_and_ends_where_turns_end():
    c = chair()
    speeds = np.linspace(4, 0.5, 8)
    locus = root_locus(c, speeds, 10.0)
    assert [one.trim.speed for one in locus] == pytest.approx(speeds)
    for one in locus:
        alone = root_locus(c, [one.trim.speed], 10.0)[0]
        np.testing.assert_allclose(one.eigenvalues, alone.eigenvalues, rtol=1e-9)
    dugoff = chair("dugoff")
    assert len(root_locus(dugoff, [1.0, 0.5], 10.0)) == 2 and root_locus(dugoff, [1.0], 300.0) == []


def test_backing_up_swivelling_casters_are_unstable():
    c = Chair(Variant().with_values({"effect.caster_trail.c": 0.05}))
    forward, backward = (root_locus(c, [u], 2.0)[0].eigenvalues.real.max() for u in (1.0, -1.0))
    assert forward < 0 < backward
