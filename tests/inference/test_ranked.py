"""In which order candidates stand: by marginal likelihood, so that a second parameter pays for what it chose."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import special

from tests.inference.linear import evidence
from wheelchair_fmu.inference.decision import decide
from wheelchair_fmu.inference.estimation.problem import Fit
from wheelchair_fmu.inference.evidence.evidence import Evidence
from wheelchair_fmu.inference.policy import DEFAULT
from wheelchair_fmu.inference.search.candidate import Candidate, ranked
from wheelchair_fmu.inference.search.probability import _rivals
from wheelchair_fmu.inference.search.refitting import risen
from wheelchair_fmu.inference.search.rounds import Round, instead
from wheelchair_fmu.inference.search.ties import probable

NONE = Fit((), {}, np.zeros((0, 0)), Evidence((), ()), 0.0, np.zeros(0))


def candidate(effect, fall, estimate, covariance, gain=None, correlation=1.0, dispersion=1.0, by_errors=False) -> Candidate:
    """Of sizes in δ; `fall` of squares."""
    known = dict(p=0.0, heldout=None, lawful=True, by_errors=by_errors)
    one = np.ones(len(estimate))
    scale = dict(delta=one, one_sided=one < 0, dispersion=dispersion, correlation=correlation, gain=gain)
    usual = estimate, covariance, covariance
    return Candidate(effect, NONE, fall / dispersion, estimate, 0 * estimate, covariance, usual, **scale, **known)


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
    return slopes, slopes[true] @ rng.normal(0, DEFAULT.large, 1 + true) + rng.normal(size=n), true


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
        larger_fall.append(two.likelihood_ratio > one.likelihood_ratio)
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


def test_odds_are_right_where_standard_errors_allow_for_residuals_that_last():
    """Of 2000 effects, slight or large, whose fall is their size in standard errors that allow for everything: what lasts in
    the residuals says no more of them."""
    rng, error = np.random.default_rng(8), 0.5
    large = rng.random(2000) < 0.5
    found = rng.normal(0, np.where(large, DEFAULT.large, DEFAULT.slight)) + rng.normal(0, error, 2000)
    some = (
        candidate("a", (x / error) ** 2, np.array([x]), np.array([[error**2]]), correlation=8.0, dispersion=0.7, by_errors=True)
        for x in found
    )
    said = np.array([special.expit(c.support.large - c.support.slight) for c in some])
    for low, high in ((0.1, 0.3), (0.3, 0.7), (0.7, 0.99)):
        among = (said > low) & (said < high)
        assert among.sum() > 60
        assert large[among].mean() == pytest.approx(said[among].mean(), abs=3 * np.sqrt(0.25 / among.sum()))


def test_a_fall_by_standard_errors_is_no_more_than_runs_agree_on():
    """What runs would have apart by much more than their moments say is as little sure as they have it."""
    size, tight, wide = np.array([6.5]), np.array([[0.27]]), np.array([[4.9]])
    alike = candidate("a", 6.5**2 / 0.27, size, tight, by_errors=True)
    apart = replace(alike, usual=(size, tight, wide))
    assert alike.fall == pytest.approx(6.5**2 / 0.27) and apart.fall == pytest.approx(6.5**2 / 4.9)
    assert alike.support.large > 50 > 5 > apart.support.large


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
    assert replace(r, groups=(replace(joined, likelihood_ratio=42.0),)).winner.effect == "a"
    slight = replace(joined, estimate=0.3 * joined.estimate, usual=(0.3 * joined.estimate, certain, certain))
    assert replace(r, groups=(slight,), candidates=()).winner is None
    assert replace(r, groups=(replace(joined, stretched=True),), candidates=()).winner is None
    assert replace(r, groups=(replace(joined, lawful=False),), candidates=()).winner is None


def test_what_surely_worsens_held_out_runs_is_never_found():
    certain = np.array([[0.01]])
    evidence = Evidence((), ())
    for gain, found in (((-5.0, -8.0, 1.0), True), ((-5.0, -8.0, -1.0), False)):
        r = Round((), NONE, evidence, (), (candidate("a", 400.0, np.array([2.0]), certain, gain=gain),))
        assert (r.winner is not None) == bool(r.slight) == found


def test_a_group_is_as_probable_as_an_effect_of_as_many_parameters():
    certain = 0.16 * np.eye(2)
    lone = candidate("c", 36.0, np.array([2.4]), certain[:1, :1])
    joined, other = (candidate(e, 40.5, np.array([1.8, 1.8]), certain) for e in ("a+b", "d"))
    r = Round((), NONE, Evidence((), ()), (None,) * 12, (lone,), groups=(joined,))  # scores only count here
    by = instead(r, _rivals(r, "c", {"c"}))
    assert 0.02 < by["a+b"].there < by["c"].there
    as_one = instead(r, (lone, other))
    assert by["a+b"].there == pytest.approx(as_one["d"].there) and by["c"].there == pytest.approx(as_one["c"].there)
    assert set(instead(r, _rivals(r, "c", {"c", "b"}))) == {"c"}, "a member was found beside it"


@pytest.mark.parametrize(
    ("size", "found"), [(0.5, False), (0.8, False), (0.85, False), (0.95, True), (-0.95, True), (4.0, True)]
)
def test_an_effect_is_found_from_where_it_is_likelier_large_than_slight(size, found):
    """Known to a twentieth of δ, in a catalogue of thirty."""
    known = candidate("a", (size / 0.05) ** 2, np.array([size]), np.array([[0.05**2]]))
    r = Round((), NONE, Evidence((), ()), (None,) * 30, (known,))
    assert (r.winner is not None) == found
    assert (r.winner is not None) == (r.beliefs["a"].there > 0.5)
    assert r.slight == [known], "however small, it is surely there"
    assert found or (decide.slight(r) == ("a",) and decide.instead_of_small(r) == ()), "one or the other, and never neither"
    assert replace(r, odds=1e-4).winner is None or size == 4.0


def test_a_small_size_that_explains_much_is_slight():
    """Runs disagree about a fifth of δ by some hundredths, and yet it explains far more than that says: what is foretold of
    runs held out does not make it large."""
    known = candidate("a", 1150.0, np.array([0.22]), np.array([[0.06**2]]), gain=(1300.0, 800.0, 1800.0))
    assert known.support.slight > known.support.large and not known.matters
    wide = candidate("a", 7500.0, np.array([2.8]), np.array([[1.1**2]]), gain=(7000.0, 800.0, 1800.0))
    assert wide.matters, "neither do wide standard errors make slight what is not"


def test_what_another_effect_explains_by_being_slight_is_no_large_one():
    """A fifth of δ of one effect does what three δ of another nearly do."""
    slight = candidate("a", 100.0, np.array([0.2]), np.array([[0.02**2]]))
    large = candidate("b", 90.0, np.array([3.0]), np.array([[0.3**2]]))
    r = Round((), NONE, Evidence((), ()), (None,) * 30, tuple(ranked([slight, large])))
    assert r.winner is None and r.slight[0].effect == "a"
    assert replace(r, candidates=(large,)).winner.effect == "b"
    assert decide.instead_of_small(r) == ()
    near = replace(large, likelihood_ratio=98.0)
    (said,) = decide.instead_of_small(replace(r, candidates=tuple(ranked([slight, near]))))
    assert said.words.startswith("b would do as well, and would not be small: 3.0 times what is of interest; the odds are ")


def test_what_is_found_is_there_as_often_as_it_says():
    """Of 900 campaigns with twenty effects, of which one is large in half of them and all others are slight, each known to
    between a tenth of δ and three δ."""
    rng, said, right, false = np.random.default_rng(4), [], [], 0
    for campaign in range(900):
        sd, true = 0.1 * 30 ** rng.random(20), rng.normal(0, DEFAULT.slight, 20)
        if there := campaign % 2:
            true[0] = rng.normal(0, DEFAULT.large)
        estimate = true + rng.normal(0, sd)
        pairs = enumerate(zip(estimate, sd, strict=True))
        tried = [candidate(str(i), (e / s) ** 2, np.array([e]), np.array([[s * s]])) for i, (e, s) in pairs]
        r = Round((), NONE, Evidence((), ()), (None,) * 20, tuple(ranked(tried)))
        if r.winner:
            false += not there
            said.append(r.beliefs[r.winner.effect].there)
            right.append(r.winner.effect == "0" and there)
    assert len(said) > 150 and false < 0.05 * 450
    error = np.sqrt(np.mean(right) * (1 - np.mean(right)) / len(said))
    assert np.mean(right) == pytest.approx(np.mean(said), abs=3 * error)


def test_what_is_as_little_as_a_laws_error_is_nobodys_effect():
    """Beside an effect that explained so much that a fiftieth of what it does leaves 60 of squares."""
    known = candidate("a", 50.0, np.array([3.0]), np.array([[0.4**2]]))
    r = Round((), NONE, Evidence((), ()), (None,) * 30, (known,))
    assert r.winner is known and replace(r, explained=1e4).winner is known
    assert replace(r, explained=1.5e5).winner is None and not replace(r, explained=1.5e5).slight


def test_what_readings_cannot_see_is_as_probable_as_it_was_beforehand():
    """Beside a large effect that was found, too: laws that are not exact can only take from what is gained."""
    blind = candidate("a", 0.0, np.array([0.0]), np.array([[1e6]]))
    hardly = candidate("a", 5.4, np.array([1.3]), np.array([[1.7**2]]))  # likelier slight than large, by a little
    for c, expected in ((blind, 1 / 33), (hardly, 0.0155)):
        for explained in (0.0, 3.5e4):
            r = Round((), NONE, Evidence((), ()), (None,) * 33, (c,), explained=explained)
            assert r.beliefs["a"].there == pytest.approx(expected, rel=0.01) and r.winner is None


def test_what_is_perhaps_nothing_is_not_found():
    """Six deltas, at two and a half standard errors, of one of thirty."""
    known = candidate("a", 6.25, np.array([6.0]), np.array([[2.4**2]]))
    r = Round((), NONE, Evidence((), ()), (None,) * 30, (known,))
    assert r.present["a"] < DEFAULT.sure and r.winner is None and not r.slight


def test_what_was_found_is_named_as_long_as_it_or_its_rivals_are_probable():
    """Two that explain as much are there together, though neither is by itself; what others made needless is not."""
    certain = np.array([[0.01]])
    alike = tuple(candidate(e, 60.0, np.array([2.0]), certain) for e in "abc")
    r = Round((), NONE, Evidence((), ()), (), tuple(ranked(alike)))
    assert max(b.there for b in r.beliefs.values()) < 0.5 and all(probable(r, e) for e in "abc")
    needless = Round(("x",), NONE, Evidence((), ()), (), (candidate("a", 3.0, np.array([0.2]), certain),), again=True)
    assert not probable(needless, "a")


@pytest.mark.parametrize(
    ("before", "after", "rises"),
    [(0.88, 0.99, False), (0.88, 1.2, True), (0.99, 1.03, True), (1.03, 1.05, False), (2.0, 2.1, False), (2.0, 2.3, True)],
)
def test_an_error_that_comes_to_the_noise_has_not_risen(before, after, rises):
    """Whatever is below the noise is there by errors of the pushes, and is no gain that another effect could lose."""
    one, other = (
        replace(NONE, evidence=evidence([np.full((50, 1), rms)], [np.zeros((50, 1, 0))], ())) for rms in (before, after)
    )
    assert risen(one, other, DEFAULT, led=False) == rises
    assert risen(one, other, DEFAULT, led=True) == (after > 1.1 * max(1.0, before)), "forces are what leaves nothing"
