"""Many chairs: a plan over parameters × manoeuvres × variants → one Parquet file.

::

    PLAN.toml ── plan ──> Plan ──┐
                                 ├── Job ── chunks (processes or a cluster) ──> OUT.parquet ── indices
    campaign ── yardsticks ──────┘   (running)
"""

from .design import INDICES
from .engines import ENGINES
from .indices import indices
from .plan import Plan, PlanError, read_plan
from .running import Job, prepare
from .yardstick import Yardstick

__all__ = ["ENGINES", "INDICES", "Job", "Plan", "PlanError", "Yardstick", "indices", "prepare", "read_plan"]
