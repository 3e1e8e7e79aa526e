"""`python -m benchmarks.improve`: does `wheelchair improve` bring the error to the floor where no effect of the catalogue does?

Five effects that no catalogue has are hidden at δ and at three δ in campaigns of the independent simulator, and each is
improved as by the command, with terms proposed and put in. At the floor an error is a little above the noise at most, on fitted
and on held-out runs, as the policy has it.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from pathlib import Path

from rich.console import Console
from rich.progress import track
from rich.table import Table
from typer.testing import CliRunner

from wheelchair_fmu.cli.main import app
from wheelchair_fmu.inference.policy import DEFAULT

from .diagnosis.cases import Case, Plan
from .diagnosis.trial import written


def improved(case: Case) -> tuple[str, list[dict[str, float | str]]]:
    """The last verdict, and the staircase up to there."""
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place)
        written(case, folder / "campaign")
        words = ("improve", folder / "campaign", "-o", folder / "better.toml", "--json", folder / "told.json")
        done = CliRunner().invoke(app, [str(word) for word in words])
        if done.exit_code:
            raise RuntimeError(done.output)
        told = json.loads((folder / "told.json").read_text(encoding="utf-8"))
        return told["verdict"], told["ladder"]


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.improve", description=__doc__)
    parser.add_argument("--seed", type=int, default=1, help="of noise, pushes and true chairs")
    chosen = parser.parse_args()
    table, there = Table(title=f"seed {chosen.seed}"), 0
    for heading in ("hidden", "times δ", "calibrated", "in the end", "steps", "last verdict"):
        table.add_column(heading)
    cases = [case for case in Plan([chosen.seed]).cases if case.kind == "outside"]
    for case in track(cases, "campaigns", console=Console(stderr=True)):
        verdict, ladder = improved(case)
        before, after = (f"{step['fit']:.3f} / {step['heldout']:.3f}" for step in (ladder[1], ladder[-1]))
        there += all(float(ladder[-1][runs]) < DEFAULT.a_little for runs in ("fit", "heldout"))
        steps = ", ".join(str(step["step"]) for step in ladder[2:])
        table.add_row(case.effects[0], f"{case.times:g}", before, after, steps, verdict)
    console = Console(width=160)
    console.print(table)
    console.print(
        f"{there} of {len(cases)} come to less than {DEFAULT.a_little} times the noise, on fitted and on held-out runs"
    )


if __name__ == "__main__":
    main()
