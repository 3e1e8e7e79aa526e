"""In which order candidates stand: by marginal likelihood, so that a second parameter pays for what it chose."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from wheelchair_fmu.loop.diagnose import Candidate, Round, ranked
from wheelchair_fmu.loop.fit import Fit
from wheelchair_fmu.loop.likelihood import Evidence
from wheelchair_fmu.loop.marginal import LARGE
from wheelchair_fmu.loop.probability import _rivals, instead

NONE = Fit((), {}, np.zeros((0, 0)), Evidence((), ()), 0.0, np.zeros(0))


def candidate(effect, fall, estimate, covariance, gain=None, correlation=1.0, dispersion=1.0) -> Candidate:
    """Of sizes in δ; `fall` of squares."""
    known = dict(p=0.0, falls=True, visible=1.0, heldout=None, small=False, large=True, lawful=True)
    one = np.ones(len(estimate))
    scale = dict(delta=one, one_sided=one < 0, dispersion=dispersion, correlation=correlation, gain=gain)
    return Candidate(effect, NONE, fall / dispersion, estimate, covariance, covariance, **scale, **known)


def fitted(effect, slopes, y) -> Candidate:
    covariance = np.linalg.inv(slopes.T @ slopes)
    estimate = covariance @ slopes.T @ y
    return candidate(effect, float(estimate @ slopes.T @ y), estimate, covariance)


def drawn(rng):
    """Slopes (N, k) of an effect of one parameter, and of one of two of which the first does nearly the same; and readings in
    which one of the two effects is, either as often, with its index."""
    n = 200
    a, b, c = (rng.normal(size=n) * size for size in (0.12, 0.02, 0.12))
    slopes = a[:, None], np.stack([a + b, c], axis=1)
    true = int(rng.random() < 0.5)
    return slopes, slopes[true] @ rng.normal(0, LARGE, 1 + true) + rng.normal(size=n), true


def test_odds_between_effects_of_one_and_of_two_parameters_are_right():
    """Of 1200 campaigns; by falls alone the effect of two parameters would be before the other where that is true as well."""
    rng, said, true, larger_fall = np.random.default_rng(5), [], [], []
    for _ in range(1200):
        slopes, y, which = drawn(rng)
        one, two = (fitted(name, S, y) for name, S in zip("ab", slopes, strict=True))
        said.append(1 / (1 + np.exp(one.support.large - two.support.large)))
        first = ranked([one, two])[0]
        assert (first.effect == "b") == (said[-1] > 0.5)
        true.append(which)
        larger_fall.append(two.drop > one.drop)
    said, true, larger_fall = np.array(said), np.array(true), np.array(larger_fall)
    for low, high in ((0.02, 0.2), (0.2, 0.5), (0.5, 0.8), (0.8, 0.98)):
        among = (said > low) & (said < high)
        assert among.sum() > 40
        error = np.sqrt(said[among].mean() * (1 - said[among].mean()) / among.sum())
        assert true[among].mean() == pytest.approx(said[among].mean(), abs=3 * error)
    assert np.mean((said > 0.5) == true) > np.mean(larger_fall == true) + 0.1


def test_what_held_out_runs_say_counts_as_fitted_ones_do():
    certain = np.array([[0.01]])
    ahead, behind = (
        candidate(e, f, np.array([2.0]), certain, gain=(g, 0.0, 0.0)) for e, f, g in (("a", 50.0, 20.0), ("b", 60.0, 0.0))
    )
    assert [c.effect for c in ranked([behind, ahead])] == ["a", "b"]


def test_all_are_judged_by_the_residuals_that_the_likeliest_leaves():
    """One that explains less and leaves less that lasts is not before one that explains more."""
    certain = np.array([[0.01]])
    most, less = (
        candidate(e, f, np.array([4.0]), certain, correlation=t, dispersion=d)
        for e, f, t, d in (("a", 4000.0, 12.0, 2.0), ("b", 3000.0, 6.0, 2.5))
    )
    assert less.support.large > most.support.large, "each by its own"
    first, second = ranked([less, most])
    assert first.effect == "a" and first.scale == second.scale == 24.0
    assert first.support.fitted - second.support.fitted == pytest.approx(1000.0 / 24.0 / 2, abs=0.3)


def test_a_group_may_be_what_a_round_finds():
    certain = 0.01 * np.eye(2)
    alone = candidate("a", 40.0, np.array([2.0]), certain[:1, :1])
    joined = candidate("a+b", 150.0, np.array([2.0, 1.0]), certain)
    evidence = Evidence((), ())
    r = Round((), NONE, evidence, (), (alone,), groups=(joined,))
    assert r.winner.effect == "a+b"
    assert replace(r, groups=(replace(joined, drop=42.0),)).winner.effect == "a"
    assert replace(r, groups=(replace(joined, large=False, small=True),), candidates=()).winner is None


def test_a_group_is_as_probable_as_an_effect_of_as_many_parameters():
    certain = 0.16 * np.eye(2)
    lone = candidate("c", 36.0, np.array([2.4]), certain[:1, :1])
    joined, other = (candidate(e, 40.5, np.array([1.8, 1.8]), certain) for e in ("a+b", "d"))
    r = Round((), NONE, Evidence((), ()), (None,) * 12, (lone,), groups=(joined,))  # scores only count here
    by = instead(_rivals(r, "c", {"c"}))
    assert 0.02 < by["a+b"].there < by["c"].there
    as_one = instead(replace(r, candidates=(lone, other), groups=()))
    assert by["a+b"].there == pytest.approx(as_one["d"].there) and by["c"].there == pytest.approx(as_one["c"].there)
    assert set(instead(_rivals(r, "c", {"c", "b"}))) == {"c"}, "a member was found beside it"
