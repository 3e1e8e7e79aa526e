"""Clocks of loggers that were started by hand: what time on one is what time on another, from what both saw.

::

    Signals ── devices: features, smoothed alike ── views: equations between two ── lag: profile, then Gauss–Newton
                                                                                     │
    offsets: Clock by device, or why not ── network: weighted least squares ── Pairs ┘

`odd_ones_out` names runs whose pushes have a clock of their own within one file.
"""

from .network import Clock, offsets
from .pairs import Match, Pair, alike
from .pushes import Shift, odd_ones_out, push_shifts
from .signals import Signal

__all__ = ["Clock", "Match", "Pair", "Shift", "Signal", "alike", "odd_ones_out", "offsets", "push_shifts"]
