"""What models of one search have in common, so that they compare: noise, and from where every run starts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ..evidence.evidence import Evidence
from ..evidence.likelihood import Likelihood
from ..evidence.noise_model import NoiseModel


@dataclass(frozen=True)
class Setting:
    """Where nothing was found yet, runs start where the campaign has them. `paths` are the forces (n, nd), or the errors of
    pushes (n, nq), about which runs are linearised; calibration begins at the values in `begun`, if not at those given; `notes`
    are sentences on the noise."""

    noise_model: NoiseModel
    starts: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    paths: Mapping[str, np.ndarray] = field(default_factory=dict)
    begun: Mapping[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @classmethod
    def led(cls, noise_model: NoiseModel, along: Evidence, values: Mapping[str, float]) -> Setting:
        """With starts, paths and calibrated `values` of evidence `along` which forces led the runs."""
        starts = {e.run.name: dict(e.start) for e in along.runs}
        paths = {e.run.name: e.path for e in along.runs if e.path is not None}
        return cls(noise_model, starts, paths, dict(values))

    def started_as(self, likelihood: Likelihood) -> Setting:
        """With the starts and paths that a likelihood has found."""
        starts, paths = likelihood.begun
        return replace(self, starts=starts, paths=paths)
