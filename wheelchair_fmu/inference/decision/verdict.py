"""The verdict: missing, tie, small, adequate, cannot_see or outside, with the evidence for it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from ...campaign import Campaign, windows
from ...errors import SimulationError
from ...model.stage import Effect
from ...model.variant import Variant
from ..estimation.calibration import Calibrated, calibration, doubts
from ..estimation.fit import Fit
from ..estimation.interval import half_width, profile_interval
from ..estimation.statistics import correlation_time, estimates
from ..evidence.disturbance import Strength, acting, strength
from ..evidence.evidence import Evidence
from ..evidence.likelihood import MASS
from ..evidence.limits import beyond
from ..evidence.noise_model import NoiseModel
from ..models.factory import CALIBRATED, MEASURED, TOGETHER, ModelFactory
from ..policy import DEFAULT, SearchPolicy
from ..preflight.timing import unlike_the_others
from ..residual.lead import lead
from ..residual.staircase import Step
from ..residual.unexplained import Unexplained, unexplained
from ..search.beginning import retime_by_slopes, settle_clocks
from ..search.candidate import Candidate, ranked
from ..search.probability import beliefs, shared
from ..search.relief import reliefs
from ..search.rounds import Belief, Round
from ..search.screen import AT_THE_FLOOR, PROMISING
from ..search.search import HALFWAY, HOPELESS, Search, at_the_floor
from ..search.selection import StepwiseSelection
from ..search.ties import grouped, tied
from .experiment import Experiment, reveal, separate
from .foretold import on_led_runs, worsened

TERMS = 3  # that are refitted, at most: one is proposed, and nobody asks which others would do as well
FORCES = "unrecorded forces"  # the step of the staircase that has them among the noise


@dataclass(frozen=True)
class Diagnosis:
    """Everything `diagnose` says.

    `included` are the effects of the model in the end, of which the variant came with `already`; `rounds` those of the search,
    `beside` those that judge an effect beside all others, where it does not stand without; `proposal` is the generic term of
    "outside", `calibration` what became of given values, `intervals` are by the profile of the likelihood, or by
    standard errors where forces that nobody recorded lead the runs.
    """

    campaign: str
    verdict: str
    effects: tuple[str, ...]
    included: tuple[str, ...]
    already: tuple[str, ...]
    ties: tuple[tuple[str, ...], ...]
    ladder: tuple[Step, ...]
    rounds: tuple[Round, ...]
    beside: tuple[Round, ...]
    leftover: Round | None
    proposal: Candidate | None
    final: Fit
    calibration: tuple[Calibrated, ...]
    intervals: Mapping[str, tuple[float, float]]
    search: Search
    notes: tuple[str, ...]
    next_experiment: dict[str, Any] | None
    seconds: float = 0.0
    unexplained: Unexplained | None = None

    @property
    def top(self) -> Fit:
        """The fit at the top of the staircase: the proposal's, where there is one."""
        return self.proposal.fit if self.proposal else self.final

    @cached_property
    def beliefs(self) -> dict[str, Belief]:
        """How probable it is that each effect is there, and larger than δ."""
        found = {e: self._decided(e) for e in self.included if e not in self.already}
        return beliefs(found, self.rounds[-1], self._one_sided)

    @property
    def odds(self) -> tuple[dict[str, float], ...]:
        """Of each group of effects that are tied, the probability that it is each of them."""
        return tuple(shared(group, self._decided(group[0])) for group in self.ties)

    @property
    def _one_sided(self) -> dict[str, np.ndarray]:
        """By effect, which of its parameters (k,) may only be positive."""
        w = self.search.factory
        return {e: self.search.one_sided(w.parameters(e)) for e in w.catalogue}

    def _decided(self, effect: str) -> Round:
        """The round that judges an effect of the final model, beside all others of it where there is such a round."""
        again = (r for r in self.beside if {*r.effects, effect} == set(self.included) and effect not in r.effects)
        first = (r for r in reversed(self.rounds) if effect not in r.effects and any(c.effect == effect for c in r.candidates))
        return next(again, None) or next(first)


