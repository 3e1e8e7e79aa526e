"""What the search for missing effects is free to choose: every number by which it decides, with its reason.

All else follows from likelihoods. `python -m benchmarks.policy` decides searches again with each number at both ends of its
range, and counts the rounds, ties, terms and verdicts that change.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from math import log


def _number(value: float, low: float, high: float, reason: str) -> float:
    """A field with the range that is reasonable, and why it is what it is."""
    return field(default=value, metadata={"range": (low, high), "reason": reason})


NOTHING = 1e-3  # δ, as good as nothing


@dataclass(frozen=True)
class SearchPolicy:
    """Sizes are in δ, the smallest interesting size of each parameter; odds are ratios of probabilities."""

    large: float = _number(
        4.0, 2.0, 8.0, "standard deviation, beforehand, of an effect that is there: sizes of interest reach to about ten δ"
    )
    slight: float = _number(
        0.25,
        0.2,
        0.3,
        "standard deviation of an effect that is not there: no model is exact, and every chair has a little of everything; "
        "known without error, a size counts as large from 0.9 δ",
    )
    expected: float = _number(1.0, 0.3, 3.0, "effects that are missing, beforehand: who asks for a diagnosis expects one")
    generic_odds: float = _number(
        0.01, 0.001, 0.1, "of a term that nobody knows a cause for, beside an effect of the catalogue: decisive odds against it"
    )
    tie_odds: float = _number(
        100.0,
        30.0,
        300.0,
        "odds up to which effects are not told apart, and by which one takes another's place: decisive (Kass and Raftery 1995)",
    )
    sure: float = _number(0.95, 0.9, 0.99, "probability that an effect is there, large or slight, from which it is named")
    power: float = _number(
        0.8, 0.7, 0.9, "chance with which an effect of δ must be seen, for its absence to say anything (Cohen 1988)"
    )
    library: float = _number(0.75, 0.65, 0.85, "share of the catalogue's causes that must be seen so, in an adequate model")
    inexact: float = _number(
        0.02, 0.01, 0.04, "share of what an effect does that its law gets wrong: laws of other simulators differ by as much"
    )
    unexplained: float = _number(
        1.3, 1.2, 1.4, "whitened RMS error, fitted and held out, that no adequate model leaves, whatever was found"
    )
    a_little: float = _number(
        1.06, 1.04, 1.08, "whitened RMS error by which two models of one chair differ, with other tyres and other casters"
    )
    rest: float = _number(
        0.2,
        0.15,
        0.25,
        "share of the mean square above the noise that what was found may leave, where that is more than a little",
    )
    structured: float = _number(
        1.1, 1.08, 1.15, "whitened RMS error that is no noise where nothing was found and residuals last"
    )
    far_off: float = _number(2.0, 1.7, 2.5, "the same, of one channel in one run")
    lasting: float = _number(2.0, 1.6, 2.5, "samples that are worth an independent one, from which residuals count as lasting")

    @property
    def of_terms(self) -> SearchPolicy:
        """The same for generic terms, of which nobody has said what size is slight."""
        return replace(self, slight=NOTHING)

    @property
    def tied(self) -> float:
        """Fall of −2 log likelihood that `tie_odds` are."""
        return 2 * log(self.tie_odds)

    def is_structured(self, rms: float, worst: float) -> bool:
        """Is a whitened RMS error, or the `worst` of one channel in one run, more than noise where nothing was found?"""
        return rms > self.structured or worst > self.far_off

    def is_rest(self, after: float, before: float) -> bool:
        """Is a whitened RMS error beside what was found more than a little, and too large a share of what calibration left?"""
        return after > self.a_little and after**2 - 1 > self.rest * (before**2 - 1)

    def log_prior(self, effects: int) -> float:
        """Log odds, before anything was measured, that one of so many effects is missing."""
        share = min(self.expected / max(effects, 2), 0.5)
        return log(share / (1 - share))


DEFAULT = SearchPolicy()
RANGES: dict[str, tuple[float, float]] = {f.name: f.metadata["range"] for f in fields(SearchPolicy) if "range" in f.metadata}
