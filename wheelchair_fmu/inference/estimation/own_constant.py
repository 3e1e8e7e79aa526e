"""What the readings of a run tell of a constant that is the run's own, such as the clock of a device."""

from __future__ import annotations

import numpy as np

from ..evidence.evidence import Evidence, RunEvidence
from .score import robust_variance

CERTAIN = 1e-12  # share of a prior's variance: no readings leave less


def own_constant(e: RunEvidence, name: str, prior_sd: float) -> tuple[float, float]:
    """How far a constant lies from where it was expected, to a standard deviation `prior_sd`, and its standard error.

    Residuals of a model that lacks something last, and are larger than the noise, so that they tell less than its likelihood
    has them. Their information counts as many times less as the variance of their score is larger than it should be: the
    magnitude adjustment of Pauli, Racugno and Ventura (2011, Statistica Sinica 21, 149-164). So what was expected is kept
    where readings tell next to nothing, and never less is known than before.
    """
    s, r = e.start_S[e.finite][:, list(e.uncertain).index(name)], e.r[e.finite]
    told = float(s @ s)  # about a constant that is not known beforehand, which takes its part of the residuals
    left = max(1 - prior_sd**2 * told, CERTAIN)
    lasting = float(robust_variance(Evidence((e,), (name,)), s[:, None], r)[0, 0])
    times = max(1.0, lasting / told) if told else 1.0
    kept = times * left + (1 - left)
    return prior_sd**2 * float(s @ r) / kept, prior_sd * float(np.sqrt(times * left / kept))
