"""Screen, refit, hold out: find what is missing, one effect after the other, until nothing more is found."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..errors import SimulationError
from ..quantities import Parameter
from .chance import chance_beyond
from .factory import TOGETHER
from .fit import Fit
from .likelihood import Evidence, Likelihood
from .marginal import Support, support_of
from .parallel import parallel_map
from .score import RUNS, Score
from .screen import AT_THE_FLOOR, BENT, PROMISING, SLIGHTLY, Screen, Screened, shortlist
from .starts import Outlook, most_promising, outlook, visible_fall
from .statistics import between_runs, correlation_time, decisive, estimates, held_out_gain, seen_directions, size_seen

SIGNIFICANT = 0.05
VISIBLE = 0.03  # fall of the whitened RMS in the channel and run where it falls most
PLAIN = 1e-6  # corrected p below which held-out runs need not confirm, so long as they do not contradict
SHORTLIST = 5
HOPELESS = 0.2  # of the leader's fall: an effect that may not hope for more is not refitted,
BESIDE = 0.5  # unless it may hope for this part of what slopes promised of the leader,
BEYOND = 10.0  # or they say little of it, and it may do so many times what they say
SAME = 1.002  # ratio of two RMS errors that do not differ
NEARLY_ENOUGH = 0.7  # of the fall that is asked for, simulated
SURELY = 0.8  # of δ, below which an effect is small
AS_LARGE = 0.95  # the same, where a model without it leaves nothing to explain
ALIKE = 0.9  # cosine above which a rival is refitted whatever its score
SIZES = (1.0, 2.0, 4.0, 8.0, -1.0, -2.0, -4.0, -8.0)  # of δ, from which a refit may start
STARTS = 2  # of these, for an effect whose slope at zero says little; if it has several parameters, one of
DIRECTIONS = 4  # pairs of signs, and of these
ENDED = 3  # refits go on to their end
HALFWAY = 0.5  # of the fall that is expected, or that the best direction promises, or that is asked for of a linear effect:
# where less is promised no refit starts, and if no size at all promises so much, refits start from
GRID = (1.0, 2.0, 4.0)  # of δ as well


@dataclass(frozen=True)
class Candidate:
    """One effect, or a group of them, added to the model at hand and refitted."""

    effect: str  # or the group's name
    fit: Fit
    drop: float  # fall of −2 log likelihood, divided by the residuals' dispersion
    estimate: np.ndarray
    covariance: np.ndarray  # (k, k) of the estimate
    between: np.ndarray  # (k, k) the same by how far runs would have it apart, where there are enough
    delta: np.ndarray
    one_sided: np.ndarray  # (k,) which of its parameters may only be positive
    dispersion: float  # mean square innovation
    correlation: float  # samples per independent one
    p: float
    falls: bool  # does the RMS over all fitted runs, or over those held out, not rise?
    visible: float  # largest fall of a channel's RMS in a run
    gain: tuple[float, float, float] | None  # held-out gain with its 95 % interval, None without held-out runs
    heldout: Evidence | None
    small: bool  # surely
    large: bool  # enough, by its estimate, to be named
    lawful: bool
    stretched: bool = False  # to a bound, beyond which no chair is: what asks for more of it is something else
    beside: tuple[float, float] | None = None  # dispersion and correlation that the likeliest of its round leaves

    @property
    def members(self) -> tuple[str, ...]:
        """The effects that it is of."""
        return tuple(self.effect.split(TOGETHER))

    @property
    def scale(self) -> float:
        """−2 log likelihood that counts as one, with residuals as large and as correlated as the likeliest model leaves."""
        dispersion, correlation = self.beside or (self.dispersion, self.correlation)
        return dispersion * correlation

    @cached_property
    def support(self) -> Support:
        """What bears it out, beside the model without it, and however many parameters it has."""
        fall, ahead = max(self.drop, 0.0) * self.dispersion / self.scale, self.gain[0] / self.scale if self.gain else 0.0
        return support_of(self.effect, self.estimate, (self.covariance, self.between), self.delta, self.one_sided, fall, ahead)

    @property
    def se(self) -> np.ndarray:
        """Standard errors (k,)."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0))

    @property
    def proven(self) -> bool:
        """There, visible, and it predicts runs it has not seen."""
        predicts = self.gain is None or self.gain[1] > 0 or (self.p < PLAIN and self.gain[2] > 0)
        shows = self.visible > VISIBLE and self.falls
        return self.lawful and not self.stretched and self.p < SIGNIFICANT and shows and predicts

    @property
    def found(self) -> bool:
        """Proven, and large enough to matter."""
        return self.proven and self.large


