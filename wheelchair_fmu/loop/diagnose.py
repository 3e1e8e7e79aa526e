"""Screen, refit, hold out: find what is missing, one effect after the other, until nothing more is found."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..errors import SimulationError
from .chance import chance_beyond
from .evidence import Bench, Evidence
from .fit import Fit, fit, prior_of, start_value
from .noise import QUIETER, colour_of
from .screen import Score, projector, score
from .starts import Outlook, most_promising, outlook, visible_fall
from .statistics import correlation_time, cosines, estimates, finite, held_out_gain, seen_directions
from .timing import late
from .workshop import Workshop

SIGNIFICANT = 0.05
TIED = 9.2  # −2 log likelihood: odds of a hundred to one
VISIBLE = 0.03  # fall of the whitened RMS in the channel and run where it falls most
PLAIN = 1e-6  # corrected p below which held-out runs need not confirm, so long as they do not contradict
SHORTLIST = 5
HOPELESS = 0.2  # of the leader's fall: an effect that may not hope for more is not refitted
BENT = 1.0  # standard deviations of its prior by which a calibrated value counts as bent
SLIGHTLY = 0.1  # the same, where it costs little to look at both
PROMISING = 6.0  # hoped-for fall below which no refit could pass the corrected test
NEGLIGIBLE = 0.3  # of δ
SAME = 1.002  # ratio of two RMS errors that do not differ
FAINTLY, NEARLY_ENOUGH = 0.1, 0.7  # of the fall that is asked for: as slopes have it, and simulated
LITTLE = 100.0  # expected fall, above which an effect is refitted however small it seems from here
FAR = 1.1  # mean square innovation of a model that slopes are not to be trusted at
ALIKE = 0.9  # cosine above which a rival is refitted whatever its score
MOST_EFFECTS = 4
SIZES = (1.0, 2.0, 4.0, 8.0, -1.0, -2.0, -4.0, -8.0)  # of δ, from which a refit may start
STARTS = 2  # of these, for an effect whose slope at zero says little


def decisive(evidence: Evidence) -> float:
    """By how much −2 log likelihood has to differ, with residuals as correlated as these, for odds of a hundred to one."""
    return TIED * correlation_time(evidence)


@dataclass(frozen=True)
class Step:
    """One step of the staircase: whitened RMS on fitted and on held-out runs."""

    name: str
    fit: float
    heldout: float

    @property
    def left(self) -> float:
        """What is left on fitted and on held-out runs alike."""
        return min(self.fit, self.heldout) if np.isfinite(self.heldout) else self.fit

    def as_json(self) -> dict[str, str | float | None]:
        """The keys that are fixed for a step of the `ladder`."""
        return {"step": self.name, "fit": self.fit, "heldout": finite(self.heldout)}


@dataclass(frozen=True)
class Candidate:
    """One effect added to the model at hand and refitted."""

    effect: str
    fit: Fit
    drop: float  # fall of −2 log likelihood, divided by the residuals' dispersion
    estimate: np.ndarray
    se: np.ndarray
    p: float
    falls: bool  # does the RMS over all fitted runs, or over those held out, not rise?
    visible: float  # largest fall of a channel's RMS in a run
    gain: tuple[float, float, float] | None  # held-out gain with its 95 % interval, None without held-out runs
    heldout: Evidence | None
    small: bool
    lawful: bool

    @property
    def proven(self) -> bool:
        """There, visible, and it predicts runs it has not seen."""
        predicts = self.gain is None or self.gain[1] > 0 or (self.p < PLAIN and self.gain[2] > 0)
        shows = self.visible > VISIBLE and self.falls
        return self.lawful and self.p < SIGNIFICANT and shows and predicts

    @property
    def found(self) -> bool:
        """Proven, and large enough to matter."""
        return self.proven and not self.small


@dataclass(frozen=True)
class Round:
    """One round of search: the model it started from, all scores, and the refitted candidates, best first."""

    effects: tuple[str, ...]
    fit: Fit
    heldout: Evidence
    scores: tuple[Score, ...]
    candidates: tuple[Candidate, ...]

    @property
    def winner(self) -> Candidate | None:
        """The best candidate found, unless one that is surely small explains the data better by far."""
        best = next((c for c in self.candidates if c.found), None)
        if best is None:
            return None
        far = best.drop + decisive(best.fit.evidence)
        better = (c for c in self.candidates if c.small and c.lawful and c.drop > far)
        return None if any(better) else best


@dataclass(frozen=True)
class Screened:
    """An effect's score, and the evidence it rests on, with sensitivities by what is fitted, by this effect and by others.
    `straight`: it does most about calibrated values as the campaign has them, not as a fit without it left them."""

    score: Score
    evidence: Evidence
    delta: np.ndarray
    straight: bool = False

    @property
    def negligible(self) -> bool:
        """Does it gain little, being surely a small part of its smallest interesting size?"""
        far = np.abs(self.score.estimate) + 3 * self.score.se
        return self.score.drop < LITTLE and bool(np.all(far < NEGLIGIBLE * self.delta))

    @property
    def far(self) -> bool:
        """Is so much left, and hoped for, that an effect may do more than slopes say?"""
        return float(np.mean(self.evidence.r**2)) > FAR and self.score.drop > LITTLE

    def shows(self, visible: float) -> bool:
        """Might it lower some channel's RMS in some run by so much, for all that a slope can tell?"""
        return self.far or self.score.visible > FAINTLY * visible


