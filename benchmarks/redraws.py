"""Does a verdict hold when the same rides are recorded with other noise? python -m benchmarks.redraws [--seed N] [--draws N]

Ten chairs of the independent simulator, each driven once; what was read has its noise drawn anew. A campaign is steady where
all draws have one verdict and name the same effects.
"""

from __future__ import annotations

import argparse
import tempfile
from collections import Counter
from pathlib import Path

from rich.console import Console
from rich.progress import track
from rich.table import Table

from wheelchair_fmu.campaign import read
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.model.generic import library

from .diagnosis.cases import Case
from .independent.campaigns import make

CASES = (
    Case("null"),
    Case("effect", ("rolling_resistance_asymmetry",), 3.0),
    Case("effect", ("relaxation_length",), 3.0),
    Case("effect", ("scrub_torque",), 1.0),
    Case("effect", ("trunk_motion",), 3.0),
    Case("effect", ("camber_misalignment",), 1.0),
    Case("effect", ("gyro_scale",), 0.25),
    Case("pair", ("caster_friction", "floor_cross_slope"), 3.0),
    Case("near-tie", ("aerodynamic_drag",), 2.0, manoeuvres="straight"),
    Case("outside", ("caster_spring",), 3.0),
)
Said = tuple[str, tuple[str, ...]]


def said(case: Case, seed: int, draw: int) -> Said:
    """The verdict and the effects named, in the alphabet's order."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "campaign"
        make(folder, case.hidden, manoeuvres=case.manoeuvres, channels=case.channels, seed=seed, redraw=1000 * seed + draw)
        found = diagnose(read(folder), generic=library())
    return found.verdict, tuple(sorted({*found.effects, *(e for group in found.ties for e in group)}))


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.redraws", description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of the chairs and of how they are pushed")
    parser.add_argument("--draws", type=int, default=5, help="of the noise")
    chosen = parser.parse_args()
    console, table = (
        Console(),
        Table("hidden", "times δ", "verdicts and effects named", "draws", title="the same rides, other noise"),
    )
    steady = 0
    for case in track(CASES, "chairs", console=Console(stderr=True)):
        counted = Counter(said(case, chosen.seed, draw) for draw in range(chosen.draws)).most_common()
        steady += len(counted) == 1
        for i, ((verdict, effects), times) in enumerate(counted):
            hidden = ("" if i else " and ".join(case.effects) or "nothing", "" if i else f"{case.times:g}")
            table.add_row(*hidden, f"{verdict}: {', '.join(effects)}".removesuffix(": "), str(times))
    console.print(table)
    console.print(f"steady: {steady} of {len(CASES)}")


if __name__ == "__main__":
    main()