@threadpool_limits.wrap(limits=1)  # runs are what is shared among the cores; BLAS threads would only wait for one another
def diagnose(
    campaign: Campaign,
    variant: Variant | None = None,
    generic: Mapping[str, Effect] | None = None,
    calibrated: Sequence[str] = CALIBRATED,
    progress: Callable[[str], None] = lambda words: None,
    experiments: Sequence[Experiment] = (),
    fixed: Iterable[str] = (),
    stepped: Callable[[Sequence[Step]], None] = lambda ladder: None,
    policy: SearchPolicy = DEFAULT,
) -> Diagnosis:
    """Find which effects of the catalogue are missing from `variant`, and whether anything else is left.

    The variant's own effects are in the model from the start, and estimated anew. `generic` are the terms of the leftover
    test, `experiments` the runs that could be made next, `fixed` the parameters that nobody estimates. `progress` is told
    what is being done, in words, and `stepped` the staircase whenever it has changed.
    """
    began = time.monotonic()
    campaign = windows(campaign)

    factory = ModelFactory(campaign, variant or Variant(), fixed, calibrated)
    found = _searched(Search(factory, progress, policy), generic or {}, experiments, stepped)
    found = _with_forces(found, lambda search: _searched(search, {}, experiments, stepped), progress)
    if found.verdict == "outside" and experiments:
        found = replace(found, next_experiment=lead(found.calibration, found.unexplained))
    notes = (*found.notes, *worsened(found.ladder))
    return replace(found, notes=notes, seconds=time.monotonic() - began)


def _with_forces(found: Diagnosis, again: Callable[[Search], Diagnosis], say: Callable[[str], None]) -> Diagnosis:
    """The diagnosis, with the force that its model lacks. Where much is left that no effect explains, the search is made again
    with such a force among the noise: if that is no more than a floor does, and nothing orders it, it is nobody's effect."""
    before, along = _acting(found, (), found.rounds[0].fit)
    if found.verdict != "outside" or found.ladder[-1].left < found.search.policy.a_little or not before.fall:
        return replace(found, unexplained=Unexplained(before, _acting(found, found.included, found.top)[0], ()))
    say("searching again, with forces that nobody recorded")
    try:
        second = again(_led(found, before, along))
    except SimulationError:  # forces so strong that they hide all that a model does
        return replace(found, unexplained=_left(found, before))
    left = _left(second, before)
    if left.ordered or not left.like_a_floor:
        return replace(found, unexplained=left)
    nominal, calibrated = found.ladder[:2]
    calibrated = on_led_runs(calibrated, found.rounds[0].fit.values, second.search)
    with_forces = replace(second.ladder[1], name=FORCES)
    return replace(second, ladder=(nominal, calibrated, with_forces, *second.ladder[2:]), unexplained=left)


def _led(found: Diagnosis, forces: Strength, along: Evidence) -> Search:
    """A search of the same campaign, with its columns and clocks as they were found, along such forces, as they lead the
    calibrated model's runs."""
    factory = found.search.factory.led(along, found.rounds[0].fit.values)
    mass = found.search.factory.likelihood().chair(found.rounds[0].fit.values)[MASS]
    factory.noise_model = forces.put_into(NoiseModel(factory.campaign.noise), mass)
    search = Search(factory, found.search.say, found.search.policy)
    search.notes = list(found.search.notes)
    return search


def _left(found: Diagnosis, before: Strength) -> Unexplained:
    """The force that the last model of a search lacks, where it lacked so much `before`, and what orders it."""
    after, evidence = _acting(found, found.included, found.top)
    return unexplained(found.search.factory.likelihood(found.included), found.top, before, after, evidence)


def _acting(found: Diagnosis, effects: Sequence[str], at: Fit) -> tuple[Strength, Evidence]:
    """How strong forces are that a fit with these effects needs, and the evidence for it; the fit's own where it has a generic
    term, which no likelihood of the search knows."""
    likelihood = found.search.factory.likelihood(effects)
    t_r = likelihood.chair(at.values)["chair.t_r"]
    if not set(at.names) <= set(likelihood.records):
        return strength(at.evidence, t_r), at.evidence
    return acting(likelihood, at.values, t_r)


