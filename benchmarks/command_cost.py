"""What somebody waits for who types `wheelchair diagnose` on the sample campaign: a process from its start to its end.

What it compiles is compiled already; a call that is not counted comes first.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

from .rows import Row, timed

ROOT = Path(__file__).parent.parent
WHAT, TARGET, REPEATS = "the command diagnose", 10.0, 3  # s


def rows() -> Iterator[Row]:
    yield Row(WHAT, "s", seconds(ROOT), TARGET, note="examples/sample-campaign, in a process of its own")


def seconds(tree: Path) -> list[float]:
    """Of each repeat, by the package and the sample in this tree."""
    words = [sys.executable, "-m", "wheelchair_fmu", "diagnose", "examples/sample-campaign"]
    call = lambda: subprocess.run(words, cwd=tree, check=True, capture_output=True)  # noqa: E731
    return [ms / 1e3 for ms in timed(call, REPEATS)]
