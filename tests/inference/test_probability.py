"""Probabilities of effects: closed forms, and that they are right as often as they say, in campaigns drawn from the prior."""

from math import log

import numpy as np
import pytest
from scipy import integrate, stats

from wheelchair_fmu.inference.estimation.marginal import support
from wheelchair_fmu.inference.policy import DEFAULT

FREE, POSITIVE = np.array([False]), np.array([True])
LARGE, SLIGHT = DEFAULT.large, DEFAULT.slight


def _likelihood_ratio(size: float, sd: float, width: float, positive: bool) -> float:
    """∫ N(size; θ, sd) prior(θ) dθ / N(size; 0, sd) by quadrature."""

    def integrand(theta: float) -> float:
        prior = stats.norm.pdf(theta, 0, width) * (2 if positive else 1)
        return float(stats.norm.pdf(size, theta, sd) * prior)

    low, near = (0.0 if positive else -40.0), np.clip(size, 0 if positive else -40, 40)
    value, _ = integrate.quad(integrand, low, 40, points=[near, 0.0], limit=400, epsabs=0)
    return value / float(stats.norm.pdf(size, 0, sd))


@pytest.mark.parametrize("positive", [False, True])
@pytest.mark.parametrize(("size", "sd"), [(0.1, 0.05), (1.5, 0.4), (3.0, 1.0), (-0.6, 0.5), (0.0, 1.5)])
def test_marginal_likelihoods_are_integrals(size, sd, positive):
    told = support("e", np.array([size]), np.array([[sd**2]]), POSITIVE if positive else FREE, (size / sd) ** 2)
    assert told.large == pytest.approx(log(_likelihood_ratio(size, sd, LARGE, positive)), abs=1e-6)
    assert told.slight == pytest.approx(log(_likelihood_ratio(size, sd, SLIGHT, positive)), abs=1e-6)


def test_what_nobody_sees_is_as_probable_as_before():
    told = support("e", np.array([0.0, 0.0]), 1e6 * np.eye(2), np.array([False, False]), 0.0)
    assert told.large == pytest.approx(told.slight, abs=1e-4)


def test_larger_than_delta_is_what_the_posterior_has_beyond_it():
    size, sd = 1.4, 0.3
    width = sd**2 + LARGE**2
    mean, spread = size * LARGE**2 / width, sd * LARGE / width**0.5
    beyond = stats.norm.sf(1, mean, spread) + stats.norm.cdf(-1, mean, spread)
    told = support("e", np.array([size]), np.array([[sd**2]]), FREE, (size / sd) ** 2)
    assert told.beyond == pytest.approx(float(beyond), abs=0.02)


def test_held_out_runs_count_as_much_as_fitted_ones():
    one, other = (support("e", np.array([2.0]), np.array([[0.01]]), FREE, 400.0, ahead) for ahead in (0.0, 10.0))
    assert other.large - one.large == pytest.approx(5.0, abs=0.01)


def test_of_effects_that_are_there_with_nine_tenths_nine_tenths_are():
    """Of 4000 effects a fifth are large, measured with standard errors from 0.1 to 2 δ; seed 3."""
    rng, prior = np.random.default_rng(3), 0.2
    said, true = [], []
    for _ in range(4000):
        there = rng.random() < prior
        sd = 0.1 * 20 ** rng.random()
        size = rng.normal(0, LARGE if there else SLIGHT) + rng.normal(0, sd)
        told = support("e", np.array([size]), np.array([[sd**2]]), FREE, (size / sd) ** 2)
        odds = prior / (1 - prior) * np.exp(told.large - told.slight)
        said.append(odds / (1 + odds))
        true.append(there)
    said, true = np.array(said), np.array(true)
    for low, high in ((0.05, 0.3), (0.3, 0.7), (0.7, 0.97)):
        among = (said > low) & (said < high)
        assert among.sum() > 50
        error = np.sqrt(said[among].mean() * (1 - said[among].mean()) / among.sum())
        assert true[among].mean() == pytest.approx(said[among].mean(), abs=3 * error)
