"""The staircase: what is left after each thing that was done to a model."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..estimation.statistics import finite
from ..evidence.evidence import Evidence
from .physical import Errors, as_json, channel_errors


@dataclass(frozen=True)
class Step:
    """One step of the staircase: whitened RMS on fitted and on held-out runs, the errors of both by run and channel, the
    whitened RMS of both by channel, and the fitted `values` of the model that leaves them."""

    name: str
    fit: float
    heldout: float
    fit_errors: Errors = field(default_factory=dict)
    heldout_errors: Errors = field(default_factory=dict)
    fit_whitened: Mapping[str, float] = field(default_factory=dict)
    heldout_whitened: Mapping[str, float] = field(default_factory=dict)
    values: Mapping[str, float] = field(default_factory=dict)

    @classmethod
    def of(cls, name: str, fitted: Evidence, held: Evidence, values: Mapping[str, float]) -> Step:
        """The step up to a model of these values that leaves this on fitted and on held-out runs."""
        errors = channel_errors(fitted), channel_errors(held)
        return cls(name, fitted.rms, held.rms, *errors, fitted.channel_rms(), held.channel_rms(), values)

    @property
    def left(self) -> float:
        """What is left on fitted and on held-out runs alike."""
        return min(self.fit, self.heldout) if np.isfinite(self.heldout) else self.fit

    @property
    def physical(self) -> Mapping[str, Mapping[str, Any]]:
        """What is left of each channel, in its unit; see `physical.as_json`."""
        return as_json(self.fit_errors, self.heldout_errors)

    def as_json(self) -> dict[str, Any]:
        """The keys that are fixed for a step of the `ladder`; by channel the error in its unit, on held-out runs, or on fitted
        ones where none were held out; and `channels`, the errors of each, on fitted and on held-out runs, in its unit and
        whitened."""
        physical = self.physical
        told = {c: e["fit_rms"] if e["heldout_rms"] is None else e["heldout_rms"] for c, e in physical.items()}
        channels = {c: self._channel(c, e) for c, e in physical.items()}
        return {"step": self.name, "fit": self.fit, "heldout": finite(self.heldout), "physical": told, "channels": channels}

    def _channel(self, channel: str, error: Mapping[str, Any]) -> dict[str, Any]:
        return {
            **{key: error[key] for key in ("unit", "fit_rms", "heldout_rms")},
            "fit": finite(self.fit_whitened.get(channel, np.nan)),
            "heldout": finite(self.heldout_whitened.get(channel, np.nan)),
        }
