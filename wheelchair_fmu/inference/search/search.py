"""Screen, refit, hold out: find what is missing, one effect after the other, until nothing more is found."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
from scipy import special

from ...errors import SimulationError
from ...quantities import Parameter
from ..chance import chance_beyond
from ..estimation.fit import Fit
from ..estimation.marginal import of_score, support_of
from ..estimation.score import RUNS
from ..estimation.starts import most_promising, outlook
from ..estimation.statistics import between_runs, correlation_time, estimates, held_out_gain, seen_directions
from ..evidence.evidence import Evidence
from ..evidence.likelihood import Likelihood
from ..parallel import parallel_map
from .candidate import Candidate, ranked
from .rounds import Round
from .screen import AT_THE_FLOOR, BENT, PROMISING, SLIGHTLY, Screen, Screened, shortlist

FAR = 1.1  # mean square innovation of a model that slopes are not to be trusted at
SHORTLIST = 5  # effects that are refitted in a round, by what slopes and secants promise of them
HOPELESS = 0.2  # of the leader's fall: an effect that may not hope for more is not refitted,
BESIDE = 0.5  # unless it may hope for this part of what slopes promised of the leader,
BEYOND = 10.0  # or they say little of it, and it may do so many times what they say
ALIKE = 0.9  # cosine above which a rival is refitted whatever its score
SIZES = (1.0, 2.0, 4.0, 8.0, -1.0, -2.0, -4.0, -8.0)  # of δ, from which a refit may start
STARTS = 2  # of these, for an effect whose slope at zero says little; if it has several parameters, one of
DIRECTIONS = 4  # pairs of signs, and of these
ENDED = 3  # refits go on to their end
HALFWAY = 0.5  # of the fall that is expected, or that the best direction promises, or that is asked for of a linear effect:
# where less is promised no refit starts, and if no size at all promises so much, refits start from
GRID = (1.0, 2.0, 4.0)  # of δ as well


class Search(Screen):
    """The search for what is missing: a round of it screens, refits what is promising, and judges."""

    def candidate(
        self,
        base: Fit,
        base_held: Evidence | None,
        effects: tuple[str, ...],
        s: Screened,
        tests: int,
        rival: float = math.inf,
        least: float = -math.inf,
    ) -> Candidate | None:
        """Refit with one more effect, from the expected change and from sizes of interest, if −2 log likelihood may fall by
        `least`; `rival` is the best misfit yet."""
        w, effect = self.factory, s.score.effect
        likelihood = w.likelihood((*effects, effect))
        base, base_held = self.rival_of(effect, effects, base, base_held)
        rival = min(rival, base.misfit)  # which it has as a special case
        starts = self._starts(likelihood, base, s, least)
        if starts:
            self.say(f"refitting {effect}")

        def one_step(start: tuple[dict[str, float], Evidence | None]) -> Fit | None:
            try:
                return self.refit((*effects, effect), *start, rival=rival, most=1)
            except SimulationError:
                return None

        begun = [f for f in parallel_map(one_step, starts) if f]
        if not begun:
            return None
        own, ended = w.parameters(effect), list[Fit]()
        for ahead in sorted(begun, key=lambda f: f.misfit)[: ENDED if len(own) > 1 else 1]:
            signs, *others = (_signs([f.values[n] for n in own]) for f in (ahead, *ended))
            if signs not in others:
                ended.append(self.refit((*effects, effect), ahead.values, ahead.evidence, rival=rival))
                rival = min(rival, ended[-1].misfit)
        found = self.compared(min(ended, key=lambda f: f.misfit), effect, base)
        found = replace(found, evidence=likelihood.restarted(found.evidence, found.values))
        held = (
            likelihood.restarted(likelihood.evidence(w.campaign.holdout, found.values), found.values)
            if w.campaign.holdout
            else None
        )
        return self.judge(base, base_held, found, held, effect, own, tests)

    def _starts(
        self, likelihood: Likelihood, base: Fit, s: Screened, least: float
    ) -> list[tuple[dict[str, float], Evidence | None]]:
        """Where to start refits, and what is known there, where −2 log likelihood may fall by `least`: a linear effect from
        zero, others from the most promising of several sizes: the expected change, both signs of δ, and larger ones."""
        group = s.score.effect in self.factory.groups
        if s.score.drop < (least if s.linear or group else least / BEYOND):  # secants of a group are taken where it acts
            return []
        names = [*base.names, *self.factory.parameters(s.score.effect)]
        if self.factory.leads:  # where forces make up for what is missing, slopes say about how much that is,
            of_interest = dict(zip(s.score.names, map(float, s.delta), strict=True))
            sizes = [self._expected(s), *([of_interest] if group else [])]  # but where a member seems to be nothing
            return [({**base.values, **size}, None) for size in sizes]
        at_prior_mean = self.at_prior_mean(likelihood, base, SLIGHTLY if s.straight else BENT)
        calibrations = [[values[n] for n in base.names] for values in (base.values, *at_prior_mean)]
        if s.linear and len(calibrations) == 1:
            off = [base.values.get(n, 0.0) for n in names]
            known = s.evidence.only(names) if set(names) <= set(s.evidence.by) else None
            return [(dict(zip(names, off, strict=True)), known)]
        thetas = self._sizes(likelihood, base, names, calibrations, s, least)
        return [(dict(zip(names, theta, strict=True)), None) for theta in dict.fromkeys(thetas)]

    def _expected(self, s: Screened) -> dict[str, float]:
        """An effect's sizes as slopes have them, within bounds."""
        names = self.factory.parameters(s.score.effect)
        expected, *_ = sizes_to_try(s, [self.records[n] for n in names])
        return dict(zip(names, map(float, expected), strict=True))

    def _sizes(
        self,
        likelihood: Likelihood,
        base: Fit,
        names: Sequence[str],
        calibrations: Sequence[Sequence[float]],
        s: Screened,
        least: float,
    ) -> list[tuple[float, ...]]:
        """The most promising calibrations and sizes of an effect together, by `names`."""
        records = [self.records[n] for n in self.factory.parameters(s.score.effect)]
        known, calibrated = s.evidence.only(base.names), len(base.names)
        members = [self.factory.catalogue[member] for member in self.factory.members(s.score.effect)]
        states, laws = (any(getattr(record, what) for record in members) for what in ("rows", "needs"))
        tries = [(*c, *size) for c in calibrations for size in sizes_to_try(s, records)]
        many = len(records) > 1 and not s.linear
        wanted = 1 if s.linear else DIRECTIONS if many else STARTS
        best = most_promising(likelihood, known, names, tries, wanted, s.score.signature, _signs if many else None)
        off = [base.values.get(n, 0.0) for n in names]
        without, most = outlook(likelihood, known, names, off).misfit, np.inf
        if s.linear:
            return [o.theta for o in best if o.misfit <= without - HALFWAY * least]
        if not (states or laws):  # with another law or more states runs may go another way altogether
            most = without - least
        if many and best:
            most = min(most, without - HALFWAY * (without - best[0].misfit))
        found = [o.theta for o in best if o.misfit <= most]
        negligible = s.negligible and any(o.misfit < without - HALFWAY * s.score.drop for o in best)
        if states and s.nonlinear_candidate:  # the error may fall only close to the truth
            return [*(() if negligible else found), *((*off[:calibrated], *(f * s.delta)) for f in GRID)]
        return [] if negligible else found

    def _hopeful(self, s: Screened, effects: int, odds: float) -> bool:
        """May a refit find that an effect is there, large or slight, as far as slopes tell, which is nearly all of it where it
        is linear and the model about right, or where forces make up for the rest?"""
        far = float(np.mean(s.evidence.r**2)) > FAR
        if not self.factory.leads and (far or not s.linear):
            return True
        told = of_score(s.score, self.one_sided(s.score.names), self.policy)
        return self.policy.log_prior(effects) + float(np.log(odds)) + max(told.large, told.slight) > -0.25 * self.policy.tied

    def judge(
        self,
        base: Fit,
        base_held: Evidence | None,
        found: Fit,
        held: Evidence | None,
        effect: str,
        names: Sequence[str],
        tests: int,
    ) -> Candidate:
        """What an effect, whose parameters are `names`, does in the model `found` beside `base`, which lacks it."""
        delta, (estimate, covariance) = self.deltas(names), estimates(found, names)
        lower, upper = (np.array([getattr(self.records[n], side) for n in names]) for side in ("lower", "upper"))
        one_sided, near = self.one_sided(names), 1e-6 * delta
        along, spread = seen_directions(estimate / delta, covariance / np.outer(delta, delta))
        dispersion = float(np.mean(found.evidence.r**2))
        drop, correlation = (base.misfit - found.misfit) / dispersion, correlation_time(found.evidence)
        p = max(chance_beyond(float(np.sum(along**2 / spread)), len(spread)), chance_beyond(drop / correlation, len(spread)))
        if len(names) == 1 and one_sided[0]:
            p /= 2
        return Candidate(
            effect=effect,
            fit=replace(found, evidence=found.evidence.summary()),
            drop=drop,
            estimate=estimate,
            covariance=covariance,
            between=_between(found, names, covariance),
            delta=delta,
            one_sided=one_sided,
            dispersion=dispersion,
            correlation=correlation,
            p=min(1.0, tests * p),
            gain=held_out_gain(base_held, held) if base_held and held and held.runs else None,
            heldout=held.summary() if held is not None else None,
            lawful=not bool(np.all((estimate <= near) & one_sided)),
            stretched=bool(np.any((estimate >= upper - near) | (estimate <= lower + near) & ~one_sided)),
            policy=self.policy,
        )

    def surely_large(self, found: Fit, effect: str) -> bool:
        """Is an effect of a fit with sensitivities surely large, rather than slight or nothing?"""
        names = self.factory.parameters(effect)
        delta, (estimate, covariance) = self.deltas(names), estimates(found, names)
        between, fall = _between(found, names, covariance), self.weight(found, effect)
        told = support_of(effect, estimate, (covariance, between), delta, self.one_sided(names), fall, 0.0, self.policy)
        return float(special.expit(told.large - max(0.0, told.slight))) > self.policy.sure

    def round(
        self,
        effects: tuple[str, ...],
        base: Fit,
        base_held: Evidence,
        among: Iterable[str] | None = None,
        most: int = SHORTLIST,
        twin: float = ALIKE,
        rival: float = math.inf,
        least: float = PROMISING,
        odds: float = 1.0,
        explained: float = 0.0,
    ) -> Round:
        """Screen, refit the shortlist, and rank. What lowers −2 log likelihood by less than `least`, as far as slopes tell, is
        not refitted; what looks like the leader, by a cosine above `twin`, is, however many there are; and groups of effects,
        where the whole catalogue is asked. `rival` is the misfit of another model to be compared with; for `odds` and
        `explained` see `Round`."""
        screened, joined = self.screen_groups(base, effects) if among is None else (self.screen(base, effects, among), [])
        candidates: list[Candidate] = []
        leader, hope, tests = math.inf, least, len(screened) + len(joined)
        likely = [s for s in screened if self._hopeful(s, len(screened), odds)]
        for s in (*shortlist(likely, most, twin), *joined):
            c = self.candidate(base, base_held, effects, s, tests, min(leader, rival), hope)
            if c is None:
                continue
            candidates.append(c)
            if c.fit.misfit < leader:
                leader = c.fit.misfit
                hope = max(least, _hope(base.misfit - leader, s.score.drop))
        best = ranked(candidates)
        alone, groups = (tuple(c for c in best if (len(c.members) > 1) == several) for several in (False, True))
        scores = tuple(s.score for s in screened)
        return Round(effects, base, base_held, scores, alone, groups=groups, odds=odds, explained=explained, policy=self.policy)


