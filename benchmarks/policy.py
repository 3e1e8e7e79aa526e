"""`python -m benchmarks.policy`: what a diagnosis says with each number of the policy at both ends of its range.

Campaigns of the independent simulator are searched once; then all is decided again by another policy from what was fitted,
which costs nothing: each round, which effects are tied, whether a generic term is found, and the verdict. What a search would
have fitted otherwise, had it gone another way from there, is not asked.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Sequence
from dataclasses import replace

from rich.console import Console
from rich.progress import track
from rich.table import Table

from wheelchair_fmu.inference.decision.decide import decide
from wheelchair_fmu.inference.decision.diagnosis import Diagnosis
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.policy import DEFAULT, RANGES, SearchPolicy
from wheelchair_fmu.inference.search.rounds import Round
from wheelchair_fmu.inference.search.ties import tied
from wheelchair_fmu.model.generic import library

from .diagnosis.cases import Case, Plan
from .diagnosis.trial import asked


def searched(case: Case) -> Diagnosis:
    """What a search of what was hidden came to."""
    with asked(case) as (campaign, chair):
        return diagnose(campaign, chair, library())


def found(r: Round, policy: SearchPolicy) -> str | None:
    """What a round puts in by a policy."""
    winner = r.decided_by(policy).winner
    return winner.effect if winner else None


def term(d: Diagnosis, policy: SearchPolicy) -> str | None:
    """Which generic term is found beside what is left, by a policy."""
    return found(replace(d.leftover, odds=policy.generic_odds), policy.of_terms) if d.leftover else None


def ties(d: Diagnosis, policy: SearchPolicy) -> list[tuple[str, ...]]:
    """Which effects each one that was named is tied with, by a policy."""
    judges = ((r, e) for r in d.beside for e in d.effects if any(c.effect == e for c in r.candidates) and e not in r.effects)
    return [tied(r.decided_by(policy), effect) for r, effect in judges]


def verdict(d: Diagnosis, policy: SearchPolicy) -> str | None:
    """The verdict by a policy, of the effects and ties that there are."""
    return decide(replace(d.facts, first=d.facts.first.decided_by(policy)), policy) if d.facts else None


def changes(searches: Sequence[Diagnosis]) -> Iterator[tuple[str, float, tuple[int, int, int, int]]]:
    """Each number of the policy, at each end of its range, with how many rounds, ties, terms and verdicts are otherwise."""

    def told(policy: SearchPolicy) -> tuple[list[object], ...]:
        rounds = [found(r, policy) for d in searches for r in d.rounds]
        return rounds, *([one(d, policy) for d in searches] for one in (ties, term, verdict))  # type: ignore[operator]

    usual = told(DEFAULT)
    for name, ends in RANGES.items():
        for value in ends:
            other = told(replace(DEFAULT, **{name: value}))
            counts = [sum(a != b for a, b in zip(one, another, strict=True)) for one, another in zip(usual, other, strict=True)]
            yield name, value, (counts[0], counts[1], counts[2], counts[3])


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.policy", description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of noise, pushes and true chairs")
    parser.add_argument("--every", type=int, default=10, help="of the cases of `benchmarks.diagnosis`, every so many")
    chosen = parser.parse_args()
    console = Console()
    cases = Plan([chosen.seed]).cases[:: chosen.every]
    searches = [searched(case) for case in track(cases, "searches", console=Console(stderr=True))]
    rounds = sum(len(d.rounds) for d in searches)
    table = Table(title=f"{len(cases)} searches of {rounds} rounds, seed {chosen.seed}: how many are decided otherwise")
    for heading in ("number", "as it is", "instead", "rounds", "ties", "terms", "verdicts"):
        table.add_column(heading)
    for name, value, counts in changes(searches):
        table.add_row(name, f"{getattr(DEFAULT, name):g}", f"{value:g}", *map(str, counts))
    console.print(table)


if __name__ == "__main__":
    main()
