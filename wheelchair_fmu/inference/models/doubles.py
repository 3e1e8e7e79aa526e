"""Effects that are the very thing that a nuisance of the campaign stands for: they are never tested beside that."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..estimation.problem import Fit
from ..evidence.evidence import Evidence
from ..evidence.likelihood import Likelihood
from .factory import ModelFactory

SAME = 1e-6  # of a slope: all that an effect leaves of one by a nuisance


def doubles(
    likelihood: Likelihood, factory: ModelFactory, offsets: Sequence[str], calibrated: Fit
) -> dict[str, frozenset[str]]:
    """By effect, those of the sensors' offsets that do what it does, by slopes where runs are as `calibrated`."""
    own = {e: factory.parameters(e) for e in factory.light}
    names = [*offsets, *(n for parameters in own.values() for n in parameters)]
    here = likelihood.evidence(factory.campaign.fit, calibrated.values, names)
    found = {e: _same(here, parameters, offsets) for e, parameters in own.items() if parameters}
    return {e: same for e, same in found.items() if same}


def _same(here: Evidence, parameters: Sequence[str], offsets: Sequence[str]) -> frozenset[str]:
    own, columns = (here.S[:, [here.by.index(n) for n in names]] for names in (parameters, offsets))
    rest = columns - own @ np.linalg.lstsq(own, columns, rcond=None)[0]
    same = np.linalg.norm(rest, axis=0) < SAME * np.linalg.norm(columns, axis=0)
    return frozenset(n for n, s in zip(offsets, same, strict=True) if s)
