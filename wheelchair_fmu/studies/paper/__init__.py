"""The paper's own study, sections 6.1 to 6.3, run through the FMU.

::

    Setting (what the text leaves open) ──> Runs (each run once) ──> STATEMENTS: our figure, holds or not
                                                              └────> FIGURES 12 to 19: lines to draw
    OPEN, one value at a time ──> ranges: where each statement holds
"""

from .figures import FIGURES, FamilyFigure
from .open_values import OPEN, OpenValue, Range, ranges
from .runs import Runs, Setting
from .statements import STATEMENTS, Finding, Statement

__all__ = [
    "FIGURES",
    "OPEN",
    "STATEMENTS",
    "FamilyFigure",
    "Finding",
    "OpenValue",
    "Range",
    "Runs",
    "Setting",
    "Statement",
    "ranges",
]
