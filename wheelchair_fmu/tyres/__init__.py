"""Tyres from a test rig: what was measured, the laws that fit it, and the parameters a chair needs for it.

::

    *.csv, *.tdx, *.tir ── reading ── Sweep ── half_difference ── Curve ── laws ── ConditionFit ── across ── Identified
                                                                                                              │
                                                           parameters (the FMU's) · tir (MF 5.2) ─────────────┘

Angles, forces and torques are in the paper's axes: x forward, y right, z down; slip λ is the angle from the hub's velocity to
the wheel's plane, so the lateral force has the sign of λ and the self-aligning torque the opposite one.
"""

from .identify import Identified, identify
from .reading import Measured, read

__all__ = ["Identified", "Measured", "identify", "read"]
