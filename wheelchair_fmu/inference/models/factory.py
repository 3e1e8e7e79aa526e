"""Benches for any set of effects: each as light as it can be, made once.

An effect that brings a state makes every simulation dearer, and one more model to compile. Those that bring none are in one
model together, off or on, and beside effects with states only where somebody asks for any.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from dataclasses import replace

import numpy as np

from ...campaign import BY_NAME, Campaign, moving, sets_off
from ...campaign.channels import MOMENTUM
from ...model.stage import Effect
from ...model.variant import Variant
from ...model.wheelchair import adds_state
from ..evidence.evidence import Evidence
from ..evidence.likelihood import Likelihood, driven
from ..evidence.noise_model import NoiseModel
from ..preflight.timing import Late, retimed

MEASURED = ("chair.m", "chair.a", "chair.b", "chair.t_r")  # by scales and tape, well enough to be doubted only a little
CALIBRATED = ("tyre.C_lambda", "resistance.f_r", "resistance.f_f", "chair.I_z", *MEASURED)


SCALE = "rider.scale"
ONSET = "resistance.onset"
TOGETHER = "+"  # between the names of effects in that of their group


def _of_the_body(campaign: Campaign) -> tuple[str, ...]:
    """What is calibrated where the motion of the rider's body was recorded: how much of it that is."""
    return (SCALE,) if BY_NAME[MOMENTUM].fmu in driven(campaign) else ()


def _of_a_standing_start(campaign: Campaign) -> tuple[str, ...]:
    """What is calibrated where a chair sets off: nobody measures how its drag builds up from rest, and it decides when it lets
    go."""
    return (ONSET,) if sets_off(campaign) else ()


OF_CAMPAIGNS = (SCALE, ONSET)  # what is calibrated of some only


