"""Many campaigns, one for each chair of a fleet, diagnosed side by side.

::

    FOLDER ... ── folders ──> Fleet ── chunks (processes or a cluster) ──> a row for each chair ──┬── long
                              (job)                                        (rows)                 └── summary
"""

from .job import Fleet, folders
from .rows import long
from .summary import summary

__all__ = ["Fleet", "folders", "long", "summary"]
