"""Figures of the last release, measured in the same run: its source is unpacked from git and runs its own benchmark there.

The last release is the newest tag v… before the commit at hand; as long as there is none, BASELINE stands for it. Both run
in this environment, so that what differs is the project's own code.
"""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import tarfile
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path

from . import command_cost
from .command_cost import ROOT

BASELINE = "75685c1b6415bf882d1aae29207a5e446cdf7d3f"  # the last commit without this comparison
GROUPS = ("step_cost", "sensitivity_cost", "lanes_cost", "sweep_cost", "command_cost")  # what is measured of it, too
KEPT, RECORDS = Path("out/released"), Path("out/bench.json")


@dataclass(frozen=True)
class Released:
    """The source of a release, and what it is called."""

    name: str
    tree: Path

    def figures(self, group: str) -> dict[str, float]:
        """Medians of a group by what was measured. Raises CalledProcessError where it cannot be measured any more."""
        if group not in GROUPS:
            return {}
        if group == "command_cost":
            return {command_cost.WHAT: statistics.median(command_cost.seconds(self.tree))}
        words = [sys.executable, "-m", "benchmarks.bench", group]
        subprocess.run(words, cwd=self.tree, check=True, capture_output=True, text=True)
        return {row["what"]: row["median"] for row in json.loads((self.tree / RECORDS).read_text())["rows"]}


def last(root: Path = ROOT, kept: Path = KEPT, baseline: str = BASELINE) -> Released | None:
    """The last release, unpacked in `kept`; None where `root` is no checkout that has it."""
    tag = _git(root, "describe", "--tags", "--abbrev=0", "--match", "v[0-9]*", "HEAD~1")
    commit = _git(root, "rev-parse", "--verify", f"{tag or baseline}^{{commit}}")
    if not commit:
        return None
    tree = kept.absolute() / commit
    if not tree.exists():
        source = subprocess.run(["git", "archive", commit], cwd=root, check=True, capture_output=True).stdout
        with tarfile.open(fileobj=BytesIO(source)) as archive:
            archive.extractall(tree, filter="data")
    return Released(tag or f"none yet; beside it, commit {commit[:7]}", tree)


def _git(root: Path, *words: str) -> str:
    """What git says; nothing where it has no answer, or is not there."""
    try:
        done = subprocess.run(["git", *words], cwd=root, capture_output=True, text=True)
    except FileNotFoundError:
        return ""
    return done.stdout.strip() if done.returncode == 0 else ""
