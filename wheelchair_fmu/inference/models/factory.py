"""Likelihoods for any set of effects: each as light as it can be, compiled once.

An effect that brings a state makes every simulation dearer, and one more model to compile. Those that bring none are in one
model together, off or on, and beside effects with states only where somebody asks for any.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np

from ...campaign import BY_NAME, Campaign, moving, sets_off
from ...campaign.channels import MOMENTUM
from ...model.choice import law
from ...model.stage import Effect
from ...model.variant import Variant
from ...model.wheelchair import adds_state
from ...quantities import Parameter
from ..evidence.likelihood import Likelihood, driven
from ..evidence.noise_model import NoiseModel
from ..preflight.timing import Late, retimed
from .setting import Setting

MEASURED = ("chair.m", "chair.a", "chair.b", "chair.t_r")  # by scales and tape, well enough to be doubted only a little
CALIBRATED = ("tyre.C_lambda", "resistance.f_r", "resistance.f_f", "chair.I_z", *MEASURED)


SCALE = "rider.scale"
ONSET = "resistance.onset"
STROKE_PHASE = "stroke_phase"  # symbol that what moves with strokes reads
BEARING = "caster.M"
TOGETHER = "+"  # between the names of effects in that of their group


def _of_the_body(campaign: Campaign) -> tuple[str, ...]:
    """What is calibrated where the motion of the rider's body was recorded: how much of it that is."""
    return (SCALE,) if BY_NAME[MOMENTUM].fmu in driven(campaign) else ()


def _of_a_standing_start(campaign: Campaign) -> tuple[str, ...]:
    """What is calibrated where a chair sets off: nobody measures how its drag builds up from rest, and it decides when it lets
    go."""
    return (ONSET,) if sets_off(campaign) else ()


def _of_swinging_casters(chair: Variant) -> tuple[str, ...]:
    """What is calibrated where casters swing by the chair's own law: in that chairs differ, and nobody measures it well."""
    casters = law("caster", chair.choice)
    return tuple(p.name for p in casters.parameters if p.among_chairs) if casters.rows else ()


