"""Screen, refit, hold out: find what is missing, one effect after the other, until nothing more is found."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import stats

from ..errors import SimulationError
from .evidence import Bench, Evidence
from .fit import Fit, fit, prior_of
from .screen import Score, projector, robust_variance, score
from .workshop import Workshop

CALIBRATED = ("tyre.C_lambda", "resistance.f_r", "resistance.f_f", "chair.I_z")
SIGNIFICANT = 0.05
TIED = 9.2  # −2 log likelihood: odds of a hundred to one
VISIBLE = 0.01  # fall of the whitened RMS in the channel and run where it falls most
SHORTLIST = 6
ALIKE = 0.9  # cosine above which a rival is refitted whatever its score
MOST_EFFECTS = 4
BLOCK = 2.0  # s of held-out data that are resampled together
RESAMPLES = 400


@dataclass(frozen=True)
class Candidate:
    """One effect added to the model at hand and refitted."""

    effect: str
    fit: Fit
    drop: float  # fall of −2 log likelihood, divided by the residuals' dispersion
    estimate: np.ndarray
    se: np.ndarray
    p: float
    visible: float  # largest fall of a channel's RMS in a run
    gain: tuple[float, float, float] | None  # held-out gain with its 95 % interval, None without held-out runs
    heldout: float
    small: bool
    lawful: bool

    @property
    def found(self) -> bool:
        """There, large enough to matter, visible, and it predicts runs it has not seen."""
        predicts = self.gain is None or self.gain[1] > 0
        return self.lawful and self.p < SIGNIFICANT and not self.small and self.visible > VISIBLE and predicts


@dataclass(frozen=True)
class Round:
    """One round of search: the model it started from, all scores, and the refitted candidates, best first."""

    effects: tuple[str, ...]
    fit: Fit
    heldout: Evidence
    scores: tuple[Score, ...]
    candidates: tuple[Candidate, ...]


class Search:
    """The state of a diagnosis: a workshop, what is calibrated, and the rounds so far."""

    def __init__(self, workshop: Workshop, calibrated: Sequence[str] = CALIBRATED,
                 progress: Callable[[str], None] = lambda words: None):  # fmt: skip
        self.workshop, self.calibrated, self.say = workshop, tuple(calibrated), progress
        self.records = {p.name: p for e in workshop.catalogue.values() for p in e.owned}

    # -- models ---------------------------------------------------------------------------------------------

    def refit(self, effects: Sequence[str], start: Mapping[str, float], precision: float = 1e-6) -> tuple[Fit, Bench]:
        """The campaign's best values of the calibrated and these effects' parameters."""
        bench = self.workshop.bench(effects)
        names = [*self.calibrated, *(n for e in effects for n in self.workshop.parameters(e))]
        found = fit(bench, names, start, precision=precision)
        return found, bench

    def heldout(self, bench: Bench, values: Mapping[str, float]) -> Evidence:
        found = bench.evidence(self.workshop.campaign.holdout, values, (), tune_start=1)
        return found

    # -- screen ---------------------------------------------------------------------------------------------

    def screen(self, base: Fit, effects: Sequence[str], among: Iterable[str] | None = None) -> list[Score]:
        """Score tests of every effect not yet in the model, by slope at zero and, where that may mislead, by secant."""
        w = self.workshop
        free = [e for e in (among if among is not None else w.catalogue) if e not in effects]
        scores: list[Score] = []
        for group in (w.light, w.heavy, w.demanding):
            here = [e for e in free if e in group]
            if here:
                scores += self._screen_on(w.bench((*effects, *(e for e in here if group is not w.light))), base, here)
        return sorted(scores, key=lambda s: -s.drop)

    def _screen_on(self, bench: Bench, base: Fit, here: list[str]) -> list[Score]:
        w = self.workshop
        names = [n for e in here for n in w.parameters(e)]
        try:
            evidence = bench.evidence(w.campaign.fit, base.everything, [*base.names, *names])
        except SimulationError:
            return []
        S, k = evidence.S, len(base.names)
        off = projector(S[:, :k], prior_of(bench, base.names).slopes)
        found = []
        for effect in here:
            own = w.parameters(effect)
            delta = np.array([self.records[n].smallest_interesting for n in own])
            one_sided = np.array([self.records[n].lower == 0 for n in own])
            slopes = S[:, [k + names.index(n) for n in own]]
            tangent = score(evidence, off, effect, own, slopes, delta, one_sided)
            secant = self._secant(bench, base, evidence, off, effect, own, delta, one_sided)
            found.append(tangent if secant is None or secant.drop < tangent.drop else replace(secant, p=tangent.p))
        return found

    def _secant(self, bench, base, evidence, off, effect, own, delta, one_sided) -> Score | None:
        """The score along what the effect really does at its smallest interesting size."""
        record = self.workshop.catalogue[effect]
        if not (record.even or record.rows or record.needs):
            return None
        columns = []
        for name, size in zip(own, delta, strict=True):
            values = {**base.everything, name: size}
            try:
                there = bench.evidence(self.workshop.campaign.fit, values)
            except SimulationError:
                return None
            columns.append((evidence.r - there.r) / size)
        return score(evidence, off, effect, own, np.stack(columns, axis=1), delta, one_sided)

    # -- refits ---------------------------------------------------------------------------------------------

    def candidate(self, base: Fit, base_held: Evidence, effects: tuple[str, ...], s: Score, tests: int) -> Candidate | None:
        """Refit with one more effect, from the expected change and from sizes of interest."""
        w, effect = self.workshop, s.effect
        bench = w.bench((*effects, effect))
        names = w.parameters(effect)
        try:
            start = self._start(bench, base, s, names)
            found, bench = self.refit((*effects, effect), start, precision=1e-5)
            held = self.heldout(bench, found.everything) if w.campaign.holdout else None
        except SimulationError:
            return None
        return self._judge(base, base_held, found, held, effect, names, tests)

    def _start(self, bench: Bench, base: Fit, s: Score, names: Sequence[str]) -> dict[str, float]:
        """The best of several starts: the expected change, both signs of δ, and larger ones."""
        records = [self.records[n] for n in names]
        delta = np.array([r.smallest_interesting for r in records])
        lower, upper = (np.array([getattr(r, side) for r in records]) for side in ("lower", "upper"))
        expected = np.clip(np.where(np.isfinite(s.estimate), s.estimate, 0), lower, upper)
        tries = [expected]
        record = self.workshop.catalogue[s.effect]
        if record.even or record.rows or record.needs:
            tries += [np.clip(f * delta, lower, upper) for f in (1.0, 3.0, *((-1.0, -3.0) if lower[0] < 0 else ()))]
        if len(tries) == 1:
            return {**base.values, **dict(zip(names, map(float, expected), strict=True))}
        best, best_misfit = expected, np.inf
        prior = prior_of(bench, base.names)
        for t in tries:
            try:
                e = bench.evidence(self.workshop.campaign.fit, {**base.everything, **dict(zip(names, t, strict=True))},
                                   base.names)  # fmt: skip
            except SimulationError:
                continue
            r, S = e.r, e.S
            g = S.T @ r
            expected_misfit = e.misfit - g @ np.linalg.pinv(S.T @ S + prior.slopes**2, hermitian=True) @ g
            if expected_misfit < best_misfit:
                best, best_misfit = t, expected_misfit
        return {**base.values, **dict(zip(names, map(float, best), strict=True))}

    def _judge(self, base, base_held, found, held, effect, names, tests) -> Candidate:
        k = [found.names.index(n) for n in names]
        delta = np.array([self.records[n].smallest_interesting for n in names])
        one_sided = np.array([self.records[n].lower == 0 for n in names])
        estimate = np.array([found.values[n] for n in names])
        covariance = sandwich(found, prior_of(self.workshop.bench((effect,)), found.names).slopes
                              if False else self._prior_slopes(found))[np.ix_(k, k)]  # fmt: skip
        se = np.sqrt(np.maximum(np.diag(covariance), 0))
        scaled, size = covariance / np.outer(delta, delta), estimate / delta
        spread, axes = np.linalg.eigh(scaled)
        seen = spread < 1 / 0.25
        if not seen.any():
            seen = spread == spread.min()
        along = axes[:, seen].T @ size
        T = float(np.sum(along**2 / np.maximum(spread[seen], 1e-12)))
        p = float(stats.chi2.sf(T, int(seen.sum())))
        if len(names) == 1 and one_sided[0]:
            p /= 2
        reach = np.abs(along) + 1.96 * np.sqrt(spread[seen])
        dispersion = float(np.mean(found.evidence.r**2))
        at_bound = bool(np.all((estimate <= 1e-9 * delta) & one_sided))
        before, after = base.evidence.table(), found.evidence.table()
        visible = max(before[run][c] - after[run][c] for run in before for c in before[run])
        gain = held_out_gain(base_held, held) if held is not None else None
        return Candidate(effect, found, (base.misfit - found.misfit) / dispersion, estimate, se, min(1.0, tests * p), visible,
                         gain, held.rms if held is not None else float("nan"), bool(np.all(reach < 1)),
                         not at_bound)  # fmt: skip

    def _prior_slopes(self, found: Fit) -> np.ndarray:
        return prior_of(self.workshop.bench(), self.calibrated).slopes

    # -- search ---------------------------------------------------------------------------------------------

    def round(self, effects: tuple[str, ...], base: Fit, base_held: Evidence, among: Iterable[str] | None = None,
              most: int = SHORTLIST) -> Round:  # fmt: skip
        """Screen, refit the shortlist, and rank."""
        scores = self.screen(base, effects, among)
        short = shortlist(scores, most)
        candidates = []
        for s in short:
            self.say(f"refitting {s.effect}")
            c = self.candidate(base, base_held, effects, s, len(scores))
            if c is not None:
                candidates.append(c)
        candidates.sort(key=lambda c: -c.drop)
        return Round(effects, base, base_held, tuple(scores), tuple(candidates))

    def calibrate(self) -> tuple[Fit, Evidence, Evidence, Evidence]:
        """(calibrated fit, its held-out evidence, nominal fit evidence, nominal held-out evidence)."""
        w = self.workshop
        bench = w.bench()
        start = {n: bench.campaign.known.get(n, next(p.default for p in bench.variant.parameters() if p.name == n))
                 for n in self.calibrated}  # fmt: skip
        nominal = bench.evidence(w.campaign.fit, start, (), tune_start=1)
        nominal_held = bench.evidence(w.campaign.holdout, start, (), tune_start=1)
        found = fit(bench, self.calibrated, start)
        bench.evidence(w.campaign.fit, found.everything, (), tune_start=1)
        found = fit(bench, self.calibrated, found.values)
        held = self.heldout(bench, found.everything)
        w.remember(bench)
        return found, held, nominal, nominal_held


def shortlist(scores: Sequence[Score], most: int) -> list[Score]:
    """The best by expected drop, and whatever looks like the leader."""
    promising = [s for s in scores if s.drop > 0.5]
    first = promising[:most]
    if not first:
        return []
    leader = first[0]
    alike = [s for s in promising[most:] if len(s.signature) == len(leader.signature)
             and abs(float(s.signature @ leader.signature)) > ALIKE]  # fmt: skip
    return [*first, *alike]


def sandwich(found: Fit, prior_slopes: np.ndarray) -> np.ndarray:
    """Covariance (k, k) of the estimates that allows for correlated residuals."""
    S, r = found.evidence.S, found.evidence.r
    A = S.T @ S
    n = len(prior_slopes)
    A[:n, :n] += prior_slopes**2
    inverse = np.linalg.pinv(A, hermitian=True)
    B = robust_variance(found.evidence, S, r)
    B[:n, :n] += prior_slopes**2
    return inverse @ B @ inverse


def held_out_gain(before: Evidence, after: Evidence) -> tuple[float, float, float]:
    """Fall of the mean squared innovation on held-out runs, with a 95 % interval by a moving-block bootstrap."""
    differences, rng = [], np.random.default_rng(0)
    for one, two in zip(before.runs, after.runs, strict=True):
        d = np.nansum(one.r**2 - two.r**2, axis=1)
        length = max(1, round(BLOCK / float(np.median(np.diff(one.run.time)))))
        differences += [d[i : i + length].sum() for i in range(0, len(d), length)]
    blocks = np.array(differences)
    means = blocks[rng.integers(0, len(blocks), (RESAMPLES, len(blocks)))].sum(axis=1)
    low, high = np.quantile(means, (0.025, 0.975))
    return float(blocks.sum()), float(low), float(high)
