"""Commands that do their work in chunks: where it runs, how far it is, and that it can be taken up again."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import pyarrow as pa
import typer
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from ..chunks import Job, Pool, complete, dask, here
from ..errors import UsageError
from .group import console

Workers = Annotated[
    int | None,
    typer.Option("--workers", "--processes", min=1, help="How many work at once on this machine; all cores unless given."),
]
Address = Annotated[str | None, typer.Option("--dask", metavar="ADDRESS", help="The scheduler of a Dask cluster.")]


def pool_of(address: str | None, workers: int | None) -> Pool:
    """The pool that the options ask for."""
    if address and workers:
        raise UsageError("--workers is for this machine, --dask for a cluster; give one of them")
    return dask(address) if address else here(workers or _cores())


def done_with_a_bar(job: Job, output: Path, pool: Pool, words: str, known: Mapping[int, pa.Table] | None = None) -> None:
    """Complete the job, or what is left of it and not `known`; `words` are what the bar counts."""
    columns = (TextColumn("{task.description}", markup=False), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    out = console(stderr=True)
    try:
        with Progress(*columns, console=out, disable=not out.is_terminal) as bar:  # a log or a notebook needs none
            task = bar.add_task(words, total=job.total)
            complete(job, output, pool, lambda rows: bar.advance(task, rows), known or {})
    except KeyboardInterrupt:
        console(stderr=True).print(f"what is done is kept beside {output}; the same command goes on from there")
        raise


def _cores() -> int:
    """Those that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
