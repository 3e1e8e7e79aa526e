"""Where a fitted model is asked for more than it holds for."""

from __future__ import annotations

import numpy as np

from .evidence import Evidence
from .likelihood import Likelihood


def beyond(likelihood: Likelihood, evidence: Evidence) -> list[str]:
    """Runs in which a model is beyond a limit of its own, and for how long, in words."""
    limits = {i: o for i, o in enumerate(likelihood.sensitivities.model.outputs) if o.limit}
    shares = ((e.run.name, o, float(np.mean(e.results[:, i] > 0))) for e in evidence.runs for i, o in limits.items())
    return [
        f"{run}: as fitted, {o.limit} for {share:.1%} of the time, where the model holds no longer; estimates that depend on "
        f"this run are less sure than they look{o.instead and f'; {o.instead}'}"
        for run, o, share in shares
        if share > 0
    ]
