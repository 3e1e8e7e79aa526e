"""Intervals that allow for effects that nobody named, counted: how often they hold the truth where there are some."""

from __future__ import annotations

import numpy as np
import pytest

from tests.inference.linear import evidence, least_squares, noise, signals, values
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.estimation.interval import NORMAL, half_width, widened
from wheelchair_fmu.inference.estimation.score import Projector, score
from wheelchair_fmu.inference.estimation.unnamed import allowance
from wheelchair_fmu.inference.policy import DEFAULT, Effort
from wheelchair_fmu.quantities import KG, Parameter

CALIBRATED, EFFECTS = ("a", "b"), ("drag", "offset", "gain")
DELTA = np.array([0.5, 2.0, 1.0])
ALONE = {e: e for e in EFFECTS}


def of_a_chair_with_a_little_of_everything(rng, loud: float, replications: int):
    """Fits of two parameters to readings in which three effects have a part that no model has, by how much each estimate
    is off, and what is allowed for that. `loud`: how much more there is to hear."""
    for i in range(replications):
        if i % 10 == 0:
            slopes = [loud * s for s in signals(rng, 3, 300, 5)]
        true = np.concatenate([rng.normal(size=2), DEFAULT.slight * DELTA * rng.normal(size=3)])
        measured = [s @ true + noise(rng, (300, 1)) for s in slopes]
        found = least_squares(measured, [s[..., :2] for s in slopes], CALIBRATED)
        yield found, values(found) - true[:2], allowance(scores(found, slopes), ALONE, 2)


def scores(found, slopes):
    here = evidence([e.r for e in found.evidence.runs], slopes, (*CALIBRATED, *EFFECTS))
    off = Projector(here.S[:, :2], np.zeros((2, 2)))
    two_sided = np.zeros(1, bool)
    return [score(here, off, e, (e,), here.S[:, [2 + i]], DELTA[[i]], two_sided) for i, e in enumerate(EFFECTS)]


@pytest.mark.parametrize("loud", [0.3, 10.0])
def test_intervals_hold_the_truth_though_every_chair_has_a_little_of_everything(loud):
    """Where the data hear nothing of the effects, and where they hear more of them than of noise. Each effect's size is judged
    beside no other, which makes intervals a little wide."""
    plain, told = [], []
    for found, off, allowed in of_a_chair_with_a_little_of_everything(np.random.default_rng(5), loud, 300):
        half = np.array([half_width(found, i) for i in range(2)])
        plain.append(np.abs(off) < half)
        told.append(np.abs(off) < np.hypot(half, NORMAL * np.sqrt(np.diag(allowed))))
    assert 0.93 <= np.mean(told) <= 0.995, np.mean(told)
    assert np.mean(plain) < 0.85 or loud < 1, np.mean(plain)


def one_score(loud: float, size: float, seed: int = 1):
    """Of an effect of this size in δ, and what it adds to an estimate that goes with it in half of what it does."""
    rng = np.random.default_rng(seed)
    slopes = [loud * s for s in signals(rng, 3, 300, 3)]
    slopes = [np.concatenate([s[..., :2], s[..., :1] + s[..., 2:]], axis=-1) for s in slopes]
    true = np.array([0.0, 0.0, size * DELTA[0]])
    found = least_squares([s @ true + noise(rng, (300, 1)) for s in slopes], [s[..., :2] for s in slopes], CALIBRATED)
    here = evidence([e.r for e in found.evidence.runs], slopes, (*CALIBRATED, "drag"))
    return score(
        here, Projector(here.S[:, :2], np.zeros((2, 2))), "drag", ("drag",), here.S[:, [2]], DELTA[:1], np.zeros(1, bool)
    )


def test_what_nobody_can_see_has_the_size_that_every_chair_has():
    s = one_score(1e-3, 0.0)
    (a, _) = np.sqrt(np.diag(allowance([s], ALONE, 2)))
    assert a == pytest.approx(DEFAULT.slight * abs(s.imitated[0, 0]), rel=1e-3)
    assert a > 0.1 * DEFAULT.slight * DELTA[0]


def test_what_the_data_rule_out_is_not_allowed_for_and_what_they_see_is_at_its_size():
    """An estimate that makes up for 0.2 δ is as far off as that."""
    ruled_out, seen = (np.sqrt(allowance([s], ALONE, 2)[0, 0]) for s in (one_score(300.0, 0.0), one_score(300.0, 0.2)))
    there = one_score(300.0, 0.2)
    assert ruled_out < 0.05 * DEFAULT.slight * abs(there.imitated[0, 0])
    assert seen == pytest.approx(0.2 * abs(there.imitated[0, 0]), rel=0.1)


def test_forms_of_one_cause_count_once_and_causes_add_up():
    s = one_score(1e-3, 0.0)
    forms = [s, s, s]
    assert allowance(forms, {"drag": "a drag"}, 2) == pytest.approx(allowance([s], ALONE, 2))
    other = one_score(1e-3, 0.0, seed=2)
    renamed = type(other)(**{**vars(other), "effect": "offset"})
    both = allowance([s, renamed], ALONE, 2)
    assert both == pytest.approx(allowance([s], ALONE, 2) + allowance([renamed], ALONE, 2))
    assert allowance([], ALONE, 2) == pytest.approx(np.zeros((2, 2)))


def test_an_interval_is_widened_by_squares_and_within_bounds():
    record = Parameter("mass", KG, "a mass", default=10.0, lower=6.5, upper=40.0, source="chosen")
    lower, upper = widened((7.0, 14.0), 10.0, 4.0 / NORMAL, record)
    assert (lower, upper) == pytest.approx((6.5, 10 + np.hypot(4, 4)))
    assert widened((5.0, 14.0), 10.0, 0.0, record) == pytest.approx((6.5, 14.0))


@pytest.mark.nightly
def test_a_model_with_as_many_effects_as_are_put_in_is_allowed_for_as_well(sample):
    """Nothing was searched beside it."""
    usual = diagnose(sample)
    found = diagnose(sample, effort=Effort(most_effects=1))
    assert found.included == usual.included and not any(r.effects == found.included for r in found.rounds)
    assert found.allowance == pytest.approx(usual.allowance, rel=0.05)
    assert found.allowance["chair.m"] > 0.1
