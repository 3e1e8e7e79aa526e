"""What drives FMUs through fmpy.

::

    fmu_of(variant) ── built once, kept ──> a file ──> Fmu ── run(time, inputs, values) ──> Result
                                                        └── measured.run_campaign_run(fmu, run, values) ──> channels
"""

from .archives import fmu_of
from .driving import Fmu, Result

__all__ = ["Fmu", "Result", "fmu_of"]