@dataclass(frozen=True)
class ModelFactory:
    """Likelihoods for every question about a campaign and the `chair` that it is compared with.

    `usual` are the parameters that fits to any campaign estimate, but for the `fixed` ones, which nobody does. A factory that
    `leads` has every run led along the forces that nobody recorded.
    """

    campaign: Campaign
    chair: Variant
    fixed: Collection[str] = ()
    usual: Sequence[str] = CALIBRATED
    leads: bool = False

    @cached_property
    def calibrated(self) -> tuple[str, ...]:
        """The parameters that every fit estimates."""
        names = (
            *self.usual,
            *_of_swinging_casters(self.chair),
            *_of_the_body(self.campaign),
            *_of_a_standing_start(self.campaign),
        )
        return tuple(n for n in dict.fromkeys(names) if n not in self.fixed)

    @cached_property
    def given(self) -> dict[str, float]:
        """The values that the chair's own effects have for a start; they are estimated again, unless they are fixed."""
        sizes = {p.name for e in self.catalogue.values() for p in e.owned if p.estimated}
        return {n: v for n, v in self.chair.values.items() if n in sizes and n not in self.fixed}

    @cached_property
    def variant(self) -> Variant:
        """The chair without what is `given`."""
        return replace(self.chair, values={n: v for n, v in self.chair.values.items() if n not in self.given})

    @property
    def catalogue(self) -> Mapping[str, Effect]:
        return self.chair.catalogue

    @cached_property
    def records(self) -> dict[str, Parameter]:
        """The parameters of all effects, by full name."""
        return {p.name: p for e in self.catalogue.values() for p in e.owned}

    @cached_property
    def groups(self) -> dict[str, tuple[str, ...]]:
        """See `groups_of`."""
        return groups_of(self.catalogue)

    @cached_property
    def demanding(self) -> list[str]:
        """Effects that ask for another law."""
        return [e for e, effect in self.catalogue.items() if effect.needs]

    @cached_property
    def heavy(self) -> list[str]:
        """Effects of the usual laws that bring states of their own, or are driven by inputs that others do without."""
        usual = ((e, effect) for e, effect in self.catalogue.items() if not effect.needs)
        return [e for e, effect in usual if effect.asks(STROKE_PHASE) or adds_state(self.chair.choice, effect)]

    @cached_property
    def light(self) -> list[str]:
        """Effects that make no simulation dearer."""
        return [e for e in self.catalogue if e not in self.demanding and e not in self.heavy]

    @property
    def setting(self) -> Setting:
        """Nothing but what the campaign says."""
        return Setting(NoiseModel(self.campaign.noise))

    def likelihood(self, effects: Iterable[str] = (), setting: Setting | None = None) -> Likelihood:
        """The likelihood on which these effects may be on."""
        wanted = self._members(effects)
        heavy = wanted.difference(self.light)
        return self._likelihood(wanted if heavy and heavy == wanted else {*self.light, *heavy}, setting)

    def wide(self, effects: Iterable[str] = (), setting: Setting | None = None) -> Likelihood:
        """The likelihood on which these effects, and all light ones, may be on."""
        return self._likelihood({*self.light, *self._members(effects)}, setting)

    def rerun(self, effects: Iterable[str] = (), setting: Setting | None = None) -> Likelihood:
        """A likelihood on which these effects may be on, and that only runs evidence again: it is compiled in half the time."""
        return self._likelihood(self._members(effects), setting, derives=False)

    def _likelihood(self, effects: set[str], setting: Setting | None, derives: bool = True) -> Likelihood:
        here = setting or self.setting
        return self._compiled(frozenset(effects), derives).with_noise_model(here.noise_model).begun(here.begins)

    @cached_property
    def _compiled(self) -> Callable[[frozenset[str], bool], Likelihood]:
        """The likelihood of these effects, made once."""

        @cache
        def compiled(effects: frozenset[str], derives: bool) -> Likelihood:
            chosen = [e for e in self.catalogue if e in effects]
            own = (n for e in chosen for n in self.estimated(e))
            columns = (*dict.fromkeys((*self.calibrated, ONSET)), *own)
            return Likelihood(self.campaign, self.variant.with_effects(chosen), None, columns, derives, self.leads)

        return compiled

    def _members(self, effects: Iterable[str]) -> set[str]:
        """These effects, the members of those that are groups, and the variant's own."""
        return {member for e in (*effects, *self.variant.effects) for member in self.members(e)}

    def members(self, effect: str) -> tuple[str, ...]:
        """See `members_of`."""
        return members_of(effect)

    def parameters(self, effect: str) -> tuple[str, ...]:
        """Full names of the parameters of an effect, or of a group of them, that say how large it is."""
        return tuple(p.name for p in self._owned(effect) if p.estimated)

    def estimated(self, effect: str) -> tuple[str, ...]:
        """The same with those of its constants in which chairs differ."""
        return tuple(p.name for p in self._owned(effect) if p.estimated or p.adjusted)

    def constants(self, effect: str) -> frozenset[str]:
        """Those constants."""
        return frozenset(p.name for p in self._owned(effect) if p.adjusted)

    def _owned(self, effect: str) -> list[Parameter]:
        owned = (p for member in self.members(effect) for p in self.catalogue[member].owned)
        return [p for p in owned if p.name not in self.fixed]

    def linear(self, effect: str) -> bool:
        """Does the slope at zero tell what the effect does at the size it has? Of a group it never does."""
        if len(self.members(effect)) > 1:
            return False
        record = self.catalogue[effect]
        return not (record.even or record.rows or record.needs or any(p.adjusted for p in record.owned))

    def deltas(self, names: Sequence[str]) -> np.ndarray:
        """Smallest interesting sizes (k,)."""
        return np.array([self.records[n].smallest_interesting for n in names])

    def unfitted(self, names: Sequence[str]) -> np.ndarray:
        """Sizes (k,) of effects in a model that lacks them: zero, or what the campaign says, as of where a sensor sits."""
        return np.array([self.campaign.known.get(n, 0.0) for n in names])

    def dry(self, effect: str) -> bool:
        """Is an effect, or one of a group of them, dry friction?"""
        return any(p.dry for p in self._owned(effect))

    def one_sided(self, names: Sequence[str]) -> np.ndarray:
        """Which of these may only be positive (k,)."""
        return np.array([self.records[n].lower == 0 for n in names], bool)

    def without(self, channels: Container[str]) -> ModelFactory:
        """The same without these channels, and without runs that have no other."""
        kept = (replace(r, channels={c: v for c, v in r.channels.items() if c not in channels}) for r in self.campaign.runs)
        return replace(self, campaign=replace(self.campaign, runs=tuple(r for r in kept if r.channels)))

    def retimed(self, late: Mapping[str, Late]) -> ModelFactory:
        """The same with the pushes of these runs at the time when the chair felt them."""
        runs = (retimed(r, late[r.name]) if r.name in late else r for r in self.campaign.runs)
        return replace(self, campaign=replace(self.campaign, runs=tuple(runs))) if late else self

    def widened(self, more: Mapping[str, Effect]) -> ModelFactory:
        """The same with more effects in the catalogue."""
        return replace(self, chair=replace(self.chair, catalogue={**self.catalogue, **more}))

    @property
    def own(self) -> frozenset[str]:
        """The effects that the chair and the campaign have."""
        return frozenset((*self.variant.effects, *self.campaign.effects))

    def narrowed(self) -> ModelFactory:
        """The same with no effect to look for: only its `own` are in the catalogue."""
        return replace(self, chair=replace(self.chair, catalogue={e: r for e, r in self.catalogue.items() if e in self.own}))

    def led(self) -> ModelFactory:
        """The same of where the chair rolls, with every run led along the forces that nobody recorded."""
        return replace(self, campaign=moving(self.campaign), leads=True)


def members_of(effect: str) -> tuple[str, ...]:
    """The effects of a group, which its name has, or the one effect that this is."""
    return tuple(effect.split(TOGETHER))


def groups_of(catalogue: Mapping[str, Effect]) -> dict[str, tuple[str, ...]]:
    """By name, effects that may show only together, as records say: each with those through which it acts, these first."""
    groups = ((*(other for other in record.through if other in catalogue), e) for e, record in catalogue.items())
    return {TOGETHER.join(group): group for group in groups if len(group) > 1}
