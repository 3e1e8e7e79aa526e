"""Speed and accuracy beside peers in the same run:  python -m benchmarks.bench [GROUP ...]"""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
from collections.abc import Sequence
from dataclasses import replace
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from subprocess import CalledProcessError

from rich.console import Console

from wheelchair_fmu.engine import compiler
from wheelchair_fmu.writing import written

from . import released
from .released import Released
from .rows import Row, table

FIGURE = Path("out/growth.png")
# Imported where they run: the processes of fmpy's loop begin with this file, and need none of what the others do.
GROUPS = (
    *("step_cost", "run_cost", "sensitivity_cost", "steady_cost", "lanes_cost"),
    *("file_cost", "sweep_cost", "loop_cost", "command_cost", "search_cost", "page_cost"),
)
LARGE = ("large", "fleet_cost")  # half an hour and more; kept apart, and a section of their own on the page
TARGETS = {False: Path("out/bench.json"), True: Path("out/bench-large.json")}
PACKAGES = ("casadi", "numpy", "scipy", "fmpy", "pyarrow")


def machine() -> dict[str, str]:
    return {
        "processor": _processor(),
        "cores": str(os.cpu_count()),
        "system": platform.platform(),
        "compiler": compiler.version(),
        "python": platform.python_version(),
        **{name: version(name) for name in PACKAGES},
    }


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), platform.machine())


def main(groups: Sequence[str] = ()) -> int:
    """Measure these groups, or all and how cost grows, and some of the last release beside them."""
    from . import growth, limits

    console = Console(highlight=False, width=200)
    on = machine()
    rows: list[Row] = []
    before = released.last()
    with Console(stderr=True).status("measuring") as status:
        for name in groups or GROUPS:
            group = import_module(f".{name}", __package__)
            status.update(f"measuring: {(group.__doc__ or '').partition('.')[0].partition(':')[0]}")
            found = list(group.rows())
            figures = _of_release(before, name, console)
            rows += [replace(row, released=figures.get(row.what)) for row in found]
        lines = []
        if not groups:
            status.update("measuring how cost grows")
            lines = growth.lines()
            rows += list(growth.rows(lines))
    on["release"] = before.name if before else "not at hand"
    on["core"] = f"{limits.core(1)}; {limits.widest()}"
    on["load"] = " ".join(f"{load:.1f}" for load in os.getloadavg()) if hasattr(os, "getloadavg") else "not known"
    console.print(", ".join(f"{key} {value}" for key, value in on.items()))
    console.print(table(rows))
    target = TARGETS[bool(groups) and set(groups) <= set(LARGE)]
    with written(target) as beside:
        beside.write_text(json.dumps({"machine": on, "rows": [row.as_json() for row in rows]}, indent=2) + "\n")
    console.print(target)
    if lines:
        with written(FIGURE) as beside:
            growth.figure(lines).savefig(beside, dpi=150)
        console.print(FIGURE)
    missed = [row for row in rows if row.met is False]
    console.print(f"{sum(row.met is True for row in rows)} targets met, {len(missed)} missed")
    for row in missed:
        console.print(f"MISSED  {row.what}: {row.against_target()}")
    return 0


def _asked(words: Sequence[str]) -> list[str]:
    """The groups named on the command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.bench", description=main.__doc__)
    parser.add_argument("groups", nargs="*", metavar="GROUP", help=f"of {', '.join(GROUPS)}, or {' and '.join(LARGE)}")
    groups: list[str] = parser.parse_args(words).groups
    unknown = [name for name in groups if name not in (*GROUPS, *LARGE)]
    if unknown:
        parser.error(f"no group {', '.join(unknown)}; there are {', '.join((*GROUPS, *LARGE))}")
    return groups


def _of_release(before: Released | None, group: str, console: Console) -> dict[str, float]:
    """Medians by what was measured."""
    try:
        return before.figures(group) if before else {}
    except CalledProcessError as error:
        console.print(f"{group}: the last release ({before.name}) cannot be measured: {error.stderr.strip()}")
        return {}


if __name__ == "__main__":
    sys.exit(main(_asked(sys.argv[1:])))
