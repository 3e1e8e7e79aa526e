"""The models that a search fits: by which parameters, with which noise, and from where every run starts."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..estimation.fit import Fit, Problem, fit, start_value
from ..estimation.inverse import inverse
from ..estimation.statistics import estimates, margin
from ..evidence.disturbance import strength
from ..evidence.evidence import Evidence
from ..evidence.likelihood import Likelihood, offsets_of
from ..evidence.noise import QUIETER, by_run, noise_model_of
from ..policy import DEFAULT, SearchPolicy
from ..preflight.timing import Late
from .factory import ModelFactory

PLAINLY = 100.0  # times what would be decisive


class Models:
    """A factory's models, with any of its effects."""

    def __init__(
        self, factory: ModelFactory, progress: Callable[[str], None] = lambda words: None, policy: SearchPolicy = DEFAULT
    ):
        self.factory, self.say, self.policy = factory, progress, policy
        self.records = {p.name: p for e in factory.catalogue.values() for p in e.owned}
        self.confounded: dict[str, frozenset[str]] = {}
        self._without: dict[tuple[object, ...], tuple[Fit, Evidence]] = {}
        self.notes: list[str] = []  # on columns and clocks
        self.clocks: dict[str, dict[str, Late]] = {}  # by run and device, where they are uncertain
        self.retimed: dict[str, Late] = {}  # by run, whose pushes are read at another time than they have
        self.noise_notes: list[str] = []

    @property
    def offsets(self) -> tuple[str, ...]:
        """Sensor offsets that every fit estimates."""
        return tuple(offsets_of(self.factory.campaign))

    def calibrate(self) -> tuple[Fit, Evidence, Evidence, Evidence]:
        """(calibrated fit, its held-out evidence, nominal fit evidence, nominal held-out evidence)."""
        w = self.factory
        likelihood = w.likelihood()
        names = self.names(())
        start = {n: w.begun.get(n, start_value(likelihood, likelihood.records[n])) for n in names}
        nominal = likelihood.evidence(w.campaign.fit, start, names, tune_start=1)
        nominal_held = likelihood.evidence(w.campaign.holdout, start, (), tune_start=1)
        found = fit(likelihood, names, start, nominal)
        found = self._restarted(likelihood, names, found.values, 1)
        held = self.heldout(likelihood, found.values)
        w.remember(likelihood)
        if w.leads:
            w.begun = dict(found.values)
        return found, held, nominal, nominal_held

    def refit(self, effects: Sequence[str], start: Mapping[str, float], here: Evidence | None = None, **how: Any) -> Fit:
        """The campaign's best values of the calibrated and these effects' parameters; see `fit`."""
        return fit(self.factory.likelihood(effects), self.names(effects), start, here, **how)

    def names(self, effects: Sequence[str]) -> list[str]:
        """What a model with these effects has to be fitted by."""
        confounded = frozenset().union(*(self.confounded.get(e, ()) for e in effects))
        offsets = (n for n in self.offsets if n not in confounded)
        return [*self.factory.calibrated, *offsets, *(n for e in effects for n in self.factory.parameters(e))]

    def with_given(self, effects: Sequence[str], base: Fit) -> tuple[Fit, Evidence]:
        """The model with these effects, which the variant has already, estimated anew."""
        return self.settled(effects, self.refit(effects, {**self.factory.given, **base.values}))

    def settled(self, effects: Sequence[str], found: Fit) -> tuple[Fit, Evidence]:
        """A fit again from its own result, with every run started where this model wants it, and held out."""
        likelihood = self.factory.likelihood(effects)
        self._without.clear()  # these started elsewhere
        again = self._restarted(likelihood, self.names(effects), found.values, 2)
        held = self.heldout(likelihood, again.values, tune_start=2)
        self.factory.remember(likelihood)
        return again, held

    def _restarted(self, likelihood: Likelihood, names: Sequence[str], start: Mapping[str, float], tune_start: int) -> Fit:
        """A fit from `start`, with every run started where the readings want it there, in so many steps."""
        problem = Problem(likelihood, names)
        values = problem.values(problem.inside(start))
        return fit(
            likelihood, names, values, likelihood.evidence(self.factory.campaign.fit, values, names, tune_start=tune_start)
        )

    def pruned(self, effects: tuple[str, ...], found: Fit, keep: Container[str] = ()) -> tuple[tuple[str, ...], Fit]:
        """Backward: leave out every effect but the last, and those to `keep`, that the others have made needless."""
        for effect in effects[:-1]:
            if effect in keep or self._plainly_needed(found, effect):
                continue
            fewer = tuple(e for e in effects if e != effect)
            if self.factory.leads and self.weight(found, effect) > margin(found.evidence, self.policy):
                continue
            without = self.refit(fewer, found.values)
            if self.factory.leads or without.misfit - found.misfit < margin(found.evidence, self.policy):
                return self.pruned(fewer, without, keep)
        return effects, found

    def _plainly_needed(self, found: Fit, effect: str) -> bool:
        """Is an effect's estimate, by its standard errors, so far from zero that nobody needs to try without?"""
        return self.weight(found, effect) > PLAINLY * self.policy.tied

    def weight(self, found: Fit, effect: str) -> float:
        """How far an effect's estimate is from zero, by its covariance: about as much as −2 log likelihood would rise without
        it, where filters stay as they are."""
        value, covariance = estimates(found, self.factory.parameters(effect))
        return float(value @ inverse(covariance) @ value)

    def heldout(self, likelihood: Likelihood, values: Mapping[str, float], tune_start: int = 1) -> Evidence:
        """Evidence of the held-out runs; only where each starts is estimated on them, in so many steps."""
        return likelihood.evidence(self.factory.campaign.holdout, values, (), tune_start=tune_start)

    def reestimate_noise(self, found: Fit, *, again: bool = False) -> bool:
        """Take the noise that this fit's residuals show, and say whether it is another than before. `again`: now that an effect
        is in that was missing when the noise was estimated."""
        before, lowest = self.factory.noise_model, QUIETER if again else 0.0
        campaign = self.factory.campaign
        now, notes = noise_model_of(found.evidence, campaign.noise, before, lowest, campaign.noise_estimated)
        if self.factory.leads:
            chair = self.factory.likelihood().chair(found.values)
            forces = strength(found.evidence, chair["chair.t_r"])
            now = forces.put_into(replace(now, by_run=by_run(found.evidence, before)), chair["chair.m"])
        if not now.differs(before):
            return False  # and models that are compared are by the same noise
        self.factory.noise_model, self.noise_notes = now, notes
        self._without.clear()
        return True

    def rival_of(self, effect: str, effects: Sequence[str], base: Fit, held: Evidence | None) -> tuple[Fit, Evidence | None]:
        """The model that an effect is judged against: the one at hand, but never with a nuisance that does the same."""
        if not self.confounded.get(effect):
            return base, held
        key = (effect, *effects)
        if key not in self._without:
            names = [n for n in self.names(effects) if n not in self.confounded[effect]]
            likelihood = self.factory.likelihood(effects)
            fewer = fit(likelihood, names, base.values)
            self._without[key] = fewer, self.heldout(likelihood, fewer.values)
        return self._without[key]

    def linear(self, effect: str) -> bool:
        """Does the slope at zero tell what the effect does at the size it has? Of a group it never does."""
        if effect in self.factory.groups:
            return False
        record = self.factory.catalogue[effect]
        return not (record.even or record.rows or record.needs)

    def compared(self, found: Fit, effect: str, base: Fit) -> Fit:
        """A fit as it compares with one that lacks an effect of it. Where forces lead the runs, how likely these are is no
        measure: there the misfit is less by as much as the effect's estimate is from zero."""
        return replace(found, misfit=base.misfit - self.weight(found, effect)) if self.factory.leads else found

    def deltas(self, names: Sequence[str]) -> np.ndarray:
        """Smallest interesting sizes (k,)."""
        return np.array([self.records[n].smallest_interesting for n in names])

    def one_sided(self, names: Sequence[str]) -> np.ndarray:
        """Which of these may only be positive (k,)."""
        return np.array([self.records[n].lower == 0 for n in names], bool)
