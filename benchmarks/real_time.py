"""A 1 kHz loop in a host without Python, for a minute:  python -m benchmarks.real_time [SECONDS]

Strokes, turns on the spot both ways, coasting to rest, strokes backwards, rest; each step is set, doStep(1 ms), get.
First what the FMU costs: the ride five times over without waiting, each step's least, so that what else the machine does
drops out. Then the loop itself, each step begun at its due moment, with all that the machine did to it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from rich import box
from rich.console import Console
from rich.table import Table

from .step_cost import host_program, run_host

COST = ("build", "median [µs]", "worst [µs]", "at rest / in motion")
LOOP = ("build", "median [µs]", "99.9 % [µs]", "worst [µs]", "latest wake-up [µs]", "steps missed")
BUILDS = ("default", "all")


def table(title: str, columns: Sequence[str], rows: Iterable[Sequence[str]]) -> Table:
    shown = Table(title=title, title_justify="left", box=box.SIMPLE)
    for column in columns:
        shown.add_column(column, justify="left" if column == "build" else "right")
    for row in rows:
        shown.add_row(*row)
    return shown


def main() -> int:
    steps = round(1000 * float(sys.argv[1] if len(sys.argv) > 1 else 60))
    console = Console(highlight=False, width=120)
    with TemporaryDirectory() as folder:
        host = host_program(Path(folder))
        cost = {e: run_host(host, Path(folder), e, "minute", steps) for e in BUILDS}
        rows = ((f"--effects {e}", *micro(v[:2]), f"{v[2]:.2f}") for e, v in cost.items())
        console.print(table("What a step costs", COST, rows))
        loop = {e: run_host(host, Path(folder), e, "ride", steps) for e in BUILDS}
        rows = ((f"--effects {e}", *micro(v[:4]), f"{v[4]:.0f}") for e, v in loop.items())
        console.print(table("The loop on this machine", LOOP, rows))
    return 0


def micro(values: Sequence[float]) -> list[str]:
    return [f"{v / 1e3:.2f}" for v in values]


if __name__ == "__main__":
    sys.exit(main())
