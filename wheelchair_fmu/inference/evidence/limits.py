"""Where a model is asked for more than it holds for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ...quantities import Output
from .evidence import Evidence
from .likelihood import Likelihood

LESS_SURE = "; estimates that depend on this run are less sure than they look"


def beyond(likelihood: Likelihood, evidence: Evidence) -> list[str]:
    """Runs in which a fitted model is beyond a limit of its own, and for how long, in words."""
    outputs = likelihood.sensitivities.model.outputs
    shares = ((e.run.name, beyond_limits(e.results, outputs)) for e in evidence.runs)
    return [told for run, by in shares for told in in_words(run, "as fitted", by, LESS_SURE)]


def beyond_limits(results: np.ndarray, outputs: Sequence[Output]) -> dict[Output, float]:
    """The limits that a run's results (n, ny) are beyond, and for what share of its samples."""
    shares = {o: float(np.mean(results[:, i] > 0)) for i, o in enumerate(outputs) if o.limit}
    return {o: share for o, share in shares.items() if share > 0}


def in_words(run: str, how: str, beyond: Mapping[Output, float], then: str = "") -> list[str]:
    """A sentence for each limit that a run is beyond."""
    return [
        f"{run}: {how}, {o.limit} for {share:.1%} of the time, where the model holds no longer{then}"
        f"{o.instead and f'; {o.instead}'}"
        for o, share in beyond.items()
    ]