def _searched(
    search: Search, generic: Mapping[str, Effect], experiments: Sequence[Experiment], stepped: Callable[[Sequence[Step]], None]
) -> Diagnosis:
    """The search up the staircase, and the verdict on where it ends."""
    campaign = search.factory.campaign
    selection = StepwiseSelection(search, stepped)
    selection.to_the_top()
    if retime_by_slopes(search, selection.effects, (*selection.named(), *selection.already), selection.base):
        selection = StepwiseSelection(search, stepped)
        selection.to_the_top()
    leftover, proposal = _leftover(selection, generic)
    included, base, ladder, rounds = selection.effects, selection.base, selection.ladder, selection.rounds
    if proposal is not None:
        included, proposal, ladder = _settle(search, generic, included, proposal, ladder)
        stepped(tuple(ladder))
    beside = {e: r for e, r in selection.beside.items() if r} if proposal is None else {}
    effects = tuple(e for e in selection.named() if e in included)
    groups = [(group, r) for e, r in beside.items() if e in effects and len(group := tied(r, e)) > 1]
    ties = tuple(group for group, _ in groups)
    values = calibration(search.factory.likelihood(included), proposal.fit if proposal else base)
    verdict = _verdict(search, effects, ties, rounds, proposal, ladder, base.evidence, values)
    found = dict.fromkeys(chain.from_iterable(grouped(effects, ties)))
    named = found if verdict in ("missing", "tie", "outside") else _slight(rounds[0]) if verdict == "small" else ()
    following = _next(search, verdict, groups, rounds, experiments)
    intervals = _intervals(search, included, effects, base) if proposal is None else {}
    settle_clocks(search, base.evidence, selection.held)
    thinned = (campaign.thinned,) if campaign.thinned else ()
    beyond_limits = beyond(search.factory.likelihood(selection.effects), base.evidence)
    doubtful = (*doubts(values), *(reliefs(rounds[-1], values) if proposal is None else ()))
    odd = unlike_the_others(base.evidence, selection.held)
    large = _instead_of_small(rounds[0]) if verdict == "small" else ()
    notes = (*thinned, *search.notes, *odd, *search.noise_notes, *doubtful, *beyond_limits, *large)
    return Diagnosis(
        campaign.name,
        verdict,
        tuple(named),
        tuple(included),
        selection.already,
        ties,
        tuple(ladder),
        tuple(rounds),
        tuple(beside.values()),
        leftover,
        proposal,
        base,
        tuple(values),
        intervals,
        search,
        notes,
        following,
    )


def _intervals(search: Search, included: Sequence[str], effects: Sequence[str], found: Fit) -> dict[str, tuple[float, float]]:
    """Intervals of the parameters of the effects that were found."""
    likelihood, names = search.factory.likelihood(included), [n for e in effects for n in search.factory.parameters(e)]
    if search.factory.leads:  # no value was found by how likely the readings are
        ends = {n: half_width(found, found.names.index(n)) for n in names if n in found.names}
        return {n: (found.values[n] - end, found.values[n] + end) for n, end in ends.items()}
    return {n: profile_interval(likelihood, found, n) for n in names if n in found.names}


def _next(
    search: Search,
    verdict: str,
    ties: Sequence[tuple[Sequence[str], Round]],
    rounds: Sequence[Round],
    experiments: Sequence[Experiment],
) -> dict[str, Any] | None:
    """What to measure next: to break the first tie, each with the round that tied it, or to see what could not be seen."""
    if not experiments:
        return None
    if verdict == "tie":
        search.say("looking for an experiment that breaks the tie")
        (group, found), *_ = ties
        fits = {c.effect: c.fit for c in found.candidates}
        return separate(search, fits[group[0]], fits[group[1]], (group[0], group[1]), experiments, found.effects)
    if verdict == "cannot_see":
        search.say("looking for an experiment that would show more")
        weak = [s.effect for s in rounds[0].scores if s.power < search.policy.power]
        return reveal(search, rounds[0].fit, weak, experiments)
    return None


