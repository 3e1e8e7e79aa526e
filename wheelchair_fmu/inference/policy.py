"""What the search for missing effects is free to choose: every number by which it decides, and every one by which it saves
work, each with its reason.

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
    def nothing_left(self) -> float:
        """Whitened RMS error that leaves nothing to explain: a third of a little."""
        return 1 + (self.a_little - 1) / 3

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


def _limit(value: float, thorough: float, reason: str) -> float:
    """A field with what a search that spares no work has, and why it is what it is."""
    return field(default=value, metadata={"thorough": thorough, "reason": reason})


def _count(value: int, thorough: int, reason: str) -> int:
    """The same of a number of things."""
    return field(default=value, metadata={"thorough": thorough, "reason": reason})


@dataclass(frozen=True)
class Effort:
    """How much a search tries. These numbers are to save work and to decide nothing: they leave out what could not be found,
    or would be found as well in another way. `python -m benchmarks.effort` searches campaigns again without sparing any work,
    and counts the answers that change all the same. Falls are of −2 log likelihood, as slopes and secants promise them or as a
    refit finds them."""

    shortlist: int = _count(5, 12, "effects that are refitted in a round, by what slopes and secants promise of them")
    curved: int = _count(2, 6, "effects that slopes say little of, which are refitted beside these")
    alike: float = _limit(0.9, 0.7, "cosine of signatures above which a rival of the leader is refitted whatever it promises")
    promising: float = _limit(
        3.0,
        1.5,
        "expected fall below which nothing is refitted, the log prior odds of one in thirty: twice that passes, and slopes may "
        "see half of it",
    )
    hopeless: float = _limit(0.2, 0.1, "share of the leader's fall that another must promise to be refitted")
    halfway: float = _limit(0.5, 0.25, "share of a fall that is expected, promised or was found, which counts as near it")
    beyond: float = _limit(10.0, 30.0, "times what slopes that say little promise of an effect, which it may do")
    far: float = _limit(1.1, 1.05, "mean square innovation beside which no slope is trusted to say that all is seen")
    hint: float = _limit(30.0, 15.0, "expected fall from which an effect that slopes say little of may do more at another size")
    room: float = _limit(1.01, 1.005, "mean square innovation above which it may")
    negligible: float = _limit(0.3, 0.1, "of δ, a size that surely does not matter")
    little: float = _limit(100.0, 50.0, "expected fall above which an effect is refitted however small it seems from here")
    bent: float = _limit(1.0, 0.5, "standard deviations of its prior by which a calibrated value counts as bent")
    slightly: float = _limit(0.1, 0.05, "the same, where it costs little to look at both")
    starts: int = _count(2, 4, "sizes of an effect, or combinations of a group's, from which refits go on to their end")
    directions: int = _count(4, 8, "pairs of signs from which refits of an effect with several parameters start")
    ended: int = _count(3, 6, "of these, how many go on to their end")
    tries: int = _count(125, 250, "combinations of sizes of a group's effects that are looked at")
    begun: int = _count(16, 32, "of these, refits that make one step")
    several: float = _limit(1.2, 1.1, "whitened RMS error that is worth a search for several effects at once")
    most_left: float = _limit(0.5, 0.25, "of the mean square above noise: where a step leaves more, forces are asked for first")
    most_effects: int = _count(4, 6, "effects that are put in, beside what only helps: whoever lacks more needs another model")
    most_steps: int = _count(8, 12, "steps that put one in, or one in the place of another")
    plainly: float = _limit(100.0, 1000.0, "times what is decisive: an effect so far from zero, by standard errors, is needed")
    terms: int = _count(3, 8, "generic terms that are refitted: one is proposed, and nobody asks which others would do as well")

    @classmethod
    def thorough(cls) -> Effort:
        """That of a search which spares no work."""
        return cls(**{f.name: f.metadata["thorough"] for f in fields(cls)})


DEFAULT = SearchPolicy()
USUAL = Effort()
RANGES: dict[str, tuple[float, float]] = {f.name: f.metadata["range"] for f in fields(SearchPolicy) if "range" in f.metadata}
