"""Many chairs: a plan over parameters × manoeuvres × variants → one Parquet file.

::

    PLAN.toml ── plan ──> Plan ──┐                        ┌─ here: processes
                                 ├── Job ── chunks ── pool┤             ── parts ──> OUT.parquet ── indices
    campaign ── yardsticks ──────┘        (running)       └─ dask: a cluster
"""

from .design import INDICES
from .engines import ENGINES
from .indices import indices
from .parts import bad, is_done, sweep
from .plan import Plan, PlanError, read_plan
from .pools import dask, here
from .running import Job, prepare
from .yardstick import Yardstick

__all__ = ["ENGINES", "INDICES", "Job", "Plan", "PlanError", "Yardstick", "bad", "dask", "here", "indices", "is_done",
           "prepare", "read_plan", "sweep"]  # fmt: skip
