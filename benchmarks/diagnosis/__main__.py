"""`python -m benchmarks.diagnosis`: run the trials that are not done yet, then print the table.

The table comes by halves. Rules and thresholds were chosen with trials of even seeds in view; those of odd seeds were looked at
once the rules were frozen, and say what the loop is worth.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from rich.console import Console
from rich.progress import track

from .cases import Plan
from .table import as_table, floors
from .trial import trial


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.diagnosis", description=__doc__)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1], help="of noise, pushes and true chairs")
    parser.add_argument("--only", nargs="+", default=[""], help="cases with one of these in their name")
    parser.add_argument("--every", type=int, default=1, help="of these cases, every so many")
    parser.add_argument("--baselines", action="store_true", help="also run what people do without the loop")
    parser.add_argument("--out", type=Path, default=Path("out/diagnosis"), help="finished trials are kept here")
    chosen = parser.parse_args()
    chosen.out.mkdir(parents=True, exist_ok=True)
    console = Console()
    cases = [c for c in Plan(chosen.seeds).cases if any(part in c.name for part in chosen.only)][:: chosen.every]
    done = []
    for case in track(cases, "trials", console=Console(stderr=True)):
        file = chosen.out / f"{case.name}.json"
        if not file.exists():
            text = json.dumps(trial(case, chosen.baselines), ensure_ascii=False)
            file.write_text(text + "\n", encoding="utf-8")
        done.append(json.loads(file.read_text(encoding="utf-8")))
    for half, side in enumerate(("even seeds, in view when rules were chosen", "odd seeds, looked at after")):
        trials = [t for t in done if t["seed"] % 2 == half]
        if trials:
            console.print(as_table(trials, floors(done), f"{side}: {len(trials)} trials"))


if __name__ == "__main__":
    main()
