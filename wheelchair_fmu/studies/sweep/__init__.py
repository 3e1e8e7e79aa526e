"""Many chairs: a plan over parameters × manoeuvres × variants → one Parquet file.

::

    PLAN.toml ── plan ──> Plan ──┐
                                 ├── Job ── chunks (processes or a cluster) ──> OUT.parquet ── indices
    campaign ── yardsticks ──────┘   (running)
"""

from .design import INDICES
from .engines import ENGINES
from .plan import Plan, PlanError, read_plan
from .running import Job, prepare

__all__ = ["ENGINES", "INDICES", "Job", "Plan", "PlanError", "prepare", "read_plan"]