class Search:
    """The search for what is missing, in a workshop."""

    def __init__(self, workshop: Workshop, progress: Callable[[str], None] = lambda words: None):
        self.workshop, self.say = workshop, progress
        self.offsets = tuple(workshop.bench().offsets)
        self.records = {p.name: p for e in workshop.catalogue.values() for p in e.owned}
        self._twins: dict[str, frozenset[str]] = {}
        self._without: dict[tuple[object, ...], tuple[Fit, Evidence]] = {}
        self.notes: list[str] = []  # on runs left out
        self.noise_notes: list[str] = []

    # -- models ---------------------------------------------------------------------------------------------

    def refit(self, effects: Sequence[str], start: Mapping[str, float], here: Evidence | None = None, **how: Any) -> Fit:
        """The campaign's best values of the calibrated and these effects' parameters; see `fit`."""
        return fit(self.workshop.bench(effects), self.names(effects), start, here, **how)

    def names(self, effects: Sequence[str]) -> list[str]:
        """What a model with these effects has to be fitted by."""
        twins = frozenset().union(*(self._twins.get(e, ()) for e in effects))
        offsets = (n for n in self.offsets if n not in twins)
        return [*self.workshop.calibrated, *offsets, *(n for e in effects for n in self.workshop.parameters(e))]

    def with_given(self, effects: Sequence[str], base: Fit) -> tuple[Fit, Evidence]:
        """The model with these effects, which the variant has already, estimated anew."""
        return self.settled(effects, self.refit(effects, {**self.workshop.given, **base.values}))

    def settled(self, effects: Sequence[str], found: Fit) -> tuple[Fit, Evidence]:
        """A fit again from its own result, with every run started where this model wants it, and held out."""
        bench = self.workshop.bench(effects)
        bench.evidence(self.workshop.campaign.runs, found.values, (), tune_start=2)
        self.workshop.remember(bench)
        again = self.refit(effects, found.values)
        held = self.heldout(bench, again.values)
        self.workshop.remember(bench)
        return again, held

    def pruned(self, effects: tuple[str, ...], found: Fit) -> tuple[tuple[str, ...], Fit]:
        """Backward: leave out every effect but the last that the others have made needless."""
        for effect in effects[:-1]:
            fewer = tuple(e for e in effects if e != effect)
            without = self.refit(fewer, found.values)
            if without.misfit - found.misfit < decisive(found.evidence) * float(np.mean(found.evidence.r**2)):
                return self.pruned(fewer, without)
        return effects, found

    def heldout(self, bench: Bench, values: Mapping[str, float]) -> Evidence:
        """Evidence of the held-out runs; only where each starts is estimated on them."""
        return bench.evidence(self.workshop.campaign.holdout, values, (), tune_start=1)

    def recolour(self, evidence: Evidence, *, again: bool = False) -> bool:
        """Take the noise that these residuals show, and say whether it is another than before. `again`: now that an effect
        is in that was missing when the noise was estimated."""
        before = self.workshop.colour
        lowest = QUIETER if again else 0.0
        self.workshop.colour, self.noise_notes = colour_of(evidence, self.workshop.campaign.noise, before, lowest)
        return self.workshop.colour.differs(before)

    # -- screen ---------------------------------------------------------------------------------------------

    def screen(self, base: Fit, effects: Sequence[str], among: Iterable[str] | None = None) -> list[Screened]:
        """Score tests of every effect not yet in the model: by slope at zero where that is cheap, by secant where it is not or
        may mislead."""
        w = self.workshop
        free = [e for e in (among if among is not None else w.catalogue) if e not in effects and w.parameters(e)]
        found, here = self._by_slopes(effects, base, [e for e in free if e in w.light])
        for group in (w.heavy, w.demanding):
            more = [e for e in free if e in group]
            if more:
                found += self._by_secants(w.bench((*effects, *more)), base, here, more)
        return sorted(found, key=lambda s: -s.score.drop)

    def _by_slopes(self, effects: Sequence[str], base: Fit, light: Sequence[str]) -> tuple[list[Screened], Evidence]:
        """Scores of effects that make no simulation dearer, and the evidence with sensitivities by all of them."""
        w = self.workshop
        bench, names = w.bench(effects), [n for e in light for n in w.parameters(e)]
        here = bench.evidence(w.campaign.fit, base.values, [*base.names, *names])
        off, unbent = self._off(bench, base, here), self._unbent(bench, base, names)
        found = []
        for effect in light:
            if self._is_an_offset(effect, here):
                found += self._by_slopes(effects, self._base(effect, effects, base, None)[0], [effect])[0]
                continue
            own, columns = ([by.index(n) for n in w.parameters(effect)] for by in (here.by, names))
            tangent = self._score(here, off, effect, here.S[:, own])
            bent = [] if self._linear(effect) else self._secants(bench, here, base.values, effect)
            secants = [self._score(here, off, effect, S) for S in (*bent, *(S[:, columns] for S in unbent))]
            found.append(self._screened([tangent, *secants], here))
        return found, here

    def _by_secants(self, bench: Bench, base: Fit, here: Evidence, effects: Sequence[str]) -> list[Screened]:
        """Scores of effects with states of their own. To follow these through all derivatives costs more than to try a size,
        and the filters of the model without them serve: at zero they change nothing."""
        at = []
        for values in (base.values, *self._straightened(bench, base, SLIGHTLY)):
            try:
                at.append((values, bench.again(here, values)))
            except SimulationError:
                if not at:
                    return []
        off, found = self._off(bench, base, here), []
        for effect in effects:
            by = [[self._score(at[0][1], off, effect, S) for S in self._secants(bench, e, values, effect)] for values, e in at]
            scores = [score for group in by for score in group]
            if scores:
                best = self._screened(scores, here)
                found.append(replace(best, straight=all(best.score.drop > score.drop for score in by[0])))
        return found

    def _off(self, bench: Bench, base: Fit, here: Evidence) -> Callable[[np.ndarray], np.ndarray]:
        """Takes what calibration can imitate off any columns."""
        return projector(here.S[:, : len(base.names)], prior_of(bench, base.names).slopes)

    def _screened(self, scores: Sequence[Score], here: Evidence) -> Screened:
        """The most promising of several scores of an effect, with the first one's p: that nobody picked."""
        best = max(scores, key=lambda s: s.drop)
        return Screened(replace(best, p=scores[0].p), here, self._deltas(best.names))

    def _unbent(self, bench: Bench, base: Fit, names: Sequence[str]) -> list[np.ndarray]:
        """Slopes (N, k) by `names` with calibrated values as the campaign has them, where a fit without the effect has bent
        them: what it bent to imitate an effect may be what the effect works through."""
        straightened = self._straightened(bench, base, BENT) if names else []
        try:
            return [bench.evidence(self.workshop.campaign.fit, values, names).S for values in straightened]
        except SimulationError:
            return []

    @staticmethod
    def _straightened(bench: Bench, base: Fit, least: float) -> list[dict[str, float]]:
        """Calibrated values as the campaign has them, if a fit has bent them by `least` standard deviations."""
        prior, values = prior_of(bench, base.names), np.array([base.values[n] for n in base.names])
        off = np.where(np.isfinite(prior.sd), np.abs(values - prior.mean) / prior.sd, 0.0)
        straight = np.where(np.isfinite(prior.sd) & (prior.sd > 0), prior.mean, values)
        return [dict(zip(base.names, map(float, straight), strict=True))] if off.max(initial=0) > least else []

    def _is_an_offset(self, effect: str, evidence: Evidence) -> bool:
        """Is this effect the very thing that a nuisance of the model stands for? It is never tested beside that."""
        offsets = [n for n in self.offsets if n in evidence.by]
        if not offsets:
            return False
        own = evidence.S[:, [evidence.by.index(n) for n in self.workshop.parameters(effect)]]
        columns = evidence.S[:, [evidence.by.index(n) for n in offsets]]
        rest = columns - own @ np.linalg.lstsq(own, columns, rcond=None)[0]
        same = np.linalg.norm(rest, axis=0) < 1e-6 * np.linalg.norm(columns, axis=0)
        if same.any():
            self._twins[effect] = frozenset(n for n, s in zip(offsets, same, strict=True) if s)
        return bool(same.any())

    def _base(self, effect: str, effects: Sequence[str], base: Fit, held: Evidence | None) -> tuple[Fit, Evidence | None]:
        """The model that an effect is judged against: the one at hand, but never with a nuisance that does the same."""
        if not self._twins.get(effect):
            return base, held
        key = (effect, *effects)
        if key not in self._without:
            names = [n for n in self.names(effects) if n not in self._twins[effect]]
            bench = self.workshop.bench(effects)
            fewer = fit(bench, names, base.values)
            self._without[key] = fewer, self.heldout(bench, fewer.values)
        return self._without[key]

    def _score(self, evidence: Evidence, off: Callable[[np.ndarray], np.ndarray], effect: str, S: np.ndarray) -> Score:
        records = [self.records[n] for n in self.workshop.parameters(effect)]
        delta = np.array([r.smallest_interesting for r in records])
        return score(evidence, off, effect, [r.name for r in records], S, delta, np.array([r.lower == 0 for r in records]))

    def _secants(self, bench: Bench, known: Evidence, values: Mapping[str, float], effect: str) -> list[np.ndarray]:
        """What the effect really does at its smallest interesting size, and at minus that where that may be another thing:
        (N, k) per unit, each. `known` is the evidence at `values`, where it is off."""
        records = [self.records[n] for n in self.workshop.parameters(effect)]
        found = []
        for sign in (1.0,) if self._linear(effect) else (1.0, -1.0):
            sizes = {r.name: sign * r.smallest_interesting for r in records if r.lower <= sign * r.smallest_interesting}
            try:
                columns = [(known.r - bench.again(known, {**values, n: size}).r) / size for n, size in sizes.items()]
            except SimulationError:
                continue
            if len(columns) == len(records):
                found.append(np.stack(columns, axis=1))
        return found

    def _linear(self, effect: str) -> bool:
        """Does the slope at zero tell what the effect does at the size it has?"""
        record = self.workshop.catalogue[effect]
        return not (record.even or record.rows or record.needs)

    # -- refits ---------------------------------------------------------------------------------------------

    def candidate(self, base: Fit, base_held: Evidence | None, effects: tuple[str, ...], s: Screened,
                  tests: int, rival: float = math.inf, least: float = -math.inf,
                  visible: float = 0.0) -> Candidate | None:  # fmt: skip
        """Refit with one more effect, from the expected change and from sizes of interest, if −2 log likelihood may fall by
        `least`, and some channel's RMS in some run by `visible`; `rival` is the best misfit yet."""
        w, effect = self.workshop, s.score.effect
        bench = w.bench((*effects, effect))
        base, base_held = self._base(effect, effects, base, base_held)
        starts = self._starts(bench, base, s, least, visible)
        if starts:
            self.say(f"refitting {effect}")
        begun = []
        for start, here in starts:
            try:
                begun.append(self.refit((*effects, effect), start, here, rival=rival, most=1))
            except SimulationError:
                continue
        if not begun:
            return None
        ahead = min(begun, key=lambda f: f.misfit)
        found = self.refit((*effects, effect), ahead.values, ahead.evidence, rival=rival)
        held = bench.evidence(w.campaign.holdout, found.values) if w.campaign.holdout else None
        return self.judge(base, base_held, found, held, effect, w.parameters(effect), tests)

    def _starts(self, bench: Bench, base: Fit, s: Screened, least: float,
                visible: float) -> list[tuple[dict[str, float], Evidence | None]]:  # fmt: skip
        """Where to start refits, and what is known there, where −2 log likelihood may fall by `least` and some channel's RMS
        in some run by `visible`: a linear effect from zero, others from the most promising of several sizes: the expected
        change, both signs of δ, and larger ones."""
        names = [*base.names, *self.workshop.parameters(s.score.effect)]
        records = [self.records[n] for n in self.workshop.parameters(s.score.effect)]
        straightened = self._straightened(bench, base, SLIGHTLY if s.straight else BENT)
        calibrations = [[values[n] for n in base.names] for values in (base.values, *straightened)]
        linear, off = self._linear(s.score.effect), [base.values.get(n, 0.0) for n in names]
        if linear and s.score.drop < least:
            return []
        if linear and len(calibrations) == 1:
            known = s.evidence.only(names) if set(names) <= set(s.evidence.by) else None
            if known and not self._shows(bench, known, names, s, outlook(bench, known, names, off), visible):
                return []
            return [(dict(zip(names, off, strict=True)), known)]
        delta = np.array([r.smallest_interesting for r in records])
        lower, upper = (np.array([getattr(r, side) for r in records]) for side in ("lower", "upper"))
        expected = np.where(np.isfinite(s.score.estimate), s.score.estimate, 0)
        alone = [*np.diag(delta)] if len(delta) > 1 else []  # one parameter of several
        sizes = [expected, *(f * d for d in (delta, *alone) for f in SIZES if f > 0 or (lower < 0).all())]
        tries = [np.concatenate([c, np.clip(size, lower, upper)]) for c in calibrations for size in sizes]
        known = s.evidence.only(base.names)
        best = most_promising(bench, known, names, tries, 1 if linear else STARTS, s.score.signature)
        record, most = self.workshop.catalogue[s.score.effect], np.inf
        if not (linear or record.needs or record.rows):  # with another law or more states runs may go another way altogether
            most = outlook(bench, known, names, off).misfit - least
        best = [o for o in best if o.misfit <= most and self._shows(bench, known, names, s, o, visible)]
        return [(dict(zip(names, o.theta, strict=True)), None) for o in best]

    @staticmethod
    def _shows(bench: Bench, known: Evidence, names: Sequence[str], s: Screened, to: Outlook, visible: float) -> bool:
        """Does an effect lower some channel's RMS in some run by about so much, by a step that was simulated?"""
        return visible == 0 or s.far or visible_fall(bench, known, names, to) > NEARLY_ENOUGH * visible

    def judge(self, base: Fit, base_held: Evidence, found: Fit, held: Evidence | None, effect: str,
              names: Sequence[str], tests: int) -> Candidate:  # fmt: skip
        """What an effect, whose parameters are `names`, does in the model `found` beside `base`, which lacks it."""
        delta, (estimate, covariance) = self._deltas(names), estimates(found, names)
        one_sided = np.array([self.records[n].lower == 0 for n in names])
        along, spread = seen_directions(estimate / delta, covariance / np.outer(delta, delta))
        dispersion = float(np.mean(found.evidence.r**2))
        drop = (base.misfit - found.misfit) / dispersion
        p = max(chance_beyond(float(np.sum(along**2 / spread)), len(spread)),
                chance_beyond(drop / correlation_time(found.evidence), len(spread)))  # fmt: skip
        if len(names) == 1 and one_sided[0]:
            p /= 2
        before, after = base.evidence.table(), found.evidence.table()
        return Candidate(
            effect=effect,
            fit=replace(found, evidence=found.evidence.brief()),
            drop=drop,
            estimate=estimate,
            se=np.sqrt(np.maximum(np.diag(covariance), 0)),
            p=min(1.0, tests * p),
            falls=found.evidence.rms < SAME * base.evidence.rms or (held is not None and held.rms < base_held.rms),
            visible=max(before[run][c] - after[run][c] for run in before for c in before[run]),
            gain=held_out_gain(base_held, held) if held is not None else None,
            heldout=held.brief() if held is not None else None,
            small=_small(along, spread),
            lawful=not bool(np.all((estimate <= 1e-6 * delta) & one_sided)),
        )

    def small(self, found: Fit, effect: str) -> bool:
        """Is an effect surely smaller than its smallest interesting size, in a fit with sensitivities?"""
        names = self.workshop.parameters(effect)
        delta, (estimate, covariance) = self._deltas(names), estimates(found, names)
        return _small(*seen_directions(estimate / delta, covariance / np.outer(delta, delta)))

    def _deltas(self, names: Sequence[str]) -> np.ndarray:
        """Smallest interesting sizes (k,)."""
        return np.array([self.records[n].smallest_interesting for n in names])

    # -- search ---------------------------------------------------------------------------------------------

    def round(self, effects: tuple[str, ...], base: Fit, base_held: Evidence, among: Iterable[str] | None = None,
              most: int = SHORTLIST, visible: float = 0.0, twin: float = ALIKE, rival: float = math.inf,
              least: float = PROMISING) -> Round:  # fmt: skip
        """Screen, refit the shortlist, and rank. What lowers no channel's error in a run by `visible`, or −2 log likelihood by
        `least`, as far as slopes tell, is not refitted; what looks like the leader, by a cosine above `twin`, is, however many
        there are. `rival` is the misfit of another model to be compared with."""
        screened = self.screen(base, effects, among)
        candidates: list[Candidate] = []
        for s in shortlist([s for s in screened if not self._linear(s.score.effect) or s.shows(visible)], most, twin):
            leader = min((c.fit.misfit for c in candidates), default=math.inf)
            hope = max(least, HOPELESS * (base.misfit - leader))
            c = self.candidate(base, base_held, effects, s, len(screened), min(leader, rival), hope, visible)
            if c is not None:
                candidates.append(c)
        candidates.sort(key=lambda c: -c.drop)
        return Round(effects, base, base_held, tuple(s.score for s in screened), tuple(candidates))

    def calibrate(self) -> tuple[Fit, Evidence, Evidence, Evidence]:
        """(calibrated fit, its held-out evidence, nominal fit evidence, nominal held-out evidence)."""
        w = self.workshop
        bench = w.bench()
        names = self.names(())
        start = {n: start_value(bench, bench.records[n]) for n in names}
        nominal = bench.evidence(w.campaign.fit, start, (), tune_start=1)
        nominal_held = bench.evidence(w.campaign.holdout, start, (), tune_start=1)
        found = fit(bench, names, start)
        bench.evidence(w.campaign.fit, found.values, (), tune_start=1)
        found = fit(bench, names, found.values)
        held = self.heldout(bench, found.values)
        w.remember(bench)
        return found, held, nominal, nominal_held


