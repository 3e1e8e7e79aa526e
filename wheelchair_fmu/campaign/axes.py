"""Axes of a campaign: the one place where ISO 8855 becomes SAE J670.

::

    SAE J670 (the model's)        ISO 8855
        x forward                     x forward
        y right                       y left
        z down                        z up
        yaw clockwise from above      yaw counter-clockwise
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

import numpy as np

from .channels import BY_NAME

SAE, ISO = "SAE-J670", "ISO-8855"
AXES = (SAE, ISO)
Value = TypeVar("Value", float, np.ndarray)


def to_sae(values: Mapping[str, Value], axes: str) -> dict[str, Value]:
    """Series by channel name, (n,) each, or constants, from `axes` to SAE J670.

    From ISO 8855, a_y, y, v, yaw, yaw_rate and floor.slope_y change sign and nothing else does: what belongs to the
    left wheel stays with the left wheel. Twice is the identity.
    """
    if axes != ISO:
        return dict(values)
    return {name: -series if BY_NAME[name].iso_sign < 0 else series for name, series in values.items()}
