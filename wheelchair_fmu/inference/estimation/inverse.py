"""Inverses of information matrices whose parameters have units of their own."""

from __future__ import annotations

import numpy as np


def inverse(information: np.ndarray) -> np.ndarray:
    """The pseudo-inverse (k, k) of an information matrix (k, k), with every parameter measured in its own standard error.

    Which directions count as unseen must not depend on units: a stiffness in N/rad has an information of 1e-6 beside one of 1e9
    for an angle in rad, and by the size of the matrix it would count as unseen, as known without error.
    """
    sizes = np.sqrt(np.maximum(np.diag(information), 0.0))
    scale = np.divide(1.0, sizes, out=np.zeros_like(sizes), where=sizes > 0)
    return scale[:, None] * np.linalg.pinv(information * scale[:, None] * scale, hermitian=True) * scale
