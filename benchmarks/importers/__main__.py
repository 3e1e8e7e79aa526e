"""The archives in other people's importers, as Markdown tables:  python -m benchmarks.importers [--write-docs] [fmu] [ssp]

FMPy and the plain C host run here, the others where $IMPORTERS_PYTHON points (`make importers` sets it up).
"""

from __future__ import annotations

import argparse
import sys

from . import page
from .driving import fmu_results, ssp_results
from .rows import FMU_HEAD, SSP_HEAD, head

TABLES = {"fmu": (FMU_HEAD, fmu_results), "ssp": (SSP_HEAD, ssp_results)}


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.importers", description="The archives in other importers.")
    parser.add_argument("--write-docs", action="store_true", help="put the tables into docs/importers.md and docs/ssp.md")
    parser.add_argument("tables", nargs="*", choices=[[], *TABLES], help="which; both unless given")
    options = parser.parse_args()
    for kind in options.tables or TABLES:
        names, results = TABLES[kind]
        lines = [head(names)]
        print(f"\n{lines[0]}")
        for result in results():
            lines.append(result.line())
            print(lines[-1], flush=True)
        if options.write_docs:
            page.put(kind, lines)
    return 0


if __name__ == "__main__":
    sys.exit(main())
