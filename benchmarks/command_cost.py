"""What somebody waits for who types `wheelchair diagnose` on the sample campaign: a process from its start to its end.

What it compiles is compiled already, and a call that is not counted comes first; of the first diagnosis on a machine nothing
is.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from types import MappingProxyType

from .rows import Row, timed

ROOT = Path(__file__).parent.parent
WHAT, TARGET, REPEATS = "the command diagnose", 10.0, 3  # s
FIRST, FIRST_TARGET = "the command diagnose, nothing compiled yet", 15.0  # s
SAMPLE = Path("examples/sample-campaign")


def rows() -> Iterator[Row]:
    yield Row(WHAT, "s", seconds(ROOT), TARGET, note="examples/sample-campaign, in a process of its own")
    first = [_first(ROOT) for _ in range(REPEATS)]
    yield Row(FIRST, "s", first, FIRST_TARGET, note="from a checkout; a wheel brings what is compiled here")


def seconds(tree: Path) -> list[float]:
    """Of each repeat, by the package and the sample in this tree."""
    return [ms / 1e3 for ms in timed(lambda: command(SAMPLE, tree=tree), REPEATS)]


def _first(tree: Path) -> float:
    with TemporaryDirectory() as cache:
        began = perf_counter()
        command(SAMPLE, tree=tree, more={"WHEELCHAIR_CACHE": cache})
        return perf_counter() - began


def command(*words: str | Path, tree: Path = ROOT, more: Mapping[str, str] = MappingProxyType({})) -> None:
    """`diagnose` with these words, a campaign and options, by the package in this tree."""
    every = [sys.executable, "-m", "wheelchair_fmu", "diagnose", *map(str, words)]
    subprocess.run(every, cwd=tree, check=True, capture_output=True, env={**os.environ, **more})
