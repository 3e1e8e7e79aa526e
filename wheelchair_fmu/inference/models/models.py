"""The models that a search fits: by which parameters, in which setting, each hypothesis once."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...campaign import Campaign
from ...errors import SimulationError
from ...model.stage import Effect
from ..estimation.fit import fit
from ..estimation.foretelling import foretold_by
from ..estimation.inverse import inverse
from ..estimation.problem import Fit, Problem, sizes_an_effect, start_values
from ..estimation.statistics import estimates
from ..evidence.disturbance import strength
from ..evidence.evidence import Evidence
from ..evidence.initial_state import CASTERS, TUNING
from ..evidence.likelihood import Likelihood, offsets_of
from ..evidence.noise import QUIETER, by_run, noise_model_of, shown
from ..policy import DEFAULT, USUAL, Effort, SearchPolicy
from .doubles import doubles
from .factory import BEARING, ONSET, ModelFactory
from .hypothesis import Hypothesis, Model
from .setting import Setting

# Where a calibration begins of a chair whose casters swing, in standard deviations of the priors from what is usual, and again
# while it comes to no end near the noise: dry friction that is more or sharper than a chair's holds it and its casters where
# they stand, and no slope tells of it then.
LOOSE = ({ONSET: 0.3}, {BEARING: -1.0, ONSET: 1.0})


def quiet(words: str) -> None:
    """Who tells nobody."""


@dataclass(frozen=True)
class Models:
    """A factory's models in one setting, by which policy they are judged, and with which effort they are sought. `say` is told
    what is being done; `doubles` are by effect the nuisances of the campaign that stand for the very same, without which the
    effect is fitted.

    Each hypothesis is fitted once in a setting. In another one, and where a fit was not followed to its end, it begins where
    it was left, which `_left` holds for the models of all settings.
    """

    factory: ModelFactory
    setting: Setting
    policy: SearchPolicy = DEFAULT
    effort: Effort = USUAL
    say: Callable[[str], None] = quiet
    doubles: Mapping[str, frozenset[str]] = field(default_factory=dict)
    _left: dict[Hypothesis, Mapping[str, float]] = field(default_factory=dict, repr=False, compare=False)
    _fits: dict[Hypothesis, Fit] = field(default_factory=dict, init=False, repr=False, compare=False)
    _heldout: dict[Hypothesis, Evidence] = field(default_factory=dict, init=False, repr=False, compare=False)

    @classmethod
    def of(
        cls, factory: ModelFactory, policy: SearchPolicy = DEFAULT, say: Callable[[str], None] = quiet, effort: Effort = USUAL
    ) -> Models:
        """A factory's, where nothing is known but what the campaign says."""
        return cls(factory, factory.setting, policy, effort, say)

    @property
    def campaign(self) -> Campaign:
        return self.factory.campaign

    @property
    def promising(self) -> float:
        """Expected fall below which nothing is refitted. Where forces lead the runs, slopes see all that a refit finds, and
        elsewhere perhaps half of it."""
        return self.effort.promising * (2.0 if self.factory.leads else 1.0)

    @property
    def offsets(self) -> tuple[str, ...]:
        """Sensor offsets that every fit estimates."""
        return tuple(offsets_of(self.campaign))

    def likelihood(self, effects: Sequence[str] = ()) -> Likelihood:
        """See `ModelFactory.likelihood`."""
        return self.factory.likelihood(effects, self.setting)

    def wide(self, effects: Sequence[str] = ()) -> Likelihood:
        """See `ModelFactory.wide`."""
        return self.factory.wide(effects, self.setting)

    def rerun(self, effects: Sequence[str] = ()) -> Likelihood:
        """See `ModelFactory.rerun`."""
        return self.factory.rerun(effects, self.setting)

    def names(self, effects: Sequence[str], without: frozenset[str] = frozenset()) -> list[str]:
        """What a model with these effects has to be fitted by, if it also does `without` these nuisances."""
        left_out = without.union(*(self.doubles.get(e, ()) for e in effects))
        of_effects = dict.fromkeys(n for e in effects for n in self.factory.estimated(e))
        return [n for n in (*self.factory.calibrated, *self.offsets, *of_effects) if n not in left_out]

    def refit(
        self,
        effects: Sequence[str],
        start: Mapping[str, float],
        here: Evidence | None = None,
        without: frozenset[str] = frozenset(),
        **how: Any,
    ) -> Fit:
        """The campaign's best values of the calibrated and these effects' parameters, as far as it is followed; see `fit`."""
        return fit(self.likelihood(effects), self.names(effects, without), start, here, **how)

    def fitted(self, effects: Sequence[str], start: Mapping[str, float], without: frozenset[str] = frozenset()) -> Fit:
        """The same followed to its end, once: who asks again gets what came of the first start."""
        hypothesis = Hypothesis.of(effects, without)
        if hypothesis not in self._fits:
            found = fit(self.likelihood(effects), self.names(effects, without), self._left.get(hypothesis, start))
            self._keep(hypothesis, self.started(effects, found))
        return self._fits[hypothesis]

    def remember(self, effects: Sequence[str], found: Fit, ended: bool) -> None:
        """Where a fit with these effects was left; nobody makes one again that has `ended`."""
        if ended:
            self._keep(Hypothesis.of(effects), found)
        else:
            self._left[Hypothesis.of(effects)] = found.values

    def _keep(self, hypothesis: Hypothesis, found: Fit) -> None:
        self._fits[hypothesis], self._left[hypothesis] = found, found.values

    def started(self, effects: Sequence[str], found: Fit) -> Fit:
        """A fit of these effects; where it has states that no model of this setting had, again from where its runs start by it,
        if that is likelier."""
        likelihood = self.likelihood(effects)
        if not self._unstarted(likelihood):
            return found
        try:
            again = self.restarted(likelihood, found.names, found.values)
        except SimulationError:
            return found
        return min(found, again, key=lambda f: f.deviance)

    def _unstarted(self, likelihood: Likelihood) -> bool:
        """Have the models of a likelihood casters that swing, and had none yet in this setting? Nobody asked then how these
        stand where runs start, and from elsewhere a chair may go another way altogether."""
        asked = (name for begin in self.setting.begins.values() for name in begin.start)
        return not self.factory.leads and not set(CASTERS).intersection(likelihood.start_names) <= set(asked)

    def model(self, effects: Sequence[str], start: Mapping[str, float], without: frozenset[str] = frozenset()) -> Model:
        """`fitted`, and held out."""
        hypothesis, found = Hypothesis.of(effects, without), self.fitted(effects, start, without)
        if hypothesis not in self._heldout:
            self._heldout[hypothesis] = self.heldout(self.likelihood(effects), found)
        return Model(tuple(effects), found, self._heldout[hypothesis])

    def afresh(self) -> Models:
        """The same models with runs that start where the campaign has them, and no errors of pushes known, as if no model had
        been fitted yet: what a model found of either that lacks something large leads another one astray."""
        return replace(self, setting=replace(self.setting, begins={}))

    def rival_of(self, effect: str, base: Model) -> Model:
        """The model that an effect is judged against: the one at hand, but never with a nuisance that does the same."""
        same = self.doubles.get(effect)
        return self.model(base.effects, base.fit.values, same) if same else base

    def heldout(self, likelihood: Likelihood, found: Fit, tune_start: int = 1) -> Evidence:
        """Evidence of the held-out runs, as a fit foretells them; only where each starts is estimated on them, in so many
        steps, or more in models that were not started yet."""
        tune_start = TUNING if self._unstarted(likelihood) else tune_start
        held = likelihood.evidence(self.campaign.holdout, found.values, found.names, tune_start=tune_start)
        return foretold_by(found, held, self.unknown(likelihood, found))

    def unknown(self, likelihood: Likelihood, found: Fit) -> np.ndarray:
        """Inverse variances (k,) of what a fit took for unknown beforehand: how large effects of interest are."""
        records, large = likelihood.records, self.policy.large
        sizes = [large * records[n].delta if sizes_an_effect(likelihood, n) else np.inf for n in found.names]
        return np.array(sizes) ** -2.0

    def weight(self, found: Fit, effect: str) -> float:
        """How far an effect's estimate is from what a model without it has, by its covariance: about as much as −2 log
        likelihood would rise without it, where filters stay as they are."""
        names = self.factory.parameters(effect)
        value, covariance = estimates(found, names)
        size = value - self.factory.unfitted(names)
        return float(size @ inverse(covariance) @ size)

    def compared(self, found: Fit, effect: str, base: Fit) -> Fit:
        """A fit as it compares with one that lacks an effect of it. Where forces lead the runs, how likely these are is no
        measure: there the deviance is less by as much as the effect's estimate is from zero."""
        return replace(found, deviance=base.deviance - self.weight(found, effect)) if self.factory.leads else found

    def calibrated(self) -> tuple[Models, Model, Evidence, Evidence]:
        """The calibrated model, with the models whose runs start where it wants them; and evidence of fitted and of held-out
        runs for the nominal one, of values as they are given, but for sensors' offsets."""
        # Whoever compares this chair knows of no start but the campaign's, and it is one chair with one error.
        likelihood = (self if self.factory.leads else self.afresh()).likelihood()
        names = self.names(())
        given = {**start_values(likelihood, names), **self._fitted_offsets(likelihood)}
        start = {n: self.setting.values.get(n, v) for n, v in given.items()}
        nominal = likelihood.evidence(self.campaign.fit, start, names, tune_start=TUNING)
        nominal_held = likelihood.evidence(self.campaign.holdout, start, (), tune_start=TUNING)
        if BEARING in names and not self.factory.leads:
            found = self._loosely(names)
        else:
            likelihood = likelihood.continued(nominal, nominal_held)
            found = self._from(likelihood, names, start, nominal)
        held = self.heldout(likelihood, found)
        setting = self.setting.continued(found.evidence, held)
        if self.factory.leads:
            setting = replace(setting, values=dict(found.values))
        return replace(self, setting=setting), Model((), found, held), nominal, nominal_held

    def _fitted_offsets(self, likelihood: Likelihood) -> dict[str, float]:
        """Offsets of sensors beside a chair as it is given: they are no error of it, be it calibrated or not. Where forces lead
        the runs, they are found with everything else."""
        if self.factory.leads or not self.offsets:
            return {}
        return dict(fit(likelihood, self.offsets, start_values(likelihood, self.offsets)).values)

    def _loosely(self, names: Sequence[str]) -> Fit:
        """The likeliest fit from where nothing is held."""
        likelihood, ends = self.likelihood(), list[Fit]()
        for loose in LOOSE:
            there = self._loosened(likelihood, names, loose)
            here = likelihood.evidence(self.campaign.fit, there, names, tune_start=1)
            rival = min((found.deviance for found in ends), default=math.inf)
            ends.append(self._from(likelihood.continued(here), names, there, here, rival))
            if ends[-1].evidence.rms < self.policy.a_little:
                break
        return min(ends, key=lambda found: found.deviance)

    def _loosened(self, likelihood: Likelihood, names: Sequence[str], by: Mapping[str, float]) -> dict[str, float]:
        """What is usual, or given, with some values so many standard deviations of their priors from that, within bounds."""
        problem = Problem(likelihood, names)
        mean, sd = problem.prior.mean, problem.prior.sd
        off = np.array([by[n] * s if n in by else 0.0 for n, s in zip(names, sd, strict=True)])
        return problem.values(np.clip(mean + off, problem.lower, problem.upper))

    def _from(
        self, likelihood: Likelihood, names: Sequence[str], start: Mapping[str, float], here: Evidence, rival: float = math.inf
    ) -> Fit:
        """A fit from `start`, with the evidence `here`, and again from where its runs start by it; neither is followed to its
        end that falls too slowly to come up with a `rival`'s deviance."""
        first = fit(likelihood, names, start, here, rival)
        return self.restarted(likelihood.continued(first.evidence), names, first.values, 1, rival=rival)

    def with_given(self, effects: Sequence[str], base: Fit) -> tuple[Models, Model]:
        """The model with these effects, which the variant has already, estimated anew."""
        return self.settled(effects, self.refit(effects, {**self.factory.given, **base.values}))

    def settled(self, effects: Sequence[str], found: Fit) -> tuple[Models, Model]:
        """A fit again from its own result, with every run started where this model wants it, and held out; with the models
        whose runs start there."""
        likelihood = self.likelihood(effects)
        again = self.restarted(likelihood, self.names(effects), found.values)
        held = self.heldout(likelihood, again, tune_start=TUNING)
        return replace(self, setting=self.setting.continued(again.evidence, held)), Model(tuple(effects), again, held)

    def restarted(
        self, likelihood: Likelihood, names: Sequence[str], start: Mapping[str, float], tune_start: int = TUNING, **how: Any
    ) -> Fit:
        """A fit from `start`, with every run started where the readings want it there, in so many steps; one that forces lead
        also where they want it in the end, as these forces were others before."""

        def started(likelihood: Likelihood, values: Mapping[str, float], **how: Any) -> Fit:
            here = likelihood.evidence(self.campaign.fit, values, names, tune_start=tune_start)
            return fit(likelihood.continued(here), names, values, here, **how)

        problem = Problem(likelihood, names)
        found = started(likelihood, problem.values(problem.inside(start)), **how)
        return started(likelihood.continued(found.evidence), found.values, most=0) if self.factory.leads else found

    def with_noise_of(self, found: Fit, *, again: bool = False) -> Models | None:
        """The models with the noise that this fit's residuals show; None where it is no other than before. `again`: now that an
        effect is in that was missing when the noise was estimated."""
        before, lowest, campaign = self.setting.noise_model, QUIETER if again else 0.0, self.campaign
        now, notes = noise_model_of(found.evidence, campaign.noise, before, lowest, campaign.noise_estimated)
        if self.factory.leads:
            forces = strength(found.evidence, self.likelihood().chair(found.values), now)
            each = by_run(found.evidence, before)
            known = replace(now, by_run=each, shown=shown(found.evidence, each, before))
            now = forces.put_into(known)
        if not now.differs(before):
            return None  # and models that are compared are by the same noise
        return replace(self, setting=replace(self.setting, noise_model=now, notes=tuple(notes)))

    def with_doubles(self, calibrated: Fit) -> Models:
        """The models that know which effects a nuisance of the campaign stands for."""
        return replace(self, doubles=doubles(self.wide(), self.factory, self.offsets, calibrated)) if self.offsets else self

    def widened(self, more: Mapping[str, Effect], policy: SearchPolicy | None = None) -> Models:
        """The same with more effects in the catalogue, by another policy if there is one."""
        return replace(self, factory=self.factory.widened(more), policy=policy or self.policy)
