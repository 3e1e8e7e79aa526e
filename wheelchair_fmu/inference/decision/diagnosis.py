"""Everything that `diagnose` says, and the round that judges each effect of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ..estimation.calibration import Calibrated
from ..estimation.problem import Fit
from ..models.models import Models
from ..preflight.timing import Late
from ..residual.staircase import Step
from ..residual.unexplained import Unexplained
from ..search.beginning import Clocks
from ..search.candidate import Candidate
from ..search.probability import beliefs, shared
from ..search.rounds import Belief, Round
from ..search.ties import grouped
from .ahead import Ahead, run_to_fit
from .decide import Facts, Larger, instead_of_small
from .one_run import Resting, resting
from .unseen import one_sided


@dataclass(frozen=True)
class Diagnosis:
    """Everything `diagnose` says.

    `included` are the effects of the model in the end, of which the variant came with `already`; `rounds` those of the search,
    `beside` those that judge an effect beside all others, where it does not stand without; `proposal` is the generic term of
    "outside", `calibration` what became of given values, `intervals` are by the profile of the likelihood, or by
    standard errors where forces that nobody recorded lead the runs, and as much wider as effects that nobody named may move an
    estimate, by `allowance`, a standard deviation; of what is tied with an effect, in the model that has it instead. `models`
    are those that were searched, `retimed` and `clocks` what is known of time, and `heard` sentences on columns and clocks.
    """

    campaign: str
    verdict: str
    effects: tuple[str, ...]
    included: tuple[str, ...]
    already: tuple[str, ...]
    ties: tuple[tuple[str, ...], ...]
    ladder: tuple[Step, ...]
    rounds: tuple[Round, ...]
    beside: tuple[Round, ...]
    leftover: Round | None
    proposal: Candidate | None
    final: Fit
    calibration: tuple[Calibrated, ...]
    intervals: Mapping[str, tuple[float, float]]
    allowance: Mapping[str, float]
    models: Models
    retimed: Mapping[str, Late]
    clocks: Clocks
    heard: tuple[str, ...]
    notes: tuple[str, ...]
    next_experiment: dict[str, Any] | None
    seconds: float = 0.0
    unexplained: Unexplained | None = None
    seen: float | None = None  # share of the catalogue's causes that would have been seen, where nothing was
    ahead: Ahead = Ahead()
    facts: Facts | None = None  # that the verdict follows from
    rests_on: tuple[Resting, ...] = ()  # what is named for the sake of a single run

    @property
    def top(self) -> Fit:
        """The fit at the top of the staircase: the proposal's, where there is one."""
        return self.proposal.fit if self.proposal else self.final

    @cached_property
    def beliefs(self) -> dict[str, Belief]:
        """How probable it is that each effect is there, and larger than δ."""
        found = {e: self._decided(e) for e in self.included if e not in self.already}
        return beliefs(found, self.rounds[-1], one_sided(self.models.factory))

    @property
    def odds(self) -> tuple[dict[str, float], ...]:
        """Of each group of effects that are tied, the probability that it is each of them."""
        return tuple(shared(group, self._decided(group[0])) for group in self.ties)

    @property
    def to_fit(self) -> str | None:
        """The held-out run to fit as well, where only such runs show an error."""
        return run_to_fit(self.ladder, self.ahead, self.models.policy)

    @property
    def larger(self) -> tuple[Larger, ...]:
        """What would be large instead of what was found to be small, as far as data cannot tell them apart."""
        return instead_of_small(self.rounds[0]) if self.verdict == "small" else ()

    def resting(self) -> tuple[Resting, ...]:
        """What is named for the sake of a single run, asked anew: `diagnose` keeps it as `rests_on`."""
        if self.verdict not in ("missing", "tie", "outside") or self.proposal:
            return ()
        decided = {e: self._decided(e) for e in self.effects if e in self.included}
        return resting(grouped([*decided], self.ties), decided, self.included, self.models.policy)

    def _decided(self, effect: str) -> Round:
        """The round that judges an effect of the final model, beside all others of it where there is such a round."""
        return deciding(effect, self.included, self.beside, self.rounds)


def deciding(effect: str, included: Sequence[str], beside: Sequence[Round], rounds: Sequence[Round]) -> Round:
    """The round that judges an effect of a model, beside all others of it where there is such a round."""
    again = (r for r in beside if {*r.effects, effect} == set(included) and effect not in r.effects)
    first = (r for r in reversed(rounds) if effect not in r.effects and any(c.effect == effect for c in r.candidates))
    return next(again, None) or next(first)
