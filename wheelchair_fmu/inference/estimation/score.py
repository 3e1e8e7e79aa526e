"""Which effects would help, from one linearisation: score tests with a robust variance.

For an effect with sensitivities S_j (N, k) the calibrated directions are projected off, s_j = P S_j; score
U = s_jᵀ r, information I = s_jᵀ s_j, expected change I⁻¹ U, expected fall Uᵀ I⁻¹ U. The variance of U is
estimated with heteroscedasticity and autocorrelation (Bartlett's kernel within each run, prewhitened), so that
coloured residuals are not taken for evidence.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ..chance import chance_beyond, power
from ..evidence.evidence import Evidence
from .inverse import inverse

LASTING = 0.97  # AR(1) coefficient, at most, by which a variance is recoloured
LAG = 0.5  # s over which residuals may be correlated
LEVEL = 0.05  # of the test whose power is told
BLIND = 1e6  # δ²: variance along directions that the data say nothing of
RUNS = 4  # from which on they tell how far an estimate differs from one to the other
SEEN = 0.25  # a direction counts as seen when δ along it would be at least this many standard deviations, squared


@dataclass(frozen=True)
class Score:
    """One effect's score test. Arrays are by parameter (k,)."""

    effect: str
    names: tuple[str, ...]
    estimate: np.ndarray
    se: np.ndarray
    p: float
    likelihood_ratio: float  # expected fall of −2 log likelihood
    power: float
    collinearity: float  # R²: share of its signature that calibration can imitate
    signature: np.ndarray  # (N,) unit vector of the projected expected change
    delta: np.ndarray
    covariance: np.ndarray  # (k, k) of the estimate, in units of δ; where the data see nothing as large as BLIND
    imitated: np.ndarray  # (m, k) by how much the calibrated directions make up for δ of it,
    by: tuple[str, ...] = ()  # whose names these are,
    spread: np.ndarray = field(default_factory=lambda: np.zeros(0))  # and standard errors (m,)


