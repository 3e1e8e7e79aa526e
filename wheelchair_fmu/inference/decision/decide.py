"""From what a search has found, and what it leaves, to a verdict: nothing is fitted here."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..policy import DEFAULT, SearchPolicy
from ..residual.staircase import Step
from ..search.rounds import Round
from .ahead import Ahead


@dataclass(frozen=True)
class Facts:
    """What a verdict follows from: the `effects` that are probably there, the `first` round, the staircase, whether a generic
    term is `proposed`, and whether forces lead the runs that something orders, or that are more than a floor's (`forced`).

    Of what the last model leaves on fitted runs: after how many samples it is forgotten (`lasts`), its whitened RMS over all
    and the `worst` of one channel in one run; and what is left `ahead`, on those held out. `strained` are given values that are
    bent as far as they may be, `likely` the probability of what is more probably of a size of interest than not and not sure
    enough to be named, `powers` those with which effects would have been seen, where all hangs on that, and `causes` theirs.
    """

    effects: tuple[str, ...]
    ties: tuple[tuple[str, ...], ...]
    first: Round
    ladder: tuple[Step, ...]
    proposed: bool
    forced: bool
    lasts: float
    rms: float
    worst: float
    ahead: Ahead
    strained: tuple[str, ...]
    likely: Mapping[str, float]
    powers: Mapping[str, float]
    causes: Mapping[str, str]

    def seen(self, policy: SearchPolicy = DEFAULT) -> float:
        """Share of the causes that would have been seen; of one that has several forms, as large a part as of these."""
        return share_seen({effect: power >= policy.power for effect, power in self.powers.items()}, self.causes)


def decide(facts: Facts, policy: SearchPolicy = DEFAULT) -> str:
    """The verdict. No model is adequate that is likely to lack something."""
    lasting = facts.lasts > policy.lasting
    if facts.proposed or facts.forced or facts.ladder[-1].left > policy.unexplained or facts.strained:
        return "outside"
    if facts.effects:
        if (lasting and insufficient(facts.ladder, policy)) or facts.ahead.unexplained(policy):
            return "outside"
        return "tie" if facts.ties else "missing"
    if (lasting and policy.is_structured(facts.rms, facts.worst)) or facts.ahead.unexplained(policy):
        return "outside"
    if slight(facts.first):
        return "small"
    return "adequate" if facts.seen(policy) >= policy.library and not facts.likely else "cannot_see"


def share_seen(seen: Mapping[str, bool], causes: Mapping[str, str]) -> float:
    """See `Facts.seen`; 0 where there is nothing to see."""
    forms: dict[str, list[bool]] = {}
    for effect, would in seen.items():
        forms.setdefault(causes[effect], []).append(would)
    return float(np.mean([float(np.mean(some)) for some in forms.values()] or [0.0]))


def insufficient(ladder: Sequence[Step], policy: SearchPolicy = DEFAULT) -> bool:
    """Does the model at the top of a staircase leave much, or, on fitted or on held-out runs, more than a little and too large
    a share of what calibration left above the noise?"""
    top, calibrated = ladder[-1], ladder[1]
    sides = ((top.fit, calibrated.fit), (top.heldout, calibrated.heldout))
    return top.left > policy.unexplained or any(policy.is_rest(after, before) for after, before in sides)


def slight(first: Round) -> tuple[str, ...]:
    """Effects that are surely there and slight, and foretell what was held out better than by chance: the likeliest, and those
    that data cannot tell from it. None where one that is large was likelier: whether it is there was asked beside others."""
    if first.winner is not None and not first.likelier_slight(first.winner):
        return ()
    small = [c for c in first.slight if first.likelier_slight(c) and (c.gain is None or c.gain[1] > 0)]
    return tuple(c.effect for c in small if 2 * (small[0].support.slight - c.support.slight) < first.policy.tied)


class Larger(NamedTuple):
    """An effect that would be large, `times` the size of interest, with the odds that are `against` it."""

    effect: str
    times: float
    against: float

    @property
    def words(self) -> str:
        return (
            f"{self.effect} would do as well, and would not be small: {self.times:.1f} times what is of interest; the odds are "
            f"{self.against:.0f} to 1 against it"
        )


def instead_of_small(first: Round) -> tuple[Larger, ...]:
    """Effects that would be large, and that data cannot tell from those that are slight."""
    surely, small = [c.support for c in first.slight], slight(first)
    others = (c for c in first.candidates if c.matters and not c.worsens and c.effect not in small)
    behind = ((c, first.nothing([c.support, *surely]) - first.log_prior - c.support.large) for c in others)
    return tuple(
        Larger(c.effect, float(np.linalg.norm(c.size / c.delta)), float(np.exp(log_odds)))
        for c, log_odds in behind
        if 2 * log_odds < first.policy.tied
    )
