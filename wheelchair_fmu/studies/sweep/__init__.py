"""Many chairs: a plan over parameters × manoeuvres × variants → one Parquet file.

::

    PLAN.toml ── plan ──> Plan ──┐                        ┌─ here: processes
                                 ├── Job ── chunks ── pool┤             ── parts ──> OUT.parquet ── indices
    campaign ── yardsticks ──────┘        (running)       └─ dask: a cluster
"""

from .engines import ENGINES
from .parts import bad, is_done, sweep
from .plan import Plan, PlanError, read_plan
from .pools import dask, here
from .running import Job
from .yardstick import Yardstick

__all__ = ["ENGINES", "Job", "Plan", "PlanError", "Yardstick", "bad", "dask", "here", "is_done", "read_plan", "sweep"]