def _leftover(selection: StepwiseSelection, generic: Mapping[str, Effect]) -> tuple[Round | None, Candidate | None]:
    """Test the generic terms on what is left; a proposal where one is found that no effect explains."""
    if not generic:
        return None, None
    search, effects, base, held, rounds = selection.search, selection.effects, selection.base, selection.held, selection.rounds
    search.say("looking for what no effect explains")
    terms = Search(search.factory.widened(generic), search.say, search.policy.of_terms)
    first, found = rounds[0], effects[len(rounds[0].effects) :]
    if len(found) > 1 or (found and base.evidence.rms > AT_THE_FLOOR):  # does one term do alone what these were to do?
        promised = max((s.drop for s in first.scores if s.effect in found), default=0.0)  # by slopes, like the terms'
        alone = _terms(terms, generic, first.effects, first.fit, first.heldout, HOPELESS * promised, base.misfit)
        names = [n for e in found for n in search.factory.parameters(e)]
        joint = search.judge(first.fit, first.heldout, base, held, TOGETHER.join(found), names, len(first.scores))
        if alone.winner is not None and _likelier(alone.winner, joint, search.policy, len(first.scores)):
            return alone, alone.winner
    if found and at_the_floor(base.evidence, held):
        scores = (s.score for s in terms.screen(base, effects, list(generic)))
        return Round(effects, base, held, tuple(scores), ()), None  # too little is left to call what was found wrong
    known = [c for r in rounds if r.effects == effects for c in r.every if c.possible]
    left = _terms(terms, generic, effects, base, held, HALFWAY * max((c.drop for c in known), default=0.0))
    best = left.winner
    if best is not None and not all(_likelier(best, c, search.policy, len(first.scores)) for c in known):
        best = None  # an effect of the catalogue does so, be it too small to be named
    return left, best


def _terms(
    search: Search,
    generic: Mapping[str, Effect],
    effects: tuple[str, ...],
    base: Fit,
    held: Evidence,
    least: float,
    rival: float = np.inf,
) -> Round:
    """A round of the generic terms beside these effects."""
    odds, least = search.policy.generic_odds, max(PROMISING, least)
    return search.round(effects, base, held, list(generic), most=TERMS, twin=1.0, least=least, rival=rival, odds=odds)


def _likelier(term: Candidate, other: Candidate, policy: SearchPolicy, effects: int) -> bool:
    """Is a generic term likelier than an effect, or several, of a catalogue of so many, be these large or slight?"""
    prior = policy.log_prior(effects)
    both = {c.effect: c.support for c in ranked([term, other])}
    ours, theirs = both[term.effect], both[other.effect]
    return prior + np.log(policy.generic_odds) + ours.large > max(prior * len(other.members) + theirs.large, theirs.slight)


def _settle(
    search: Search, generic: Mapping[str, Effect], effects: tuple[str, ...], proposal: Candidate, ladder: list[Step]
) -> tuple[tuple[str, ...], Candidate, list[Step]]:
    """The proposal with the effects that still stand beside it; those it replaces leave the staircase."""
    wider = Search(search.factory.widened(generic), search.say, search.policy)
    beside = tuple(e for e in effects if any(n.startswith(f"effect.{e}.") for n in proposal.fit.names))
    whole = (*beside, proposal.effect)
    found, held = wider.settled(whole, proposal.fit)
    every, fewer = wider.pruned(whole, found)
    if every != whole:
        found, held = wider.settled(every, fewer)
    estimate, covariance = estimates(found, wider.factory.parameters(proposal.effect))
    kept = every[:-1]
    steps = [step for step in ladder if not step.name.startswith("+") or step.name[1:] in kept]
    steps.append(Step.of(f"+{proposal.effect}", found.evidence, held))
    settled = replace(proposal, fit=found, heldout=held, estimate=estimate, covariance=covariance)
    return kept, settled, steps


