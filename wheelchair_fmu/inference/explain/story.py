"""The diagnosis with what it takes to tell it again: every model it went through, and the noise it found."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

from ... import __version__
from ...provenance import code_fingerprint
from ..decision.diagnosis import Diagnosis
from .ranking import as_json


def story(d: Diagnosis) -> dict[str, Any]:
    """`as_json`, with what it takes to simulate it again: `calibrated` [name, ...], `noise` (a `NoiseModel`), `models` [{step,
    values}] for steps of the staircase, the one where the search `begins`, and `values` of each refitted effect in the
    ranking. Full names, SI units. `fingerprint` is the campaign's, `made_by` says by which code."""
    content, models = as_json(d), _models(d)
    refitted = {c.effect: c.fit.values for r in reversed((*d.rounds, *d.beside)) for c in r.candidates}
    for row in content["ranking"]:
        values = models.get(f"+{row['effect']}", refitted.get(row["effect"]))
        row["values"] = None if values is None else dict(values)
    noise_model = d.models.setting.noise_model
    return {
        **content,
        "calibrated": list(d.models.names(())),
        "begins": _beginning(d),
        "noise": asdict(noise_model),
        "fingerprint": d.models.factory.campaign.fingerprint,
        "made_by": {"version": __version__, "code": code_fingerprint()},
        "models": [{"step": name, "values": dict(values)} for name, values in models.items()],
    }


def _beginning(d: Diagnosis) -> str:
    """The step from which the search began: calibrated, with the effects that the variant came with."""
    return f"+{d.already[-1]}" if d.already else "calibrated"


def _models(d: Diagnosis) -> dict[str, Mapping[str, float]]:
    """Values by step of the staircase: as given, and those fitted from where the search began."""
    first = next((i for i, step in enumerate(d.ladder) if step.name == _beginning(d)), 1)
    return {step.name: step.values for step in (d.ladder[0], *d.ladder[first:])}
