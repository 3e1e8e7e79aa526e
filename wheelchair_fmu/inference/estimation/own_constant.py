"""What the readings of a run tell of a constant that is the run's own, such as the clock of a device."""

from __future__ import annotations

import numpy as np

from ..evidence.evidence import Evidence, RunEvidence
from .score import robust_variance

CERTAIN = 1e-12  # share of a prior's variance: no readings leave less


def own_constant(e: RunEvidence, *names: str) -> tuple[float, float]:
    """How far a constant lies from where it was expected, and its standard error; with two names, their difference.

    Residuals of a model that lacks something last, and are larger than the noise, so that they tell less than its likelihood
    has them. Their information counts as many times less as the variance of their score is larger than it should be: the
    magnitude adjustment of Pauli, Racugno and Ventura (2011, Statistica Sinica 21, 149-164). So what was expected is kept
    where readings tell next to nothing, and never less is known than before.
    """
    sign, known, r = dict(zip(names, (1.0, -1.0), strict=False)), np.array(list(e.uncertain.values())), e.r[e.finite]
    wanted = np.array([sign.get(name, 0.0) for name in e.uncertain])
    variance = float(wanted**2 @ known**2)
    q = e.start_S[e.finite] @ (known**2 * wanted)  # covariances of the residuals with it
    told = float(q @ q)
    if not told:
        return 0.0, float(np.sqrt(variance))
    left = max(1 - told / variance, CERTAIN)
    times = max(1.0, float(robust_variance(Evidence((e,), names[:1]), q[:, None], r)[0, 0]) / told)
    kept = times * left + (1 - left)
    return float(q @ r) / kept, float(np.sqrt(variance * times * left / kept))
