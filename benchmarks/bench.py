"""Speed and accuracy beside peers in the same run:  python -m benchmarks.bench"""

from __future__ import annotations

import json
import os
import platform
import sys
from importlib.metadata import version
from pathlib import Path

from rich.console import Console

from wheelchair_fmu.cli.files import written
from wheelchair_fmu.engine import compiler

from . import run_cost, step_cost, sweep_cost
from .rows import table

TARGET = Path("out/bench.json")
PACKAGES = ("casadi", "numpy", "scipy", "fmpy", "pyarrow")


def machine() -> dict[str, str]:
    return {
        "processor": _processor(), "cores": str(os.cpu_count()), "system": platform.platform(),
        "compiler": compiler.version(), "python": platform.python_version(), **{name: version(name) for name in PACKAGES},
    }  # fmt: skip


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        return platform.processor()
    return next((line.partition(":")[2].strip() for line in lines if line.startswith("model name")), platform.machine())


def main() -> int:
    console = Console(highlight=False, width=180)
    on = machine()
    rows = []
    with Console(stderr=True).status("measuring"):
        for group in (step_cost, run_cost, sweep_cost):
            rows += list(group.rows())
    console.print(", ".join(f"{key} {value}" for key, value in on.items()))
    console.print(table(rows))
    with written(TARGET) as beside:
        beside.write_text(json.dumps({"machine": on, "rows": [row.as_json() for row in rows]}, indent=2) + "\n")
    console.print(str(TARGET))
    return 0


if __name__ == "__main__":
    sys.exit(main())
