"""What models of one search have in common, so that they compare: noise, and from where every run starts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from ..evidence.evidence import Begin, Evidence, begins_of
from ..evidence.noise_model import NoiseModel


@dataclass(frozen=True)
class Setting:
    """`begins` is by run from where it starts, and about what it is linearised; where nothing was found yet, runs start where
    the campaign has them. Calibration begins at `values`, if not at those given; `notes` are sentences on the noise."""

    noise_model: NoiseModel
    begins: Mapping[str, Begin] = field(default_factory=dict)
    values: Mapping[str, float] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    @classmethod
    def led(cls, noise_model: NoiseModel, along: Evidence, values: Mapping[str, float]) -> Setting:
        """With starts, paths and calibrated `values` of evidence `along` which forces led the runs."""
        return cls(noise_model, {e.run.name: Begin(dict(e.start), e.path) for e in along.runs}, dict(values))

    def continued(self, *found: Evidence) -> Setting:
        """With runs that begin where evidence has found that they do."""
        return replace(self, begins={**self.begins, **begins_of(*found)})
