"""A fleet on a Dask cluster of several processes, of which one is killed:  python -m benchmarks.fleet_cost [--chairs N]

Every chair has a campaign of its own, four runs of a quarter of a minute, with a drag of its own on its left wheel. When a
quarter of the chairs are done a worker process is killed, and when half are done the command is; the same command then goes on.
The table in the end must be, to the byte, that of an undisturbed run by processes, without a cluster.
"""

from __future__ import annotations

import argparse
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np
import pyarrow.parquet as pq
from distributed import LocalCluster

from . import large
from .rows import Row

CHAIRS, RUNS, MINUTES = 1000, 4, 0.25
DRAG = "effect.rolling_resistance_asymmetry.D"
DRAGS = 0.0, 3.2  # N, between which chairs' drags are drawn
LOOKED = 0.2  # s between looks at how far it is


@dataclass(frozen=True)
class Outcome:
    """What became of a fleet."""

    chairs: int
    workers: int
    seconds: float  # of both commands on the cluster
    undisturbed: float
    verdicts: dict[str, int]


def make(folder: Path, chairs: int) -> Path:
    """Campaigns of so many chairs; those that are there already stay."""
    drags = np.random.default_rng(0).uniform(*DRAGS, chairs)
    for n, drag in enumerate(drags):
        place = folder / f"chair-{n:04d}"
        if not (place / "campaign.toml").exists():
            large.make(place, RUNS, MINUTES, seed=n, hidden={DRAG: float(drag)})
    return folder


def outcome(folder: Path, out: Path, workers: int) -> Outcome:
    """Diagnose the fleet in `folder` twice, into `out`. Raises SystemExit where the tables differ."""
    out.mkdir(parents=True, exist_ok=True)
    chairs = len(list(folder.glob("*/campaign.toml")))
    disturbed, calm = out / "disturbed.parquet", out / "calm.parquet"
    for table in (disturbed, calm):
        table.unlink(missing_ok=True)
    start = perf_counter()
    with LocalCluster(
        n_workers=workers, threads_per_worker=1, processes=True, host="127.0.0.1", dashboard_address=None
    ) as cluster:
        words = _command(folder, disturbed, "--dask", cluster.scheduler_address)
        first = subprocess.Popen(words)
        _wait_for(disturbed, chairs // 4, first)
        os.kill(cluster.workers[0].pid, signal.SIGKILL)
        _wait_for(disturbed, chairs // 2, first)
        first.kill()
        first.wait()
        subprocess.run(words, check=True)
    seconds, start = perf_counter() - start, perf_counter()
    subprocess.run(_command(folder, calm, "--workers", str(workers)), check=True)
    undisturbed = perf_counter() - start
    if disturbed.read_bytes() != calm.read_bytes():
        raise SystemExit(f"{disturbed} and {calm} differ")
    found = pq.read_table(calm, columns=["verdict"]).column(0).to_pylist()
    verdicts = {str(verdict): found.count(verdict) for verdict in sorted(set(found), key=str)}
    return Outcome(chairs, workers, seconds, undisturbed, verdicts)


def _command(folder: Path, table: Path, *words: str) -> list[str]:
    return [sys.executable, "-m", "wheelchair_fmu", "fleet", str(folder), "-o", str(table), *words]


def _wait_for(table: Path, parts: int, process: subprocess.Popen[bytes]) -> None:
    """Until so many parts of the table are done."""
    while len(list(table.with_name(f"{table.name}.parts").glob("[0-9]*.parquet"))) < parts:
        if process.poll() is not None:
            raise SystemExit(f"the command ended by itself before {parts} chairs were done; give more --chairs")
        time.sleep(LOOKED)


def rows() -> Iterator[Row]:
    with TemporaryDirectory() as place:
        found = outcome(make(Path(place) / "fleet", CHAIRS), Path(place) / "out", os.cpu_count() or 1)
    said = ", ".join(f"{count} {verdict}" for verdict, count in found.verdicts.items())
    yield Row(
        f"a fleet of {found.chairs} chairs on a Dask cluster of {found.workers} processes",
        "min",
        [found.seconds / 60],
        note=f"a worker and the command killed on the way; in the end the same to the byte as undisturbed: {said}",
    )
    yield Row("the same by processes, undisturbed", "min", [found.undisturbed / 60])


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.fleet_cost", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--chairs", type=int, default=CHAIRS)
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--out", type=Path, default=Path("out/fleet-cost"), help="campaigns and tables stay there")
    chosen = parser.parse_args()
    print(outcome(make(chosen.out / f"fleet-{chosen.chairs}", chosen.chairs), chosen.out, chosen.workers))
    return 0


if __name__ == "__main__":
    sys.exit(main())