def _small(along: np.ndarray, variance: np.ndarray) -> bool:
    """Are all these sizes, in δ, surely below 1?"""
    return bool(np.all(np.abs(along) + 1.96 * np.sqrt(variance) < 1))


def begin(search: Search, say: Callable[[str], None]) -> tuple[Fit, Evidence, list[Step]]:
    """Calibrate, with the noise that the data show: (fit, held out, the staircase's first two steps).

    Runs whose pushes belong to another time are left out, if others are there to be fitted.
    """
    say("calibrating")
    base, held, ladder = first_steps(search)
    w = search.workshop
    shifted = {**late(w.bench(), base.evidence, base.values), **late(w.bench(), held, base.values)}
    spared = any(r.name not in shifted for r in w.campaign.fit)
    if shifted and spared:
        w.leave_out(shifted)
        base, held, ladder = first_steps(search)
    search.notes = [_late(run, seconds, spared) for run, seconds in shifted.items()]
    return first_steps(search) if search.recolour(base.evidence) else (base, held, ladder)


def first_steps(search: Search) -> tuple[Fit, Evidence, list[Step]]:
    """The calibrated fit, its held-out evidence, and the staircase up to there, with the noise as it is known."""
    base, held, nominal, nominal_held = search.calibrate()
    return base, held, [Step("nominal", nominal.rms, nominal_held.rms), Step("calibrated", base.evidence.rms, held.rms)]


def _late(run: str, seconds: float, left_out: bool) -> str:
    after = "the run is left out" if left_out else "no other run is there to be fitted, so no verdict can be trusted"
    return (f"{run}: its pushes seem to be recorded {abs(seconds):.1f} s too {'early' if seconds > 0 else 'late'} for what was "
            f"measured; {after}. Correct its time column")  # fmt: skip


def shortlist(screened: Sequence[Screened], most: int, twin: float) -> list[Screened]:
    """The best by expected drop, and whatever looks like the leader; not what is surely far too small to matter."""
    promising = [s for s in screened if s.score.drop > PROMISING and not s.negligible]
    first, rest = promising[:most], promising[most:]
    near = cosines([s.score for s in first[:1]], [s.score for s in rest])[0] if rest else ()
    return [*first, *(s for s, cosine in zip(rest, near, strict=True) if cosine > twin)]
