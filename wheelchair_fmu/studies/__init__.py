"""What drives FMUs through fmpy.

::

    fmu_of(variant) ── built once, kept ──> a file ──> Fmu ── run(time, inputs, values) ──> Result
                                                        └── run_campaign_run(fmu, run, values) ──> channels
"""

from .archives import fmu_of
from .driving import Fmu, Result
from .measured import run_campaign_run

__all__ = ["Fmu", "Result", "fmu_of", "run_campaign_run"]
