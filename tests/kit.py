"""What several tests need: a chair with effects, places to evaluate it at, settings of a campaign, who is whose child, files
that are made once."""

from __future__ import annotations

import os
import shutil
import time
import tomllib
from collections.abc import Callable, Collection, Mapping
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from filelock import FileLock

from wheelchair_fmu.contracts import places
from wheelchair_fmu.contracts.places import Place
from wheelchair_fmu.model.variant import Variant

# Made by `wheelchair diagnose examples/sample-campaign --json tests/sample-diagnosis.json`; tests/api holds its form.
SAMPLE_DIAGNOSIS = Path(__file__).with_name("sample-diagnosis.json")


def variant_with(*ids: str, size: float = 1.0) -> Variant:
    """A variant with these effects on, each parameter at `size` times its smallest interesting size."""
    variant = Variant().with_effects(ids)
    values = {p.name: size * p.smallest_interesting for p in variant.parameters() if p.smallest_interesting}
    return variant.with_values(values)


def anywhere(variant: Variant, rng: np.random.Generator, speed: float = 1.0, spread: float = 0.1) -> Place:
    """A random motion of this chair about `speed`, as the contracts have it."""
    return places.anywhere(variant.model(), variant.vector(), rng, speed, spread)


# what runs of the sample campaign may set, each another kind
SETTINGS = {
    "coast-down": '{ "start.psi" = 1.2, "chair.m" = 95 }',
    "straight-strokes": '{ "start.u" = 0.55 }',
    "steady-right": '{ "start.psi_dot" = 0.3 }',
    "steady-left": '{ "start.v" = 0.05, "start.x" = 2.0 }',
    "slalom-slow": '{ "tyre.C_lambda" = 3000 }',
    "slalom-quick": '{ "effect.floor_slope.x" = 0.01 }',
    "holdout-slalom": '{ "effect.relaxation_length.sigma" = 0.3 }',
    "holdout-strokes": '{ "effect.push_force_delay.tau" = 0.03 }',
}


def with_runs(source: Path, folder: Path, names: Collection[str]) -> Path:
    """A copy of a campaign, in `folder`, with these of its runs alone."""
    shutil.copytree(source, folder)
    file = folder / "campaign.toml"
    head, *runs = file.read_text(encoding="utf-8").split("[[run]]")
    kept = [run for run in runs if Path(tomllib.loads(run)["file"]).stem in names]
    assert len(kept) == len(names), f"no such runs in {source}"
    file.write_text("[[run]]".join([head, *kept]), encoding="utf-8")
    return folder


def with_settings(source: Path, folder: Path, settings: Mapping[str, str] = SETTINGS) -> Path:
    """A copy of a campaign, in `folder`, some of whose runs `set` something."""
    shutil.copytree(source, folder)
    file = folder / "campaign.toml"
    text = file.read_text(encoding="utf-8")
    for name, own in settings.items():
        line = f'file = "runs/{name}.csv"\n'
        assert line in text, f"no run {name} in {source}"
        text = text.replace(line, f"{line}set = {own}\n")
    file.write_text(text, encoding="utf-8")
    return folder


def tracked(folder: Path) -> Path:
    """The campaign in `folder` with columns of position and heading, to a hundredth of what wheels and gyro add up to."""
    for file in (folder / "runs").glob("*.csv"):
        rows = pd.read_csv(file)
        dt = np.gradient(rows["time [s]"])
        yaw = np.cumsum(rows["yaw_rate [rad/s]"] * dt)
        step = (rows["wheel_speed_l [m/s]"] + rows["wheel_speed_r [m/s]"]) / 2 * dt
        where = {"x [m]": np.cumsum(step * np.cos(yaw)), "y [m]": np.cumsum(step * np.sin(yaw)), "yaw [rad]": yaw}
        rows.assign(**{name: series.round(2) for name, series in where.items()}).to_csv(file, index=False)
    file = folder / "campaign.toml"
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("[noise]", "[noise]\nx = 0.004\ny = 0.004\nyaw = 0.004\n#", 1), encoding="utf-8")
    return folder


def shared(folders: pytest.TempPathFactory, name: str, make: Callable[[Path], object]) -> Path:
    """A folder that `make` has filled, once for all workers of pytest-xdist. Nobody is to change it."""
    root = folders.getbasetemp()
    if "PYTEST_XDIST_WORKER" in os.environ:
        root = root.parent
    folder, whole = root / name, root / f"{name}.whole"
    with FileLock(root / f"{name}.lock"):
        if not whole.exists():
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
            make(folder)
            whole.touch()
    return folder


def descendants(pid: int) -> set[int]:
    """The processes that a process has started, and those that these have started, by Linux' /proc."""
    parents = {}
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            words = (folder / "stat").read_text().rpartition(")")[2].split()
        except (FileNotFoundError, ProcessLookupError):  # it has just ended
            continue
        if words[0] != "Z":
            parents[int(folder.name)] = int(words[1])
    found: set[int] = set()
    newest = {pid}
    while newest:
        newest = {p for p, parent in parents.items() if parent in newest} - found
        found |= newest
    return found


def gone(processes: set[int], seconds: float = 10.0) -> bool:
    """Whether all these end in time."""
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        if not any(_runs(p) for p in processes):
            return True
        time.sleep(0.05)
    return False


def _runs(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False
