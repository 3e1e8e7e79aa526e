"""Put effects in for good: one that a user names, or all that a diagnosis finds, until nothing is missing or it must stop."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from ...campaign import Campaign, windows
from ...errors import Failure
from ...model.variant import Variant
from ...quantities import Parameter
from ..estimation.problem import Fit
from ..estimation.statistics import standard_errors
from ..models.factory import ModelFactory
from ..models.hypothesis import Model
from ..models.models import Models, quiet
from ..preflight.timing import clocks
from ..residual.staircase import Step
from ..search.beginning import begin
from ..search.refitting import candidate
from ..search.screen import screen
from ..search.selection import selection
from .diagnosis import Diagnosis
from .foretold import remarks


@dataclass(frozen=True)
class Improved:
    """A better variant, the fit it comes from, what its numbers are by name, the staircase that led there, and what was found
    odd in the recordings."""

    variant: Variant
    fit: Fit
    records: Mapping[str, Parameter]
    ladder: tuple[Step, ...]
    notes: tuple[str, ...]


def add(
    campaign: Campaign, chair: Variant, effects: Sequence[str], fixed: Sequence[str] = (), say: Callable[[str], None] = quiet
) -> Improved:
    """Refit the chair with these effects, one after the other; its own are estimated anew, and the noise with each, as a search
    does.

    Raises Failure where the chair with an effect cannot be simulated on this campaign, or fits it worse than without.
    """
    begun = begin(Models.of(ModelFactory(windows(campaign), chair, frozenset(fixed)), say=say))
    now = selection(begun, lambda ladder: None)
    for effect in (e for e in dict.fromkeys(effects) if e not in now.effects):
        say(f"refitting with {effect}")
        now = now.up_to(*_with(now.models, now.top, effect))
    models, fit = now.models, now.top.fit
    heard = (*begun.heard(clocks(fit.evidence, now.top.heldout)), *models.setting.notes)
    notes = (*heard, *remarks(now.ladder, models.setting.noise_model.sd))
    records = models.likelihood(now.effects).records
    return Improved(improved(chair, now.effects, fit, campaign), fit, records, now.ladder, notes)


def _with(models: Models, base: Model, effect: str) -> tuple[Models, Model]:
    screened = screen(models, base, [effect])
    found = candidate(models, base, screened[0], 1) if screened else None
    if found is None:
        raise Failure(
            f"the chair with {effect} cannot be simulated on these runs, or fits them worse than the chair without it; "
            "check its bounds and its law"
        )
    return models.settled((*base.effects, effect), found.fit)


def improved(chair: Variant, effects: Sequence[str], found: Fit, campaign: Campaign) -> Variant:
    """The chair with these effects and the estimates, their standard errors and where they come from."""
    origin = {"campaign": campaign.name, "fingerprint": campaign.fingerprint}
    notes = {"standard_errors": standard_errors(found), "origin": origin}
    values = {n: v for n, v in found.values.items() if not n.startswith("offset.")}
    return replace(chair.with_effects(effects), values={**chair.values, **campaign.known, **values}, notes=notes)


def after(d: Diagnosis, chair: Variant, campaign: Campaign) -> Variant:
    """The chair with all that a diagnosis found; of effects it cannot tell apart, the likeliest, with its rivals noted."""
    better = improved(chair, d.included, d.final, campaign)
    tied = {"tied": [list(group) for group in d.ties]} if d.ties else {}
    return replace(better, notes={**better.notes, **tied})


def with_proposal(d: Diagnosis, chair: Variant, campaign: Campaign, effect: str) -> Variant:
    """The chair with what was found and the generic term that a diagnosis proposes, now an effect of its own, `effect`."""
    assert d.proposal is not None
    old, new = f"effect.{d.proposal.effect}.", f"effect.{effect}."
    fit = d.proposal.fit
    renamed = replace(
        fit, names=tuple(n.replace(old, new) for n in fit.names), values={n.replace(old, new): v for n, v in fit.values.items()}
    )
    return improved(chair, (*d.included, effect), renamed, campaign)