def _hope(fall: float, promised: float) -> float:
    """What another effect must promise beside one that did `fall`, and `promised` so much, to be refitted."""
    least = HOPELESS * fall
    return min(least, BESIDE * promised) if BEYOND * promised > fall else least


def _signs(sizes: Sequence[float]) -> tuple[float, ...]:
    return tuple(np.sign(sizes))


def sizes_to_try(s: Screened, records: Sequence[Parameter]) -> list[np.ndarray]:
    """Sizes (k,) of an effect's parameters from which a refit may start: the expected change, and multiples of δ of all of
    them, of one against the others, and of one alone, with both signs where that is lawful."""
    lower, upper = (np.array([getattr(r, side) for r in records]) for side in ("lower", "upper"))
    expected = np.where(np.isfinite(s.score.estimate), s.score.estimate, 0)
    several, both = len(records) > 1, bool((lower < 0).all())
    alone = [*np.diag(s.delta)] if several else []
    against = [s.delta - 2 * one for one in alone] if both else []
    multiples = (f * d for d in (s.delta, *alone, *against) for f in SIZES if f > 0 or both)
    return [np.clip(size, lower, upper) for size in (expected, *multiples)]


def _between(found: Fit, names: Sequence[str], otherwise: np.ndarray) -> np.ndarray:
    """Covariance (k, k) of some of a fit's parameters between runs, if there are enough of these."""
    if len(found.evidence.runs) < RUNS:
        return otherwise
    at = [found.names.index(n) for n in names]
    return between_runs(found)[np.ix_(at, at)]


def at_the_floor(fitted: Evidence, held: Evidence | None) -> bool:
    """Does a model leave nothing to explain, on fitted and on held-out runs?"""
    return fitted.rms < AT_THE_FLOOR and (held is None or not held.runs or held.rms < AT_THE_FLOOR)
