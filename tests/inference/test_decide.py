"""A verdict follows from what a search found and what it left, and from the policy, and from nothing else."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from wheelchair_fmu.inference.decision.ahead import Ahead
from wheelchair_fmu.inference.decision.decide import Facts, decide, insufficient, share_seen
from wheelchair_fmu.inference.estimation.problem import Fit
from wheelchair_fmu.inference.evidence.evidence import Evidence
from wheelchair_fmu.inference.policy import DEFAULT
from wheelchair_fmu.inference.residual.staircase import Step
from wheelchair_fmu.inference.search.rounds import Round
from wheelchair_fmu.model.effects import bundled


def facts(**what) -> Facts:
    """Of a search that found nothing, and could have seen everything."""
    none = np.zeros(0)
    nothing = Evidence((), ())
    first = Round((), Fit((), {}, none, nothing, 0.0, none), nothing, (), ())
    ladder = (Step("nominal", 2.0, 2.0), Step("calibrated", 1.0, 1.0))
    usual = {"effects": (), "ties": (), "first": first, "ladder": ladder, "proposed": False, "lasts": 1.0, "rms": 1.0}
    usual |= {"forced": False, "worst": 1.1, "ahead": Ahead(), "strained": (), "likely": {}, "powers": {"a": 0.9}}
    usual |= {"causes": {"a": "a"}}
    return Facts(**(usual | what))


@pytest.mark.parametrize(
    ("what", "verdict"),
    [
        ({}, "adequate"),
        ({"powers": {"a": 0.7}}, "cannot_see"),
        ({"likely": {"a": 0.6}}, "cannot_see"),
        ({"effects": ("a",)}, "missing"),
        ({"effects": ("a",), "ties": (("a", "b"),)}, "tie"),
        ({"effects": ("a",), "strained": ("chair.a",)}, "outside"),
        ({"effects": ("a",), "proposed": True}, "outside"),
        ({"effects": ("a",), "forced": True}, "outside"),
        ({"forced": True}, "outside"),
        ({"effects": ("a",), "ladder": (Step("n", 3.0, 3.0), Step("c", 1.5, 1.5), Step("+a", 1.4, 1.4))}, "outside"),
        ({"effects": ("a",), "lasts": 3.0, "ladder": (Step("n", 3, 3), Step("c", 1.3, 1.3), Step("+a", 1.2, 1.2))}, "outside"),
        ({"effects": ("a",), "lasts": 1.0, "ladder": (Step("n", 3, 3), Step("c", 1.3, 1.3), Step("+a", 1.2, 1.2))}, "missing"),
        ({"lasts": 3.0, "worst": 2.2}, "outside"),
        ({"lasts": 1.0, "worst": 2.2}, "adequate"),
    ],
)
def test_a_verdict_follows_from_facts_alone(what, verdict):
    assert decide(facts(**what)) == verdict


def test_a_verdict_moves_with_the_policy():
    left = facts(effects=("a",), ladder=(Step("n", 3.0, 3.0), Step("c", 1.5, 1.5), Step("+a", 1.25, 1.25)))
    assert decide(left) == "missing" and decide(left, replace(DEFAULT, unexplained=1.2)) == "outside"
    assert decide(facts(powers={"a": 0.75}), replace(DEFAULT, power=0.7)) == "adequate"


@pytest.mark.parametrize(
    ("calibrated", "top", "expected"),
    [
        ((1.281, 1.219), (1.238, 1.184), True),  # a delay of the record, called caster inertia where the catalogue lacks it
        ((1.1, 1.127), (1.082, 1.112), True),  # slip of the driven wheels, called a gyro's scale
        (
            (1.565, 1.565),
            (1.064, 1.116),
            False,
        ),  # a trail that was hidden: another simulator's casters swing a little otherwise
        ((1.08, 1.05), (1.05, 1.04), False),  # little was left to begin with
        ((1.05, 1.09), (1.051, 1.088), True),  # an accelerometer off the middle, called load transfer: nothing fell
        ((1.857, 2.252), (1.132, 1.391), True),  # drag beyond a speed, called drag by its square: held-out runs know better
        ((1.02, 1.02), (1.019, 1.019), False),  # about all that was left is noise
        ((9.0, 8.0), (1.4, 1.35), True),
        ((9.0, float("nan")), (1.2, float("nan")), False),  # nothing held out
    ],
)
def test_effects_that_leave_much_of_what_they_were_to_explain_do_not_suffice(calibrated, top, expected):
    ladder = [Step("nominal", 10.0, 10.0), Step("calibrated", *calibrated), Step("+effect", *top)]
    assert insufficient(ladder) == expected


def test_another_form_of_a_cause_makes_no_catalogue_larger():
    """Of four causes two are seen, and one in one of its four forms."""
    forms = ("scrub_torque", "scrub_torque_viscous", "turn_slip", "pivot_torque")
    seen = {"gyro_bias": True, "toe_misalignment": True, "wheel_inertia": False} | {
        form: form == "scrub_torque" for form in forms
    }
    causes = {effect: record.cause for effect, record in bundled().items()}
    assert share_seen(seen, causes) == pytest.approx((1 + 1 + 0 + 1 / 4) / 4)
    assert share_seen({}, causes) == 0
