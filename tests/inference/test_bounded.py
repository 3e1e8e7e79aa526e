"""An effect beside values that may go no further: what its lack costs is more than its standard errors say."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import lsq_linear
from scipy.special import logsumexp

from tests.inference.linear import least_squares, noise, signals
from wheelchair_fmu.inference.estimation.marginal import support_of
from wheelchair_fmu.inference.estimation.statistics import bounded, sandwich
from wheelchair_fmu.inference.policy import DEFAULT

FREE = np.full(2, np.inf)


def lack(found, upper=FREE) -> float:
    """What a model without the effect costs."""
    at, size = found.names.index("effect"), found.values["effect"]
    limited = replace(found, lower=-np.inf * np.ones(len(upper)), upper=upper)
    return bounded(limited, [at], np.array([size]), sandwich(found))


@pytest.fixture(scope="module")
def fitted():
    """An effect, and a value that does nearly what it does."""
    rng = np.random.default_rng(3)
    one, other = 40 * signals(rng, 1, 400, 2)[0].transpose(2, 0, 1)
    slopes = [np.stack([one, one + 0.1 * other], axis=-1)]
    return least_squares([slopes[0] @ [1.5, 0.5] + noise(rng, one.shape)], slopes, ("effect", "value"))


def test_without_bounds_it_is_the_size_in_standard_errors_squared(fitted):
    told = fitted.values["effect"] ** 2 / sandwich(fitted)[0, 0]
    assert lack(fitted) == pytest.approx(told, rel=1e-6)


@pytest.mark.parametrize("reach", [0.0, 0.5])
def test_a_value_that_may_go_so_far_leaves_the_rest_to_the_effect(fitted, reach):
    """Of (θ, φ) with the information H and φ off by r at most:  H₁₁ θ² − 2 H₁₂ θ r + H₂₂ r²."""
    H, size, value = np.linalg.inv(sandwich(fitted)), fitted.values["effect"], fitted.values["value"]
    upper = np.array([np.inf, value + reach])
    cost = H[0, 0] * size**2 - 2 * H[0, 1] * size * reach + H[1, 1] * reach**2
    assert lack(fitted, upper) == pytest.approx(cost, rel=1e-5)
    assert cost > 3 * lack(fitted)


def test_a_value_that_nothing_tells_changes_nothing(fitted):
    """As of what no run acts on: its information is zero, and so is its covariance by a pseudo-inverse."""
    runs = tuple(replace(e, S=np.concatenate([e.S, np.zeros_like(e.S[..., :1])], axis=-1)) for e in fitted.evidence.runs)
    names = (*fitted.names, "nothing")
    covariance = np.pad(fitted.covariance, (0, 1))
    more = replace(
        fitted,
        names=names,
        values={**fitted.values, "nothing": 0.0},
        covariance=covariance,
        prior_slopes=np.pad(fitted.prior_slopes, (0, 1)),
        evidence=replace(fitted.evidence, runs=runs, by=names),
    )
    assert lack(more, np.full(3, np.inf)) == pytest.approx(lack(fitted), rel=1e-6)


def drawn(rng):
    """A campaign of one effect beside a value that is known to 1 ± 1 and never below zero, as a friction: its size, covariance
    and fall, what its lack costs within the bound, and the log odds by quadrature that it is large."""
    slopes = rng.normal(size=(120, 2)) * [0.15, 0.03] @ [[1, 1], [0, 1]]
    true = rng.normal() * rng.choice([DEFAULT.large, DEFAULT.slight]), abs(rng.normal(1, 1))
    S, y = np.vstack([slopes, [0, 1]]), np.append(slopes @ true + rng.normal(size=120), 1.0)
    both, alone = (
        lsq_linear(S[:, free], y, bounds=(low, np.inf)) for free, low in ((slice(0, 2), [-np.inf, 0]), (slice(1, 2), 0))
    )
    root = np.linalg.cholesky(S.T @ S).T
    held = lsq_linear(root[:, 1:], root[:, 0] * both.x[0], bounds=(min(-both.x[1], -1e-9), np.inf))
    values, (a, b) = np.linspace(0, 10, 501), slopes.T
    left = y[:-1, None] - b[:, None] * values

    def log_marginal(sd):
        shrunk = 1 / (a @ a + 1 / sd**2)
        return logsumexp(0.5 * (shrunk * (a @ left) ** 2 - np.sum(left**2, axis=0) - (values - 1) ** 2)) + 0.5 * np.log(
            shrunk / sd**2
        )

    odds = log_marginal(DEFAULT.large) - log_marginal(DEFAULT.slight)
    return both.x[:1], np.linalg.inv(S.T @ S)[:1, :1], 2 * (alone.cost - both.cost), 2 * held.cost, odds


def test_the_odds_that_an_effect_is_large_are_those_of_the_integral_over_what_values_may_be():
    """Where the bound is in the way, without it they were off by e^7 in the mean."""
    rng, off = np.random.default_rng(0), []
    for _ in range(400):
        size, covariance, fall, within, odds = drawn(rng)
        if within > 1.3 * size[0] ** 2 / covariance[0, 0]:
            told = [
                support_of("e", size, [covariance], np.ones(1), np.array([False]), fall, 0.0, bounded=b) for b in (0.0, within)
            ]
            off.append([abs(t.large - t.slight - odds) for t in told])
    before, after = np.mean(off, axis=0)
    assert len(off) > 40 and after < 1.5 < 4 < before