class ModelFactory:
    """A campaign, the variant it is compared with, and a likelihood for every question.

    `calibrated` are the parameters that every fit estimates, `fixed` those that nobody estimates. `given` are the values that
    the variant's own effects have for a start; they are estimated again, unless they are fixed.
    """

    def __init__(self, campaign: Campaign, variant: Variant, fixed: Iterable[str] = (), calibrated: Iterable[str] = CALIBRATED):
        self.fixed = frozenset(fixed)
        names = (*calibrated, *_of_the_body(campaign), *_of_a_standing_start(campaign))
        self.calibrated = tuple(n for n in dict.fromkeys(names) if n not in self.fixed)
        self.given = {n: v for n, v in variant.values.items() if n.startswith("effect.") and n not in self.fixed}
        self.campaign = campaign
        self.variant = replace(variant, values={n: v for n, v in variant.values.items() if n not in self.given})
        self.catalogue: dict[str, Effect] = dict(variant.catalogue)
        self.groups = groups_of(self.catalogue)
        self.demanding = [e for e in self.catalogue if self.catalogue[e].needs]
        self.heavy = [e for e in self.catalogue if e not in self.demanding and adds_state(variant.choice, self.catalogue[e])]
        self.light = [e for e in self.catalogue if e not in self.demanding and e not in self.heavy]
        self.noise_model = NoiseModel(campaign.noise)
        self._benches: dict[tuple[frozenset[str], bool], Likelihood] = {}
        self.starts: dict[str, dict[str, float]] = {}
        self.paths: dict[str, np.ndarray] = {}
        self.leads = False  # are runs led along the forces that nobody recorded?
        self.begun: dict[str, float] = {}  # calibrated values from where calibration starts, if not from those given

    def led(self, along: Evidence, values: Mapping[str, float]) -> ModelFactory:
        """The same, of where the chair rolls, with every run led along the forces that nobody recorded: from starts, paths and
        calibrated `values` of evidence `along` which they led."""
        other = ModelFactory(moving(self.campaign), self.variant, self.fixed, self._usual)
        other.given, other.noise_model, other.leads, other.begun = self.given, self.noise_model, True, dict(values)
        other.starts = {e.run.name: dict(e.start) for e in along.runs}
        other.paths = {e.run.name: e.path for e in along.runs if e.path is not None}
        return other

    @property
    def _usual(self) -> list[str]:
        """What is calibrated of any campaign."""
        return [n for n in self.calibrated if n not in OF_CAMPAIGNS]

    def likelihood(self, effects: Iterable[str] = ()) -> Likelihood:
        """The likelihood on which these effects may be on."""
        wanted = self._members(effects)
        heavy = wanted.difference(self.light)
        return self._likelihood(wanted if heavy and heavy == wanted else {*self.light, *heavy})

    def wide(self, effects: Iterable[str] = ()) -> Likelihood:
        """The likelihood on which these effects, and all light ones, may be on."""
        return self._likelihood({*self.light, *self._members(effects)})

    def rerun(self, effects: Iterable[str] = ()) -> Likelihood:
        """A likelihood on which these effects may be on, and that only runs evidence again: it is compiled in half the time."""
        return self._likelihood(self._members(effects), derives=False)

    def _members(self, effects: Iterable[str]) -> set[str]:
        """These effects, the members of those that are groups, and the variant's own."""
        return {member for e in (*effects, *self.variant.effects) for member in self.members(e)}

    def members(self, effect: str) -> tuple[str, ...]:
        """The effects of a group, or the one effect that this is."""
        return self.groups.get(effect, (effect,))

    def _likelihood(self, effects: set[str], derives: bool = True) -> Likelihood:
        key = frozenset(effects), derives
        if key not in self._benches:
            variant = self.variant.with_effects(e for e in self.catalogue if e in effects)
            columns = (
                *dict.fromkeys((*self.calibrated, ONSET)),
                *(n for e in self.catalogue if e in effects for n in self.parameters(e)),
            )
            self._benches[key] = Likelihood(self.campaign, variant, None, columns, derives, self.leads)
        likelihood = self._benches[key]
        likelihood.noise_model = self.noise_model
        likelihood.starts.update(self.starts)
        likelihood.paths.update(self.paths)
        return likelihood

    def leave_out(self, channels: Container[str]) -> None:
        """Go on without these channels, and without runs that have no other."""
        kept = (replace(r, channels={c: v for c, v in r.channels.items() if c not in channels}) for r in self.campaign.runs)
        self.campaign = replace(self.campaign, runs=tuple(r for r in kept if r.channels))
        self._benches.clear()

    def retime(self, late: Mapping[str, Late]) -> None:
        """Go on with the pushes of these runs at the time when the chair felt them."""
        if late:
            runs = tuple(retimed(r, late[r.name]) if r.name in late else r for r in self.campaign.runs)
            self.campaign = replace(self.campaign, runs=runs)
            self._benches.clear()

    def remember(self, likelihood: Likelihood) -> None:
        """Keep the starts and paths a likelihood has found, for the next one."""
        self.starts.update(likelihood.starts)
        self.paths.update(likelihood.paths)

    def widened(self, more: Mapping[str, Effect]) -> ModelFactory:
        """The same campaign with more effects in the catalogue; noise and starts are kept."""
        variant = replace(self.variant, catalogue={**self.catalogue, **more})
        other = ModelFactory(self.campaign, variant, self.fixed, self._usual)
        other.noise_model, other.starts, other.paths = self.noise_model, dict(self.starts), dict(self.paths)
        other.leads = self.leads
        return other

    def parameters(self, effect: str) -> tuple[str, ...]:
        """Full names of the parameters of an effect, or of a group of them, that a fit estimates."""
        owned = (p for member in self.members(effect) for p in self.catalogue[member].owned)
        return tuple(p.name for p in owned if p.estimated and p.name not in self.fixed)


def groups_of(catalogue: Mapping[str, Effect]) -> dict[str, tuple[str, ...]]:
    """By name, effects that may show only together, as records say: each with those through which it acts, these first."""
    groups = ((*(other for other in record.through if other in catalogue), e) for e, record in catalogue.items())
    return {TOGETHER.join(group): group for group in groups if len(group) > 1}
