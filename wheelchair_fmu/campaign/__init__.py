"""Measurements: a folder with campaign.toml and recordings, read into SI units and SAE J670 axes, or all its faults.

::

    campaign.toml ── document ──┐
                                ├── draft: bind columns, units, axes, cut ── checks ── Campaign | faults
    *.csv, ... ── tables ───────┘
"""

from ..faults import Fault
from .axes import to_sae
from .channels import BY_NAME, CHANNELS, INPUTS, Channel
from .condensed import DENSE, SPAN, condensed
from .formats import read_smartwheel
from .moving import moving, pace, sets_off
from .reading import Judged, check, fingerprint, judged, read
from .recorded import Recorded
from .records import Baseline, Campaign, Clock, Run
from .windows import covered, pieces, windows

__all__ = [
    "BY_NAME",
    "CHANNELS",
    "DENSE",
    "INPUTS",
    "SPAN",
    "Baseline",
    "Campaign",
    "Channel",
    "Clock",
    "Fault",
    "Judged",
    "Recorded",
    "Run",
    "check",
    "condensed",
    "covered",
    "fingerprint",
    "judged",
    "moving",
    "pace",
    "pieces",
    "read",
    "read_smartwheel",
    "sets_off",
    "to_sae",
    "windows",
]
