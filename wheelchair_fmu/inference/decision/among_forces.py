"""Forces that nobody recorded: how strong they are beside a model, the models of a search among them, and whether it counts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace

from ...errors import SimulationError
from ..estimation.problem import Fit
from ..evidence.disturbance import Strength, acting, strength
from ..evidence.evidence import Evidence
from ..evidence.noise_model import NoiseModel
from ..models.models import Models
from ..models.setting import Setting
from ..residual.staircase import Step
from ..residual.unexplained import Unexplained, unexplained
from .foretold import on_led_runs, worse

FORCES = "unrecorded forces"  # the step of the staircase that has them among the noise


def needed(models: Models, effects: Sequence[str], at: Fit) -> tuple[Strength, Evidence]:
    """How strong forces are that a fit with these effects needs, and the evidence for it; the fit's own where it has a generic
    term, which no likelihood of the search knows, and where no force can lead the runs, as casters flip by chance."""
    likelihood = models.likelihood(effects)
    if set(at.names) <= set(likelihood.records):
        with suppress(SimulationError):
            return acting(likelihood, at.values)
    return strength(at.evidence, likelihood.chair(at.values), likelihood.noise_model), at.evidence


def led(models: Models, calibrated: Fit, forces: Strength, along: Evidence) -> Models:
    """The models of the same campaign, with its columns and clocks as they were found, along such forces, as they lead the
    calibrated model's runs."""
    w, values = models.factory, calibrated.values
    noise_model = forces.put_into(NoiseModel(w.campaign.noise))
    return replace(models, factory=w.led(), setting=Setting.led(noise_model, along, values))


def left(models: Models, effects: Sequence[str], at: Fit, before: Strength) -> Unexplained:
    """The force that the last model of a search lacks, where the calibrated one lacked so much `before`, and what orders it."""
    after, evidence = needed(models, effects, at)
    return unexplained(models.likelihood(effects), at, before, after, evidence)


def staircase(
    first: Sequence[Step], values: Mapping[str, float], among: Sequence[Step], models: Models
) -> tuple[Step, ...] | None:
    """The steps up to the calibrated model of a search without such forces, of these `values`, and those of the search `among`
    them, with its `models`; None where its last model foretells held-out runs worse than values that were merely calibrated:
    forces hold it up, and it is no chair on a floor."""
    nominal, calibrated = first[0], on_led_runs(first[1], values, models)
    if worse(calibrated, among[-1]):
        return None
    return nominal, calibrated, replace(among[1], name=FORCES), *among[2:]
