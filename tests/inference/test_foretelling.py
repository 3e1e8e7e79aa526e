"""How likely a fit made the runs that were held out: closed forms, and how often it says what is true."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from benchmarks.independent.campaigns import make
from tests.inference.linear import evidence, least_squares, noise, signals, values
from wheelchair_fmu.campaign import read
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.estimation.foretelling import foretold_by
from wheelchair_fmu.inference.estimation.problem import Fit
from wheelchair_fmu.inference.estimation.statistics import difference_blocks, held_out_gain
from wheelchair_fmu.inference.evidence.evidence import Evidence, FilterSummary

NAMES = ("a", "b", "c")
LONG = 500  # samples of a run: two blocks and a half
SIZE = 0.8  # of what is there, or not


def fitted(rng: np.random.Generator, true: np.ndarray) -> Fit:
    """Of small signals, so that much is left unknown."""
    slopes = [0.05 * s for s in signals(rng, 1, LONG, len(true))]
    return least_squares([s @ true + noise(rng, (LONG, 1)) for s in slopes], slopes, NAMES)


def told(held: Evidence) -> float:
    return sum(float(e.foretelling.sum()) for e in held.runs if e.foretelling is not None)


def drawn(seed: int = 0, gaps: bool = False) -> tuple[Fit, Evidence]:
    rng = np.random.default_rng(seed)
    found = fitted(rng, np.array([1.0, -2.0, 0.5]))
    slopes = signals(rng, 2, LONG, 3)
    read = [noise(rng, (LONG, 1)) + s @ np.array([0.1, 0.2, -0.1]) for s in slopes]
    if gaps:
        read[0][7:90] = np.nan
        read[1][-1] = np.nan
    return found, evidence(read, slopes, NAMES)


@pytest.mark.parametrize("gaps", [False, True])
@pytest.mark.parametrize("precision", [0.0, 0.3])
def test_the_blocks_of_all_runs_add_up_to_a_normal_density(gaps, precision):
    """Of all innovations at once, about zero, with the values' own covariance in it."""
    found, held = drawn(1, gaps)
    prior = np.array([0.0, 0.0, precision])
    covariance = np.linalg.inv(np.linalg.inv(found.covariance) + np.diag(prior))
    r, S = held.r, held.S
    density = stats.multivariate_normal(np.zeros(len(r)), np.eye(len(r)) + S @ covariance @ S.T).logpdf(r)
    filters = sum(e.whitener.logdet for e in held.runs)
    assert told(foretold_by(found, held, prior)) == pytest.approx(-2 * density - len(r) * np.log(2 * np.pi) + filters, rel=1e-9)


def test_what_a_filter_expects_less_noise_by_is_shared_by_its_blocks():
    found, held = drawn(2)
    narrower = Evidence(
        tuple(replace(e, whitener=FilterSummary(e.whitener.logdet - 30.0, e.whitener.spread)) for e in held.runs), NAMES
    )
    none = np.zeros(3)
    assert difference_blocks(foretold_by(found, held, none), foretold_by(found, narrower, none)) == pytest.approx(
        np.full(6, 10.0)
    )


def test_values_that_are_known_leave_the_squares_as_they_are():
    found, held = drawn(3)
    known = replace(found, covariance=1e-24 * np.eye(3))
    squares = float(held.r @ held.r) + sum(e.whitener.logdet for e in held.runs)
    assert told(foretold_by(known, held, np.zeros(3))) == pytest.approx(squares)


def test_a_value_that_no_fitted_run_shows_and_no_prior_knows_stays_where_it_is():
    """Its information is nothing, and its variance counts as none: held-out runs are not what it is fitted on."""
    found, held = drawn(4)
    unseen = np.diag([0.01, 0.01, 0.0])
    fewer = replace(found, names=NAMES[:2], covariance=unseen[:2, :2])
    assert told(foretold_by(replace(found, covariance=unseen), held, np.zeros(3))) == pytest.approx(
        told(foretold_by(fewer, held.only(fewer.names), np.zeros(2)))
    )


def test_what_a_fit_could_not_know_gives_a_held_out_gain_to_nobody():
    """A value of which fitted runs show little, and held-out runs much, is off by chance; something that is not there, and does
    nearly the same there, makes up for it. By squares alone it would gain or lose more than decisive odds."""
    rng = np.random.default_rng(5)
    gains, squares = [], []
    for _ in range(200):
        slopes = signals(rng, 1, LONG, 2)
        slopes[0][:, :, 0] *= 0.02
        true = np.array([rng.normal(), 0.0])
        read = [s @ true + noise(rng, (LONG, 1)) for s in slopes]
        with_it = least_squares(read, slopes, NAMES[:2])
        without = least_squares(read, [s[:, :, :1] for s in slopes], NAMES[:1])
        there = signals(rng, 1, LONG, 1)
        both = [np.concatenate([s, 0.7 * s], axis=2) for s in there]
        measured = [s @ true + noise(rng, (LONG, 1)) for s in both]
        models = []
        for found in (without, with_it):
            k = len(found.names)
            left = [m - s[:, :, :k] @ values(found) for m, s in zip(measured, both, strict=True)]
            models.append((found, evidence(left, [s[:, :, :k] for s in both], found.names)))
        plain = [float(held.r @ held.r) for _, held in models]
        squares.append(abs(plain[0] - plain[1]))
        gains.append(held_out_gain(*(foretold_by(found, held, np.zeros(len(found.names))) for found, held in models))[0])
    assert np.mean(squares) > 20 > 10 * abs(np.mean(gains)), (np.mean(squares), np.mean(gains))


def test_the_odds_that_held_out_runs_give_are_those_that_come_true():
    """Of two models that are as likely beforehand, the one with more in it is right as often as its odds say."""
    rng = np.random.default_rng(6)
    says, is_so = np.zeros(2000), np.arange(2000) % 2 == 1
    for i, there in enumerate(is_so):
        slopes = signals(rng, 1, LONG, 2)[0]
        read = slopes @ np.array([rng.normal(), SIZE * there]) + noise(rng, (LONG, 1))
        models = []
        for size in (0.0, SIZE):
            left = evidence([read - slopes[:, :, 1:] @ [size]], [slopes], NAMES[:2])
            found = Fit(NAMES[:2], {"a": 0.0, "b": size}, np.diag([1.0, 0.0]), left, 0.0, np.zeros((2, 2)))
            models.append(foretold_by(found, left, np.zeros(2)))
        says[i] = 1 / (1 + np.exp(-difference_blocks(*models).sum() / 2))
    for low in (0.0, 0.2, 0.4, 0.6, 0.8):
        inside = (low <= says) & (says < low + 0.2)
        assert inside.sum() > 100
        assert abs(is_so[inside].mean() - says[inside].mean()) < 3 * np.sqrt(0.25 / inside.sum()), low


def test_of_a_chair_that_only_went_straight_nothing_is_found_by_how_it_turned_elsewhere(tmp_path):
    """Nothing is missing from this one, and its fitted runs tell little of how it turns. That one effect or another would have
    foretold the held-out turns better, by chance, is no reason to call it missing."""
    campaign = read(make(tmp_path / "null", {}, seed=4, measured=1.0))
    straight = [r for r in campaign.runs if r.role == "holdout" or r.name in ("coast-down", "straight-strokes")]
    found = diagnose(replace(campaign, runs=tuple(straight)))
    assert found.verdict == "cannot_see" and not found.effects
    assert found.ladder[-1].heldout > 1.3 and any('role = "fit"' in note for note in found.notes), "it says which run to fit"