def _verdict(
    search: Search,
    effects: Sequence[str],
    ties: Sequence[Sequence[str]],
    rounds: Sequence[Round],
    proposal: Candidate | None,
    ladder: Sequence[Step],
    left: Evidence,
    values: Sequence[Calibrated],
) -> str:
    # a body that swings with the pushes, and that nobody recorded, answers them as another mass would
    swings = search.factory.noise_model.body > 0
    strained = [v.record.name for v in values if v.beyond and not (swings and v.record.name == MASS)]
    if proposal is not None or ladder[-1].left > search.policy.unexplained or strained:
        return "outside"
    lasting = correlation_time(left) > search.policy.lasting
    if effects and not search.factory.leads and insufficient(ladder, search.policy) and lasting:
        return "outside"
    if effects:
        return "tie" if ties else "missing"
    if lasting and _structured(left, search.policy):
        return "outside"
    if _slight(rounds[0]):
        return "small"
    seen = _seen(search, rounds[0])
    return "adequate" if share_seen(seen, search.factory.catalogue) >= search.policy.library else "cannot_see"


def share_seen(seen: Mapping[str, bool], catalogue: Mapping[str, Effect]) -> float:
    """Share of the causes that would have been seen; of one that has several forms, as large a part as of these."""
    causes: dict[str, list[bool]] = {}
    for effect, would in seen.items():
        cause = next((alike.what for alike in catalogue[effect].alike if alike.one_cause), effect)
        causes.setdefault(cause, []).append(would)
    return float(np.mean([float(np.mean(forms)) for forms in causes.values()] or [0.0]))


def _seen(search: Search, first: Round) -> dict[str, bool]:
    """Which effects would have been seen if they were there, but for what mass and geometry could be instead within what is
    known of them: in that case the model predicts as well without."""
    weak = [s.effect for s in first.scores if s.power < search.policy.power]
    exact = replace(first.fit, names=tuple(n for n in first.fit.names if n not in MEASURED))
    again = search.screen(exact, first.effects, weak) if weak else []
    powers = {s.effect: s.power for s in (*first.scores, *(s.score for s in again))}
    return {effect: power >= search.policy.power for effect, power in powers.items()}


def insufficient(ladder: Sequence[Step], policy: SearchPolicy = DEFAULT) -> bool:
    """Does the model at the top of a staircase leave much, or, on fitted or on held-out runs, more than a little and too large
    a share of what calibration left above the noise?"""
    top, calibrated = ladder[-1], ladder[1]
    sides = ((top.fit, calibrated.fit), (top.heldout, calibrated.heldout))
    rests = (after > policy.a_little and after**2 - 1 > policy.rest * (before**2 - 1) for after, before in sides)
    return top.left > policy.unexplained or any(rests)


def _structured(left: Evidence, policy: SearchPolicy) -> bool:
    """Is there more left than noise accounts for, over all or in one channel of one run?"""
    worst = max((rms for row in left.table().values() for rms in row.values()), default=0.0)
    return left.rms > policy.structured or worst > policy.far_off


def _slight(first: Round) -> tuple[str, ...]:
    """Effects that are surely there and slight, and foretell what was held out better than by chance: the likeliest, and those
    that data cannot tell from it."""
    small = [c for c in first.slight if not c.matters and (c.gain is None or c.gain[1] > 0)]
    return tuple(c.effect for c in small if 2 * (small[0].support.slight - c.support.slight) < first.policy.tied)


def _instead_of_small(first: Round) -> tuple[str, ...]:
    """A sentence for each effect that would be large, and that data cannot tell from those that are slight."""
    likeliest = max((c.support.slight for c in first.slight), default=0.0)
    behind = ((c, likeliest - first.log_prior - c.support.large) for c in first.candidates if c.matters and not c.worsens)
    return tuple(
        f"{c.effect} would do as well, and would not be small: {np.linalg.norm(c.estimate / c.delta):.1f} times what is of "
        f"interest; the odds are {np.exp(log_odds):.0f} to 1 against it"
        for c, log_odds in behind
        if 2 * log_odds < first.policy.tied
    )
