"""Who foretells held-out runs worse than the calibrated model is said, and all models are held against the same readings."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace as Some

import numpy as np
import pytest

from tests.inference.linear import evidence
from wheelchair_fmu.errors import SimulationError
from wheelchair_fmu.inference.decision.foretold import on_led_runs, raised, untold, worse, worsened
from wheelchair_fmu.inference.residual.physical import ChannelError
from wheelchair_fmu.inference.residual.staircase import Step
from wheelchair_fmu.inference.search import selection


def step(name: str, **off: float) -> Step:
    """A step whose model is off by so much (SI), by channel, in each of two held-out runs of other lengths."""
    runs = {f"run {n}": {c: ChannelError.of(c, np.zeros(n), np.full(n, by)) for c, by in off.items()} for n in (10, 30)}
    return Step(name, 1.2, 1.1, {}, runs)


def test_a_channel_that_the_last_model_foretells_worse_is_said():
    ladder = [
        step("nominal", yaw_rate=0.001),
        step("calibrated", yaw_rate=0.02, u=0.023),
        step("+drag", yaw_rate=0.01, u=0.028),
    ]
    (told,) = worsened(ladder)
    assert told.startswith("u: ") and "0.028 m/s" in told and "0.023" in told


@pytest.mark.parametrize(("after", "said"), [(0.0249, 0), (0.0256, 1), (0.01, 0)])
def test_a_little_worse_is_not_worse(after, said):
    assert len(worsened([step("nominal"), step("calibrated", u=0.023), step("+drag", u=after)])) == said


@pytest.mark.parametrize(("after", "said"), [(1.01, 0), (1.2, 1)])
def test_a_position_that_is_further_off_by_chance_is_not_worse(after, said):
    """A walk of 15 s ends 3 cm off instead of 1.5 by what pushes the chair: innovations have it that the marker was found."""
    before, last = (
        replace(step(name, x=x), heldout_whitened={"x": w}) for name, x, w in (("c", 0.0145, 1.04), ("+m", 0.0295, after))
    )
    assert len(worsened([step("nominal"), before, last])) == said


@pytest.mark.parametrize(
    ("off", "noise", "said"),
    [
        (0.02, 0.003, 1),  # a heading that wanders as far as the model's, which is ten times what the sensor's noise is
        (0.02, 0.015, 0),  # there is nothing to foretell but noise
        (0.01, 0.003, 0),  # half of what a constant leaves
    ],
)
def test_a_channel_that_is_foretold_no_better_than_by_a_constant_is_said(off, noise, said):
    moving = np.tile([0.02, -0.02], 20)
    step = Step("+drag", 1.0, 1.0, {}, {"run": {"yaw": ChannelError.of("yaw", moving, moving - off)}})
    told = untold(step, {"yaw": noise})
    assert len(told) == said and all("a constant for each run by 1.15" in words for words in told)


def test_where_nothing_was_put_in_or_held_out_nothing_is_said():
    assert not worsened([step("nominal", u=0.01), step("calibrated", u=0.5)])
    assert not worsened([Step("nominal", 2.0, np.nan), Step("calibrated", 1.2, np.nan), Step("+drag", 1.0, np.nan)])


@pytest.mark.parametrize(
    ("fit", "heldout", "said"),
    [
        (4.2, 4.2, ["fitted runs from 3.80 to 4.20"]),
        (4.2, 5.0, ["fitted runs from 3.80 to 4.20", "held-out runs from 4.30 to 5.00"]),
        (3.0, 4.7, []),
        (1.05, np.nan, []),
    ],
)
def test_calibration_that_raises_errors_is_said(fit, heldout, said):
    told = raised([Step("nominal", 3.8, 4.3), Step("calibrated", fit, heldout), Step("+drag", 1.0, 1.0)])
    assert len(told) == bool(said) and all(part in told[0] for part in said)


def test_calibration_that_leaves_noise_raises_nothing():
    assert not raised([Step("nominal", 0.9, 0.9), Step("calibrated", 1.05, 1.05)])


@pytest.mark.parametrize(
    ("after", "is_worse"),
    [
        (dict(u=0.025, yaw_rate=0.02), True),  # a quarter more of both
        (dict(u=0.021, yaw_rate=0.017), False),  # a twentieth
        (dict(u=0.03, yaw_rate=0.0107), False),  # half as much more of one, and two thirds of the other: as good, all in all
        (dict(u=0.03, yaw_rate=0.014), True),
    ],
)
def test_a_model_is_worse_by_all_its_channels_together(after, is_worse):
    assert worse(step("calibrated", u=0.02, yaw_rate=0.016), step("+drag", **after)) == is_worse


def test_without_held_out_runs_nothing_is_worse():
    assert not worse(Step("calibrated", 1.2, np.nan), Step("+drag", 1.0, np.nan))


def test_a_position_that_drifts_by_chance_makes_nothing_worse():
    before, last = (
        replace(step(name, x=x), heldout_whitened={"x": w}) for name, x, w in (("c", 0.0145, 1.04), ("+m", 0.0295, 1.01))
    )
    assert not worse(before, last)


def led(fails: bool = False) -> Some:
    """A search among forces whose simulations are off by what its values say."""

    def errors(runs, values):
        if fails:
            raise SimulationError("beyond all numbers")
        return evidence([np.full((5, 1), values["off"])] * len(runs), [np.zeros((5, 1, 0))] * len(runs), ())

    return Some(campaign=Some(fit=(1, 2), holdout=(3,)), likelihood=lambda effects: Some(evidence=errors))


def test_the_calibrated_model_is_held_against_the_readings_of_the_others():
    before = step("calibrated", yaw_rate=0.5)
    after = on_led_runs(before, {"off": 0.25}, led())
    assert (after.name, after.fit, after.heldout) == (before.name, before.fit, before.heldout)
    assert len(after.fit_errors) == 2 and len(after.heldout_errors) == 1
    assert on_led_runs(before, {"off": 0.25}, led(fails=True)) is before


@pytest.mark.parametrize(
    ("sizes", "helping", "parts", "expected"),
    [
        ({"a": 2.0, "b": 0.6}, (), ("a", "b"), ("a",)),  # of a group, what is large
        ({"a": 0.6, "b": 0.6}, (), ("a", "b"), ("a", "b")),  # which is large together
        ({"a": 2.0, "b": 0.6}, (), (), ("a", "b")),  # none of a group: found by itself
        ({"a": 2.0, "b": 0.6}, ("b",), (), ("a",)),  # slight
        ({"a": 2.0, "b": 0.8}, ("b",), (), ("a", "b")),  # helped, and is large beside the others
    ],
)
def test_what_is_named_of_what_is_in_a_model(monkeypatch, sizes, helping, parts, expected):
    monkeypatch.setattr(selection, "surely_large", lambda models, found, e: sizes[e] > 0.7)
    top = Some(effects=("old", *sizes), fit=None)
    found = selection.Selection(None, top, (), 0.0, print, already=("old",), helping=frozenset(helping), parts=frozenset(parts))
    assert found.named() == expected
