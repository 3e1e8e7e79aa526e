"""Parts of a result beside it, so that work that was killed goes on where it stood; at the end one file."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Mapping
from itertools import chain
from pathlib import Path
from types import MappingProxyType

import pyarrow as pa
import pyarrow.parquet as pq

from ..errors import Failure
from ..writing import written
from .job import ERROR, FINGERPRINT, Job
from .pools import Pool

ROW_GROUP = 65_536  # rows, about, that are in memory together when the parts are put together


def folder(out: Path) -> Path:
    """Where the parts of `out` are kept until it is there."""
    return out.with_name(out.name + ".parts")


def is_done(job: Job, out: Path) -> bool:
    """Whether `out` is this job's result already."""
    try:
        return (pq.read_schema(out).metadata or {}).get(FINGERPRINT) == job.fingerprint.encode()
    except (FileNotFoundError, pa.ArrowInvalid):
        return False


def complete(
    job: Job,
    out: Path,
    pool: Pool,
    told: Callable[[int], None] = lambda rows: None,
    known: Mapping[int, pa.Table] = MappingProxyType({}),
) -> None:
    """Do what is not done yet, and put the parts together as `out`. `told` hears how many rows are done, as they are.

    `known` are chunks whose tables another result already had.

    Raises Failure where the parts beside `out` are another job's.
    """
    if is_done(job, out):
        told(job.total)
        return
    place = _claimed(job, out)
    missing = []
    for n in range(job.chunks):
        if _part(place, n).exists():
            told(job.rows(n))
        elif n not in known:
            missing.append(n)
    for n, table in chain(((n, t) for n, t in known.items() if not _part(place, n).exists()), pool(job, missing)):
        with written(_part(place, n)) as beside:
            pq.write_table(table, beside)
        told(table.num_rows)
    _assemble(job, place, out)
    shutil.rmtree(place)


def bad(out: Path) -> tuple[int, str]:
    """How many rows gave nothing, and the first reason."""
    count, first = 0, ""
    for batch in pq.ParquetFile(out).iter_batches(columns=[ERROR]):
        reasons = batch.column(0).drop_null()
        first = first or (reasons[0].as_py() if len(reasons) else "")
        count += len(reasons)
    return count, first


def _claimed(job: Job, out: Path) -> Path:
    place = folder(out)
    place.mkdir(parents=True, exist_ok=True)
    owner = place / "fingerprint"
    if not owner.exists():
        with written(owner) as beside:
            beside.write_text(job.fingerprint)
    elif owner.read_text() != job.fingerprint:
        raise Failure(f"{place}: parts of another {job.what}; remove this folder, or give another -o")
    return place


def _part(place: Path, number: int) -> Path:
    return place / f"{number:08d}.parquet"


def _assemble(job: Job, place: Path, out: Path) -> None:
    with written(out) as beside, pq.ParquetWriter(beside, job.schema()) as writer:
        together = max(1, ROW_GROUP // job.rows(0))
        for first in range(0, job.chunks, together):
            parts = range(first, min(first + together, job.chunks))
            writer.write_table(pa.concat_tables([pq.read_table(_part(place, n)) for n in parts]))