def ranked(candidates: Iterable[Candidate]) -> list[Candidate]:
    """Candidates of one model, best first: by marginal likelihood, with residuals as the likeliest leaves them."""
    found = list(candidates)
    likeliest = max(found, key=lambda c: c.drop * c.dispersion, default=None)
    if likeliest is None:
        return []
    beside = likeliest.dispersion, likeliest.correlation
    return sorted((replace(c, beside=beside) for c in found), key=lambda c: -c.support.large)


@dataclass(frozen=True)
class Round:
    """One round of search: the model it started from, all scores, and the refitted candidates, best first; `groups` are those
    of several effects together. `again`: it is for what an earlier round found, beside all that was found later. `contested`:
    it judges one effect of a group that others came near to, and nobody asked whether they do so in the place of this one."""

    effects: tuple[str, ...]
    fit: Fit
    heldout: Evidence
    scores: tuple[Score, ...]
    candidates: tuple[Candidate, ...]
    again: bool = False
    groups: tuple[Candidate, ...] = ()
    contested: bool = False

    @property
    def winner(self) -> Candidate | None:
        """The best candidate found, or group of them, unless one that is not large explains the data better by far."""
        every = sorted((*self.candidates, *self.groups), key=lambda c: -c.support.large) if self.groups else self.candidates
        best = next((c for c in every if c.found), None)
        if best is None:
            return None
        far = best.drop + decisive(best.fit.evidence)
        better = (c for c in self.candidates if not c.large and c.lawful and c.drop > far)
        return None if any(better) else best

    @property
    def help(self) -> Candidate | None:
        """The best candidate proven, however small, if slopes promised about as much: a refit may owe its fall to a better
        calibration."""
        promised = {s.effect: s.drop for s in self.scores}
        return next((c for c in self.candidates if c.proven and promised[c.effect] > BESIDE * c.drop), None)


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
        visible: float = 0.0,
    ) -> Candidate | None:
        """Refit with one more effect, from the expected change and from sizes of interest, if −2 log likelihood may fall by
        `least`, and some channel's RMS in some run by `visible`; `rival` is the best misfit yet."""
        w, effect = self.factory, s.score.effect
        likelihood = w.likelihood((*effects, effect))
        base, base_held = self.rival_of(effect, effects, base, base_held)
        rival = min(rival, base.misfit)  # which it has as a special case
        starts = self._starts(likelihood, base, s, least, visible)
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
        self, likelihood: Likelihood, base: Fit, s: Screened, least: float, visible: float
    ) -> list[tuple[dict[str, float], Evidence | None]]:
        """Where to start refits, and what is known there, where −2 log likelihood may fall by `least` and some channel's RMS
        in some run by `visible`: a linear effect from zero, others from the most promising of several sizes: the expected
        change, both signs of δ, and larger ones."""
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
            if known and not s.forced(visible):
                step = outlook(likelihood, known, names, off)
                if not self._shows(likelihood, known, names, s, step, visible):
                    return []
            return [(dict(zip(names, off, strict=True)), known)]
        thetas = self._sizes(likelihood, base, names, calibrations, s, least, visible)
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
        visible: float,
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
            hopeful = (o for o in best if o.misfit <= without - HALFWAY * least)
            return [o.theta for o in hopeful if self._shows(likelihood, known, names, s, o, visible)]
        if not (states or laws):  # with another law or more states runs may go another way altogether
            most = without - least
        if many and best:
            most = min(most, without - HALFWAY * (without - best[0].misfit))
        found = [o.theta for o in best if o.misfit <= most and self._shows(likelihood, known, names, s, o, visible)]
        as_expected = any(o.misfit < without - HALFWAY * s.score.drop for o in best)
        negligible = s.negligible and as_expected
        if states and s.nonlinear_candidate and (visible == 0 if negligible else found and not as_expected):
            # the error may fall only close to the truth
            return [*(() if negligible else found), *((*off[:calibrated], *(f * s.delta)) for f in GRID)]
        return [] if negligible else found

    @staticmethod
    def _shows(likelihood: Likelihood, known: Evidence, names: Sequence[str], s: Screened, to: Outlook, visible: float) -> bool:
        """Does an effect lower some channel's RMS in some run by about so much, by a step that was simulated?"""
        return s.forced(visible) or visible_fall(likelihood, known, names, to) > NEARLY_ENOUGH * visible

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
        one_sided, near = lower == 0, 1e-6 * delta
        in_deltas = estimate / delta, covariance / np.outer(delta, delta)
        along, spread = seen_directions(*in_deltas)
        small = _small(along, spread)
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
            falls=found.evidence.rms < SAME * base.evidence.rms or bool(held and base_held and held.rms < base_held.rms),
            visible=base.evidence.fall_to(found.evidence),
            gain=held_out_gain(base_held, held) if base_held and held and held.runs else None,
            heldout=held.summary() if held is not None else None,
            small=small,
            large=not small and size_seen(*in_deltas) >= (AS_LARGE if at_the_floor(base.evidence, base_held) else SURELY),
            lawful=not bool(np.all((estimate <= near) & one_sided)),
            stretched=bool(np.any((estimate >= upper - near) | (estimate <= lower + near) & ~one_sided)),
        )

    def small(self, found: Fit, effect: str) -> bool:
        """Is an effect surely smaller than its smallest interesting size, in a fit with sensitivities?"""
        return _small(*seen_directions(*self._in_deltas(found, effect)))

    def size(self, found: Fit, effect: str) -> float:
        """How large an effect is in such a fit, in δ; see `size_seen`."""
        return size_seen(*self._in_deltas(found, effect))

    def _in_deltas(self, found: Fit, effect: str) -> tuple[np.ndarray, np.ndarray]:
        names = self.factory.parameters(effect)
        delta, (estimate, covariance) = self.deltas(names), estimates(found, names)
        return estimate / delta, covariance / np.outer(delta, delta)

    def round(
        self,
        effects: tuple[str, ...],
        base: Fit,
        base_held: Evidence,
        among: Iterable[str] | None = None,
        most: int = SHORTLIST,
        visible: float = 0.0,
        twin: float = ALIKE,
        rival: float = math.inf,
        least: float = PROMISING,
    ) -> Round:
        """Screen, refit the shortlist, and rank. What lowers no channel's error in a run by `visible`, or −2 log likelihood by
        `least`, as far as slopes tell, is not refitted; what looks like the leader, by a cosine above `twin`, is, however many
        there are; and groups of effects, where the whole catalogue is asked. `rival` is the misfit of another model to be
        compared with."""
        screened, joined = self.screen_groups(base, effects) if among is None else (self.screen(base, effects, among), [])
        candidates: list[Candidate] = []
        leader, hope, tests = math.inf, least, len(screened) + len(joined)
        for s in (*shortlist([s for s in screened if not s.linear or s.shows(visible)], most, twin), *joined):
            c = self.candidate(base, base_held, effects, s, tests, min(leader, rival), hope, visible)
            if c is None:
                continue
            candidates.append(c)
            if c.fit.misfit < leader:
                leader = c.fit.misfit
                hope = max(least, _hope(base.misfit - leader, s.score.drop))
        best = ranked(candidates)
        alone, groups = (tuple(c for c in best if (len(c.members) > 1) == several) for several in (False, True))
        return Round(effects, base, base_held, tuple(s.score for s in screened), alone, groups=groups)


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


def _small(along: np.ndarray, variance: np.ndarray) -> bool:
    """Are all these sizes, in δ, surely below 1? Standard errors allow for noise, `SURELY` for models that mean the same by a
    parameter and differ by a fifth."""
    return bool(np.all(np.abs(along) + 1.96 * np.sqrt(variance) < SURELY))
