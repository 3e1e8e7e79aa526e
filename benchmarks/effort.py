"""`python -m benchmarks.effort`: does a search that spares no work say anything else?

Campaigns of the independent simulator are searched twice, with the usual effort and with a thorough one (see
`inference/policy.py`), and what both say is printed where it differs, with how much longer the thorough one took.
"""

from __future__ import annotations

import argparse
import time

from rich.console import Console
from rich.progress import track

from wheelchair_fmu.campaign import Campaign
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.policy import USUAL, Effort
from wheelchair_fmu.model.generic import library
from wheelchair_fmu.model.variant import Variant

from .diagnosis.cases import Case, Plan
from .diagnosis.trial import asked


def said(campaign: Campaign, chair: Variant, effort: Effort) -> tuple[str, float]:
    """The verdict with the effects that it names, and the processor seconds that it took."""
    began = time.process_time()
    found = diagnose(campaign, chair, library(), effort=effort)
    groups = [*found.ties, *((e,) for e in found.effects if not any(e in tie for tie in found.ties))]
    named = ", ".join(sorted(" or ".join(sorted(group)) for group in groups))
    return f"{found.verdict}: {named or 'nothing'}", time.process_time() - began


def compared(case: Case) -> tuple[str, str, float]:
    """What is said of a case with the usual effort and with a thorough one, and how many times as long the second took."""
    with asked(case) as (campaign, chair):
        (usual, short), (thorough, long) = (said(campaign, chair, effort) for effort in (USUAL, Effort.thorough()))
    return usual, thorough, long / short


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.effort", description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of noise, pushes and true chairs")
    parser.add_argument("--every", type=int, default=12, help="of the cases of `benchmarks.diagnosis`, every so many")
    chosen = parser.parse_args()
    console, cases = Console(width=160), Plan([chosen.seed]).cases[:: chosen.every]
    same, longer = 0, list[float]()
    for case in track(cases, "searches", console=Console(stderr=True)):
        usual, thorough, times = compared(case)
        longer.append(times)
        same += usual == thorough
        if usual != thorough:
            console.print(f"{case.name}: {usual}; thoroughly, {thorough}")
    median = sorted(longer)[len(longer) // 2]
    console.print(
        f"{same} of {len(cases)} searches, seed {chosen.seed}, say the same; thorough ones take {median:.1f} times as long"
    )


if __name__ == "__main__":
    main()
