"""What rests on one run: fits without each, against fits that were made without it, and effects that one run alone shows."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.inference.linear import evidence, least_squares, noise, signals, values
from wheelchair_fmu.inference.decision.one_run import _power, resting
from wheelchair_fmu.inference.estimation.left_out import left_out
from wheelchair_fmu.inference.evidence.evidence import Evidence
from wheelchair_fmu.inference.policy import DEFAULT
from wheelchair_fmu.inference.search.candidate import Candidate
from wheelchair_fmu.inference.search.judge import _without
from wheelchair_fmu.inference.search.rounds import Round
from wheelchair_fmu.inference.search.usual import Usual

NAMES = ("known", "other", "effect")
SD = np.array([0.5, 2.0, 1e6])
TRUE, LARGE, DELTA = np.array([0.3, -0.5]), 9.0, 1.5
RUNS = 5


def measured(rng, slopes, sizes):
    """Readings of runs in which the effect has these `sizes`."""
    each = np.broadcast_to(sizes, len(slopes))
    return [s @ np.append(TRUE, size) + noise(rng, s.shape[:2]) for s, size in zip(slopes, each, strict=True)]


def fits(y, slopes, runs=None):
    """The model without the effect, and that with it, of all or of some of the runs."""
    runs = range(len(y)) if runs is None else runs
    y, slopes = [y[i] for i in runs], [slopes[i] for i in runs]
    base = least_squares(y, [s[..., :2] for s in slopes], NAMES[:2], prior_sd=SD[:2])
    return base, least_squares(y, slopes, NAMES, prior_sd=SD)


@pytest.mark.parametrize("which", [0, 1], ids=["without the effect", "with it"])
def test_a_fit_without_one_run_is_what_all_others_give(which):
    """Exact where slopes hold, prior and all."""
    rng = np.random.default_rng(3)
    slopes = signals(rng, RUNS, 200, 3)
    y = measured(rng, slopes, LARGE)
    whole = fits(y, slopes)[which]
    for i, (run, out) in enumerate(left_out(whole).items()):
        alone = fits(y, slopes, [j for j in range(RUNS) if j != i])[which]
        assert run == f"run {i}"
        assert values(whole) + out.moved == pytest.approx(values(alone), abs=1e-9)
        assert out.wider == pytest.approx(np.sqrt(np.diag(alone.covariance) / np.diag(whole.covariance)), rel=1e-9)
        assert out.deviance == pytest.approx(alone.deviance, abs=1e-6)


def test_what_no_run_tells_is_as_little_known_without_any_of_them():
    rng = np.random.default_rng(12)
    slopes = signals(rng, RUNS, 200, 3)
    for s in slopes:
        s[..., 2] = 0.0
    _, found = fits(measured(rng, slopes, 0.0), slopes)
    whole = replace(found, prior_slopes=np.diag([1 / SD[0], 1 / SD[1], 0.0]))
    with np.errstate(all="raise"):
        for out in left_out(whole).values():
            assert out.moved[2] == 0.0 and out.wider[2] == pytest.approx(1.0) and np.all(out.wider[:2] > 1.0)


def candidate(y, slopes):
    base, found = fits(y, slopes)
    size, covariance = values(found)[2:], found.covariance[2:, 2:]
    fall = base.deviance - found.deviance
    without = _without(base, found, Usual(size, [2], np.eye(3)), fall, led=False)
    scale = dict(delta=np.array([DELTA]), one_sided=np.array([False]), dispersion=1.0, correlation=1.0)
    known = dict(p=0.0, gain=None, heldout=None, lawful=True, without_run=without)
    usual = size, covariance, covariance
    return base, Candidate("effect", found, fall, size, 0 * size, covariance, usual, **scale, **known)


def told(y, slopes):
    base, c = candidate(y, slopes)
    r = Round((), base, Evidence((), ()), (), (c,), odds=1 / 30)
    return r, resting([("effect",)], {"effect": r}, ("effect",), DEFAULT)


def test_what_every_run_shows_rests_on_none():
    rng = np.random.default_rng(4)
    slopes = signals(rng, RUNS, 600, 3)
    r, rests = told(measured(rng, slopes, LARGE), slopes)
    assert r.beliefs["effect"].there > 0.9 and rests == ()


def test_what_one_run_alone_could_show_asks_for_another():
    rng = np.random.default_rng(5)
    slopes = signals(rng, RUNS, 600, 3)
    for i in (0, 1, 3, 4):
        slopes[i][..., 2] = 1e-4 * slopes[i][..., 0]
    _, (rests,) = told(measured(rng, slopes, LARGE), slopes)
    assert rests.run == "run 2" and not rests.seen and rests.probability > 0.9 and rests.without < 0.1
    assert rests.words == "effect: only run 2 tells of it; another run like that one would confirm it"


def test_what_other_runs_deny_rests_on_one():
    """A large effect in one run of five, of which the others would show a fifth."""
    rng = np.random.default_rng(6)
    slopes = signals(rng, RUNS, 600, 3)
    _, (rests,) = told(measured(rng, slopes, [0.0, 0.0, 0.0, LARGE, 0.0]), slopes)
    assert rests.run == "run 3" and rests.seen and rests.without < 0.5
    assert "by the other fitted runs, which would show it" in rests.words and "run 3" in rests.words


def test_of_two_runs_one_may_be_what_all_rests_on_and_a_single_one_is_not():
    """Of a single run nobody has to be told that all rests on it."""
    rng = np.random.default_rng(9)
    slopes = signals(rng, 2, 600, 3)
    slopes[1][..., 2] = 1e-4 * slopes[1][..., 0]
    y = measured(rng, slopes, LARGE)
    _, (rests,) = told(y, slopes)
    assert rests.run == "run 0" and not rests.seen
    r, rests = told(y[:1], slopes[:1])
    assert r.beliefs["effect"].there > 0.9 and rests == ()


def test_the_others_would_show_an_effect_that_is_2_8_standard_errors_large_in_four_of_five():
    """Of a test at the 5 % level (Cohen 1988)."""
    rng = np.random.default_rng(11)
    slopes = signals(rng, RUNS, 100, 3)
    _, c = candidate(measured(rng, slopes, LARGE), slopes)
    size, *_ = c.usual
    barely = np.array([[(DELTA / 2.8) ** 2]])
    assert _power(replace(c, usual=(size, barely / 9, barely))) == pytest.approx(0.80, abs=0.002)


def test_what_is_not_there_rests_on_nothing():
    rng = np.random.default_rng(10)
    slopes = signals(rng, RUNS, 600, 3)
    r, rests = told(measured(rng, slopes, 0.0), slopes)
    assert r.beliefs["effect"].there < 0.1 and rests == ()


def test_a_tie_rests_on_a_run_only_with_all_its_members():
    """One of two that do the same is there without any one run: it is not the odds between them that are asked."""
    rng = np.random.default_rng(7)
    slopes = signals(rng, RUNS, 600, 3)
    y = measured(rng, slopes, LARGE)
    base, c = candidate(y, slopes)
    r = Round((), base, Evidence((), ()), (), (c, replace(c, effect="double")))
    assert r.beliefs["effect"].there < 0.6
    assert resting([("effect", "double")], {"effect": r}, ("effect",)) == ()


def test_a_run_without_slopes_says_nothing():
    rng = np.random.default_rng(8)
    slopes = signals(rng, RUNS, 50, 3)
    _, found = fits(measured(rng, slopes, LARGE), slopes)
    bare = replace(found, evidence=evidence([e.r for e in found.evidence.runs], [s[..., :0] for s in slopes], ()))
    assert left_out(bare) == {}
