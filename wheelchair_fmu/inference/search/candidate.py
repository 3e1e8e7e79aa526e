"""A hypothesis that was tried: one effect, or a group of them, beside the model at hand, refitted with all other values."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..estimation.marginal import LEAST, Support, squared, support_of
from ..estimation.problem import Fit
from ..evidence.evidence import Evidence
from ..models.factory import members_of
from ..policy import DEFAULT, SearchPolicy


@dataclass(frozen=True)
class WithoutRun:
    """What all fitted runs but one say of a candidate: by how much its sizes by usual laws (k,) are `moved`, how many times
    their standard errors are `wider` (k,), and the `fall` of −2 log likelihood; None where that follows from these."""

    moved: np.ndarray
    wider: np.ndarray
    fall: float | None


@dataclass(frozen=True)
class Candidate:
    """What it does beside the model without it. Arrays are by parameter (k,)."""

    effect: str  # or the group's name
    fit: Fit
    likelihood_ratio: float  # fall of −2 log likelihood, divided by the residuals' dispersion
    estimate: np.ndarray
    without: np.ndarray  # the same in a model that lacks it: zero, or what the campaign says
    covariance: np.ndarray  # (k, k) of the estimate
    # Its size by usual laws (k,), that one's covariance (k, k), and the same by how far runs would have it apart: see `usual`.
    usual: tuple[np.ndarray, np.ndarray, np.ndarray]
    delta: np.ndarray
    one_sided: np.ndarray  # which of its parameters may only be positive
    dispersion: float  # mean square innovation
    correlation: float  # samples per independent one
    p: float  # of a test without priors, times the number of effects tested
    gain: tuple[float, float, float] | None  # held-out gain with its 95 % interval, None without held-out runs
    heldout: Evidence | None
    lawful: bool  # of a sign that its parameters may have
    stretched: bool = False  # to a bound, beyond which no chair is: what asks for more of it is something else
    bounded: float = 0.0  # −2 log likelihood that its lack costs by its own slopes, all other values being within their bounds
    beside: tuple[float, float] | None = None  # dispersion and correlation that the likeliest of its round leaves
    afresh: bool = False  # its runs start where the campaign has them, and not where the model without it wants them
    by_errors: bool = False  # its fall is by standard errors, which allow for how large and how correlated residuals are
    without_run: Mapping[str, WithoutRun] = field(default_factory=dict)  # by fitted run
    policy: SearchPolicy = DEFAULT

    @property
    def members(self) -> tuple[str, ...]:
        """The effects that it is of."""
        return members_of(self.effect)

    @property
    def scale(self) -> float:
        """−2 log likelihood that counts as one, with residuals as large and as correlated as the likeliest model leaves."""
        dispersion, correlation = self.beside or (self.dispersion, self.correlation)
        return dispersion * correlation

    @property
    def unit(self) -> float:
        """What counts as one of a deviance's fall: `scale`, but of one by standard errors."""
        return 1.0 if self.by_errors else self.scale

    @property
    def fall(self) -> float:
        """Of −2 log likelihood, in `unit`s; by standard errors no more than the widest of them have it: runs that would have an
        effect apart say less of it than their moments do."""
        whole = max(self.likelihood_ratio, 0.0) * self.dispersion / self.unit
        return min(whole, *self._away) if self.by_errors else whole

    @cached_property
    def _away(self) -> list[float]:
        """How far its size by usual laws is from none, squared, in standard errors, and in those between runs."""
        size, *covariances = self.usual
        return [squared(size / self.delta, covariance / np.outer(self.delta, self.delta)) for covariance in covariances]

    @cached_property
    def support(self) -> Support:
        """What bears it out, beside the model without it, and however many parameters it has."""
        (size, *covariances), ahead = self.usual, self.gain[0] / self.scale if self.gain else 0.0
        what = size, covariances, self.delta, self.one_sided, self.fall, ahead, self.policy, self.bounded
        return support_of(self.effect, *what)

    def leaving_out(self, run: str) -> Candidate:
        """The same as all fitted runs but one have it."""
        if run not in self.without_run:
            return self
        (size, *covariances), out = self.usual, self.without_run[run]
        usual = size + out.moved, *(c * np.outer(out.wider, out.wider) for c in covariances)
        fewer = replace(self, usual=usual, estimate=self.estimate + out.moved)
        nearer = min(fewer._away) / max(min(self._away), LEAST)
        ratio = self.likelihood_ratio * nearer if out.fall is None else out.fall / self.dispersion
        fit = replace(self.fit, evidence=self.fit.evidence.without(run))
        return replace(fewer, fit=fit, likelihood_ratio=ratio, bounded=self.bounded * nearer)

    @property
    def size(self) -> np.ndarray:
        """How far (k,) its parameters are from those of a model that lacks it."""
        return self.estimate - self.without

    @property
    def excess(self) -> float:
        """Log likelihood that is gained, and neither by the estimate, as its standard errors have it, nor for other values'
        bounds: of a model that is not exact a parameter may take up what it did not do."""
        return 0.5 * max(0.0, self.fall - max(self._away[0], self.bounded))

    @property
    def se(self) -> np.ndarray:
        """Standard errors (k,)."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0))

    @property
    def possible(self) -> bool:
        """May a chair have it, at the size that was found?"""
        return self.lawful and not self.stretched

    @property
    def worsens(self) -> bool:
        """Are runs that were held out surely foretold worse with it than without?"""
        return self.gain is not None and self.gain[2] < 0

    @property
    def matters(self) -> bool:
        """Is it likelier to be large than to be slight, or nothing, if it is there at all?"""
        return self.possible and self.support.large > max(0.0, self.support.slight)


def ranked(candidates: Iterable[Candidate]) -> list[Candidate]:
    """Candidates of one model, best first: by marginal likelihood, with residuals as the likeliest leaves them."""
    found = list(candidates)
    likeliest = max(found, key=lambda c: c.likelihood_ratio * c.dispersion, default=None)
    if likeliest is None:
        return []
    beside = likeliest.dispersion, likeliest.correlation
    return sorted((replace(c, beside=beside) for c in found), key=lambda c: -c.support.large)
