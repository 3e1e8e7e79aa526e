"""What the search for missing effects is free to choose: every number by which it decides, with its reason.

Everything else that the loop decides follows from likelihoods. `python -m benchmarks.policy` searches the campaigns of an
independent simulator again with each number at both ends of its range, and tells whose answers change.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from math import log


@dataclass(frozen=True)
class SearchPolicy:
    """Sizes are in δ, the smallest interesting size of each parameter; odds are ratios of probabilities."""

    large: float = 4.0
    """δ: standard deviation, beforehand, of an effect that is there. Sizes of interest reach from δ to about ten of it."""

    slight: float = 0.25
    """δ: standard deviation of an effect that is not: no model is exact, and every chair has a little of everything. Known
    without error, a size counts as large from 0.9 δ."""

    expected: float = 1.0
    """Effects of the catalogue that are missing, beforehand. Who asks for a diagnosis expects one."""

    generic_odds: float = 0.01
    """Of a term that nobody has a cause for, beside an effect of the catalogue."""

    tie_odds: float = 100.0
    """Odds up to which two effects are not told apart, and by which one takes another's place: what counts as decisive
    (Kass and Raftery 1995)."""

    sure: float = 0.95
    """Probability from which an effect that is slight is named: what is usual."""

    power: float = 0.8
    """Chance with which an effect of δ must be seen if it were there, for its absence to say anything: what studies are planned
    by (Cohen 1988)."""

    library: float = 0.75
    """Share of the catalogue's causes that must be seen so, for a model to be called adequate."""

    most_effects: int = 4
    """Effects that are put in, at most: whoever lacks more needs another model."""

    shortlist: int = 5
    """Effects that are refitted in a round, by what slopes and secants promise of them. It costs time, and no more."""

    @property
    def tied(self) -> float:
        """Fall of −2 log likelihood that `tie_odds` are."""
        return 2 * log(self.tie_odds)

    def log_prior(self, effects: int) -> float:
        """Log odds, before anything was measured, that one of so many effects is missing."""
        share = self.expected / max(effects, 2)
        return log(share / (1 - share))


DEFAULT = SearchPolicy()


def described(policy: SearchPolicy = DEFAULT) -> dict[str, float]:
    """Its numbers by name."""
    return {f.name: getattr(policy, f.name) for f in fields(policy)}
