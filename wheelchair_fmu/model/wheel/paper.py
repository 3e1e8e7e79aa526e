"""Rear wheels to the letter: they roll forward, and there are no brakes."""

from __future__ import annotations

from ..chassis import per_wheel
from ..stage import Alternative, stage
from .rolling import ALONG, FRICTION, patches


@stage(*FRICTION)
def brakes_paper():
    """There are none in the paper."""
    return per_wheel(0.0), per_wheel(0.0), per_wheel(1.0)


@stage(*ALONG)
def rear_longitudinal_paper(F_t, D_w, d_r, v_xw):
    """As in (20): always forward, so resistance is constant."""
    return F_t - D_w - d_r * v_xw, v_xw, F_t


LAW = Alternative("paper", (brakes_paper, patches, rear_longitudinal_paper))
