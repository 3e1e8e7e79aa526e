"""docs/performance.md of what `make bench` and `make bench-large` have written:  python -m benchmarks.page

It keeps these records beside the page, as docs/performance.json, so that a page can be held against what it is made of. Where
one of the two was not run, its records stay what they are.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from wheelchair_fmu.writing import written

RECORDS, OF_LARGE = Path("out/bench.json"), Path("out/bench-large.json")
KEPT, PAGE = Path("docs/performance.json"), Path("docs/performance.md")
BEGINNING = """# How fast it is, and how fast it could be

`make bench` measures all of this; `python -m benchmarks.page` then writes this page. Times are medians, with the least and the
greatest of the repeats. What is said to be so many times faster is beside a peer of the same run on the same machine. The last
release is of the same run as well: its source is unpacked and runs its own benchmark (`benchmarks/released.py`). A limit is
what the arithmetic alone would take a core that is never kept waiting: operations are counted in the functions that are run,
and a core's rates are measured (`python -m benchmarks.limits`).
"""
LARGE = """## Large

`make bench-large` measures these; `python -m benchmarks.large` and `python -m benchmarks.fleet_cost` do so for other numbers of
runs and chairs.
"""


def page(records: dict[str, Any]) -> str:
    """The page of these records."""
    machine, rows = records["machine"], records["rows"]
    parts = [BEGINNING, _machine(machine), _table(rows), _limits(rows), _large(records.get("large"))]
    return "\n".join(part for part in parts if part)


def _machine(machine: dict[str, str]) -> str:
    said = {"core": "A core", "load": "Load average at the end", "release": "Last release"}
    return "".join(f"- {said.get(key, key.capitalize())}: {value}\n" for key, value in machine.items())


def _table(rows: list[dict[str, Any]]) -> str:
    lines = [
        "| what | median | least to greatest | last release | times faster | target | note |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        before = "" if row.get("released") is None else _with_unit(row["released"], row)
        faster = "" if row["ratio"] is None else f"{row['ratio']:.1f}×"
        lines.append(
            f"| {row['what']} | {_with_unit(row['median'], row)} | {row['least']:.3g} to {row['greatest']:.3g} | {before} | "
            f"{faster} | {_target(row)} | {row['note']} |"
        )
    return "\n".join(lines) + "\n"


def _target(row: dict[str, Any]) -> str:
    if row["target"] is None:
        return ""
    bound = f"≤ {_with_unit(row['target'], row)}" if row["ratio"] is None else f"≥ {row['target']:g}×"
    return f"{bound}: {'met' if row['met'] else '**missed**'}"


def _limits(rows: list[dict[str, Any]]) -> str:
    limited = [row for row in rows if row["limit"] is not None]
    if not limited:
        return ""
    lines = ["## Limits\n", "| what | measured | limit | off | made of, and what is between |", "|---|---|---|---|---|"]
    lines += [
        f"| {row['what']} | {_with_unit(row['median'], row)} | {_with_unit(row['limit'], row)} | "
        f"{row['median'] / row['limit']:.1f}× | {row['why']} |"
        for row in limited
    ]
    return "\n".join(lines) + "\n"


def _large(records: dict[str, Any] | None) -> str:
    return f"{LARGE}\n{_machine(records['machine'])}\n{_table(records['rows'])}" if records else ""


def _with_unit(value: float, row: dict[str, Any]) -> str:
    return f"{value:.3g} {row['unit']}".rstrip()


def main() -> int:
    records = json.loads(KEPT.read_text(encoding="utf-8")) if KEPT.exists() else {}
    if RECORDS.exists():
        records |= json.loads(RECORDS.read_text(encoding="utf-8"))
    if OF_LARGE.exists():
        records["large"] = json.loads(OF_LARGE.read_text(encoding="utf-8"))
    if "rows" not in records:
        print(f"{RECORDS}: no such file; make bench writes it", file=sys.stderr)
        return 2
    for target, content in ((KEPT, json.dumps(records, indent=2) + "\n"), (PAGE, page(records))):
        with written(target) as beside:
            beside.write_text(content, encoding="utf-8")
        print(target)
    return 0


if __name__ == "__main__":
    sys.exit(main())
