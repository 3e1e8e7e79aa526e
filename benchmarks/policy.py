"""`python -m benchmarks.policy`: what a search finds with the numbers that decide a round at both ends of their ranges.

Campaigns of the independent simulator are searched once; then each round is decided again by another policy, from what was
refitted, which costs nothing. A round counts as changed where another effect would have gone in, or none. On numbers that are
asked only of a search that has ended, as those of "outside" and of "cannot_see" are, no round depends: they are not varied.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from rich.console import Console
from rich.progress import track
from rich.table import Table

from wheelchair_fmu.campaign import read
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.policy import DEFAULT, RANGES
from wheelchair_fmu.inference.search.rounds import Round
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant

from .diagnosis.cases import Case, Plan
from .independent.campaigns import make

OF_ROUNDS = ("large", "slight", "expected", "sure", "inexact")  # numbers that decide which effect a round puts in


def rounds_of(case: Case) -> tuple[Round, ...]:
    """The rounds of a search of what was hidden."""
    catalogue = {name: effect for name, effect in bundled().items() if name not in case.left_out}
    with tempfile.TemporaryDirectory() as place:
        told = {"noise": case.noise, "manoeuvres": case.manoeuvres, "channels": case.channels, "seed": case.seed}
        campaign = read(make(Path(place) / "campaign", case.hidden, **told))
        return diagnose(campaign, Variant(catalogue=catalogue)).rounds


def found(r: Round) -> str | None:
    """What a round puts in."""
    return r.winner.effect if r.winner else None


def changes(rounds: list[Round]) -> Iterator[tuple[str, float, int]]:
    """Each number of the policy, at each end of its range, with how many rounds are decided otherwise."""
    usual = [found(r) for r in rounds]
    for name in OF_ROUNDS:
        for value in RANGES[name]:
            policy = replace(DEFAULT, **{name: value})
            yield name, value, sum(found(r.decided_by(policy)) != e for r, e in zip(rounds, usual, strict=True))


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.policy", description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of noise, pushes and true chairs")
    parser.add_argument("--every", type=int, default=10, help="of the cases of `benchmarks.diagnosis`, every so many")
    chosen = parser.parse_args()
    console = Console()
    cases = Plan([chosen.seed]).cases[:: chosen.every]
    rounds = [r for case in track(cases, "searches", console=Console(stderr=True)) for r in rounds_of(case)]
    table = Table(title=f"{len(rounds)} rounds of {len(cases)} searches, seed {chosen.seed}")
    for heading in ("number", "as it is", "instead", "rounds decided otherwise"):
        table.add_column(heading)
    for name, value, count in changes(rounds):
        table.add_row(name, f"{getattr(DEFAULT, name):g}", f"{value:g}", str(count))
    console.print(table)


if __name__ == "__main__":
    main()
