"""What drives FMUs through fmpy.

::

    fmu_of(variant) ── built once, kept ──> a file ──> Fmu ── run(time, inputs, values) ──> Result
                                                        └── measured.run_campaign_run(fmu, run, values) ──> channels
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .archives import fmu_of
    from .driving import Fmu, Result

__all__ = ["Fmu", "Result", "fmu_of"]


def __getattr__(name: str) -> Any:
    """Imported when they are asked for: a sweep's workers by the kernel do without fmpy, and start sooner."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from . import archives, driving

    return archives.fmu_of if name == "fmu_of" else getattr(driving, name)
