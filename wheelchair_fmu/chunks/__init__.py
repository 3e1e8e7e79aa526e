"""Long work in pieces that depend on nothing but their number: who does them, and how a run that was stopped goes on.

::

            ┌─ here: processes
    Job ────┤                    ── parts beside the result ── OUT.parquet
            └─ dask: a cluster
"""

from .job import ERROR, Job
from .parts import bad, complete, is_done
from .pools import Pool, dask, here

__all__ = ["ERROR", "Job", "Pool", "bad", "complete", "dask", "here", "is_done"]