class Projector:
    """Takes the calibrated directions Z (N, m) off any columns (N, k). What is known of each beforehand counts as further
    readings, with slopes (m, m) and residuals (m,): a fit that has bent a value to imitate an effect is strained, and that
    speaks for the effect. `names` are those of the directions, for whoever is told of them."""

    def __init__(
        self, Z: np.ndarray, prior_slopes: np.ndarray, prior_rows: np.ndarray | None = None, names: Sequence[str] = ()
    ):
        self.Z, self.slopes, self.names = Z, prior_slopes, tuple(names)
        self.rows = np.zeros(Z.shape[1]) if prior_rows is None else prior_rows
        self._inverse = inverse(Z.T @ Z + prior_slopes**2)
        self.spread = np.sqrt(np.maximum(np.diag(self._inverse), 0.0))

    def __call__(self, X: np.ndarray) -> np.ndarray:
        """What is left of the columns in the readings (N, k)."""
        return X - self.Z @ self._imitated(X)

    def with_strained(self, X: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The same, what is left of the columns in the further readings (m, k), and by how much (m, k) the directions make up
        for them."""
        imitated = self._imitated(X)
        return X - self.Z @ imitated, -self.slopes @ imitated, imitated

    def _imitated(self, X: np.ndarray) -> np.ndarray:
        return self._inverse @ (self.Z.T @ X)


def robust_variance(evidence: Evidence, s: np.ndarray, r: np.ndarray) -> np.ndarray:
    """Variance (k, k) of sᵀ r, within runs: Newey and West's with lags up to LAG, of what an AR(1) law leaves of each product,
    and from there back (Andrews and Monahan 1992), as lags alone see too little of noise that lasts."""
    total, terms = np.zeros((s.shape[1], s.shape[1])), s * r[:, None]
    for e, good, part in evidence.parts():
        sample = np.nonzero(good)[0]
        q = np.stack([np.bincount(sample, column, minlength=len(e.r)) for column in terms[part].T], axis=1)
        total += _long_run_variance(q, max(1, round(LAG / float(np.median(np.diff(e.run.time))))))
    return total


def _long_run_variance(q: np.ndarray, lags: int) -> np.ndarray:
    """Σ over lags of the autocovariance (k, k) of q (n, k): by Bartlett's weights of what an AR(1) law leaves of each column,
    which is the power of its moving sums, and recoloured by that law."""
    rho = _lasting(q)
    left = q - rho * np.concatenate([np.zeros((1, q.shape[1])), q[:-1]])
    width = min(lags, len(q) // 4) + 1
    sums = np.cumsum(np.concatenate([np.zeros((width, q.shape[1])), left, np.zeros((width - 1, q.shape[1]))]), axis=0)
    moving = (sums[width:] - sums[:-width]) / (1 - rho)
    return moving.T @ moving / width


def _lasting(q: np.ndarray) -> np.ndarray:
    """AR(1) coefficients (k,) of columns (n, k) about their means."""
    about = q - q.mean(axis=0)
    power = np.sum(about**2, axis=0)
    return np.clip(np.sum(about[1:] * about[:-1], axis=0) / np.where(power > 0, power, 1.0), 0.0, LASTING)


def _spread(
    evidence: Evidence, s: np.ndarray, strained: np.ndarray, information: np.ndarray, r: np.ndarray, rows: np.ndarray
) -> np.ndarray:
    """Covariance (m, m) of the expected change, by what it leaves: residuals r (N,), `rows` of what was known beforehand. The
    larger of what lasting residuals make it, and of how far runs would have it apart, which shows where no model is exact."""
    known, variance = strained.T @ strained, np.diag(1 / information)
    lasting = variance @ (robust_variance(evidence, s, r) + known) @ variance
    pulls = np.array([s[part].T @ r[part] for _, _, part in evidence.parts()])
    if len(pulls) < RUNS:
        return lasting
    between = variance @ (pulls.T @ pulls * len(pulls) / (len(pulls) - 1) + known) @ variance
    return max(lasting, between, key=np.trace)


def power_at_delta(covariance: np.ndarray) -> float:
    """With which an effect of δ is seen whose estimate has this covariance (k, k), in units of δ."""
    return power(min(1 / float(np.diag(covariance).mean()), 1e6), len(covariance), LEVEL)


def score(
    evidence: Evidence,
    off: Projector,
    effect: str,
    names: Sequence[str],
    S: np.ndarray,
    delta: np.ndarray,
    one_sided: np.ndarray,
) -> Score:
    """Score test of one effect: S (N, k), its smallest interesting sizes δ (k,), and which may only be positive."""
    r, scaled = evidence.r, S * delta
    s, strained, imitated = off.with_strained(scaled)
    I = s.T @ s + strained.T @ strained  # noqa: E741
    size, axes = np.linalg.eigh(I)
    seen = size > max(SEEN, 1e-9 * size.max(initial=0))
    whole = float(np.einsum("ij,ij->", scaled, scaled))
    collinearity = 1 - float(np.trace(I)) / whole if whole > 0 else 1.0
    if not seen.any():
        nothing = np.zeros(len(delta))
        unknown, blind = np.full(len(delta), np.inf), BLIND * np.eye(len(delta))
        unseen = unknown, 1.0, 0.0, 0.05, collinearity, nothing[:0], delta, blind, imitated
        return Score(effect, tuple(names), nothing, *unseen, off.names, off.spread)
    V = axes[:, seen]
    s_V, strained_V, I_V = s @ V, strained @ V, size[seen]
    U = s_V.T @ r + strained_V.T @ off.rows
    Omega = robust_variance(evidence, s_V, r) + strained_V.T @ strained_V
    change = U / I_V
    spread = np.diag(1 / I_V) @ Omega @ np.diag(1 / I_V)
    estimate = V @ change * delta
    se = np.sqrt(np.maximum(np.diag(V @ spread @ V.T), 0)) * delta
    T = float(U @ np.linalg.pinv(Omega, hermitian=True) @ U)
    p = chance_beyond(T, int(seen.sum()))
    if len(delta) == 1 and one_sided[0]:
        p = p / 2 if estimate[0] > 0 else 1 - p / 2
    ratio = float(U @ change)
    if one_sided.all() and (estimate <= 0).all():
        ratio = 0.0  # the data ask for the unlawful sign
    direction = s_V @ change
    length = np.linalg.norm(direction)
    return Score(
        effect,
        tuple(names),
        estimate,
        se,
        p,
        ratio,
        power_at_delta(spread),
        collinearity,
        direction / length if length > 0 else direction,
        delta,
        V @ _spread(evidence, s_V, strained_V, I_V, r - direction, off.rows - strained_V @ change) @ V.T
        + BLIND * (np.eye(len(delta)) - V @ V.T),
        imitated,
        off.names,
        off.spread,
    )
