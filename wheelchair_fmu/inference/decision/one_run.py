"""Effects that are named for the sake of a single run: without it they would not be."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple

from ..estimation.marginal import widest
from ..estimation.score import power_at_delta
from ..policy import DEFAULT, SearchPolicy
from ..search.candidate import Candidate
from ..search.probability import in_place
from ..search.rounds import Round


class Resting(NamedTuple):
    """Effects of which one is there with a `probability`, which is less than even `without` one fitted run; whether the others
    would have `seen` it at its smallest interesting size."""

    effects: tuple[str, ...]
    run: str
    probability: float
    without: float
    seen: bool

    @property
    def words(self) -> str:
        what = " or ".join(self.effects)
        if not self.seen:
            return f"{what}: only {self.run} tells of it; another run like that one would confirm it"
        return (
            f"{what}: this rests on {self.run}; by the other fitted runs, which would show it, the probability that there "
            f"is {self.without:.2f} and not {self.probability:.2f}; look at that run, or make another like it"
        )


def resting(
    groups: Iterable[Sequence[str]], decided: Mapping[str, Round], found: Container[str], policy: SearchPolicy = DEFAULT
) -> tuple[Resting, ...]:
    """Of groups of effects that are tied, or of one alone, those that rest on one run. The first of each was `decided` by a
    round, and all effects `found` are in the model."""
    return tuple(one for group in groups if group[0] in decided for one in _of(group, decided[group[0]], found, policy))


def _of(group: Sequence[str], r: Round, found: Container[str], policy: SearchPolicy) -> Iterator[Resting]:
    runs = [e.run.name for e in r.fit.evidence.runs]
    whole = _there(r, group, found)
    if len(runs) < 2 or whole <= 0.5:
        return
    fewer = {run: r.leaving_out(run) for run in runs}
    without = {run: _there(fewer[run], group, found) for run in runs}
    run = min(runs, key=without.__getitem__)
    if without[run] <= 0.5:
        seen = any(_power(c) >= policy.power for c in fewer[run].every if c.effect in group)
        yield Resting(tuple(group), run, whole, without[run], seen)


def _there(r: Round, group: Sequence[str], found: Container[str]) -> float:
    """The probability that one of a group is there, by a round."""
    beliefs = in_place(r, group[0], found)
    return sum(b.there for effect, b in beliefs.items() if effect in group)


def _power(c: Candidate) -> float:
    """With which an effect of δ would be seen, by the widest of its standard errors."""
    _, *covariances = c.usual
    return power_at_delta(widest(covariances, c.delta))
