"""The verdict: missing, tie, small, adequate, cannot_see or outside, with the evidence for it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain
from typing import Any, NamedTuple

import numpy as np
from threadpoolctl import threadpool_limits

from ...campaign import Campaign, windows
from ...errors import SimulationError
from ...model.stage import Effect
from ...model.variant import Variant
from ..estimation.calibration import Calibrated, calibration, doubts, of_the_body
from ..estimation.fit import Fit
from ..estimation.interval import interval_by_errors, profile_interval, widened
from ..estimation.score import Score
from ..estimation.statistics import correlation_time
from ..estimation.unnamed import allowance
from ..evidence.disturbance import Strength
from ..evidence.likelihood import MASS
from ..evidence.limits import beyond
from ..models.factory import CALIBRATED, MEASURED, ModelFactory
from ..models.hypothesis import Model
from ..models.models import Models, quiet
from ..policy import DEFAULT, USUAL, Effort, SearchPolicy
from ..preflight.slipping import slipped
from ..preflight.timing import Late, clocks, unlike_the_others
from ..residual.lead import lead
from ..residual.staircase import Step
from ..residual.unexplained import Unexplained
from ..search.beginning import Beginning, Clocks, begin, late_by_slopes
from ..search.candidate import Candidate
from ..search.probability import beliefs, shared
from ..search.relief import reliefs
from ..search.rounds import Belief, Round
from ..search.screen import screen
from ..search.selection import Selection, selection
from ..search.ties import grouped, probable, tied
from .ahead import Ahead, ahead, run_to_fit, which_to_fit
from .among_forces import led, left, needed, staircase
from .decide import Facts, Larger, decide, instead_of_small, slight
from .experiment import Experiment, reveal, separate
from .foretold import remarks
from .leftover import leftover, prepare, settled
from .one_run import Resting, resting


@dataclass(frozen=True)
class Diagnosis:
    """Everything `diagnose` says.

    `included` are the effects of the model in the end, of which the variant came with `already`; `rounds` those of the search,
    `beside` those that judge an effect beside all others, where it does not stand without; `proposal` is the generic term of
    "outside", `calibration` what became of given values, `intervals` are by the profile of the likelihood, or by
    standard errors where forces that nobody recorded lead the runs, and as much wider as effects that nobody named may move an
    estimate, by `allowance`, a standard deviation; of what is tied with an effect, in the model that has it instead. `models`
    are those that were searched, `retimed` and `clocks` what is known of time, and `heard` sentences on columns and clocks.
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
    allowance: Mapping[str, float]
    models: Models
    retimed: Mapping[str, Late]
    clocks: Clocks
    heard: tuple[str, ...]
    notes: tuple[str, ...]
    next_experiment: dict[str, Any] | None
    seconds: float = 0.0
    unexplained: Unexplained | None = None
    seen: float | None = None  # share of the catalogue's causes that would have been seen, where nothing was
    ahead: Ahead = Ahead()
    facts: Facts | None = None  # that the verdict follows from

    @property
    def top(self) -> Fit:
        """The fit at the top of the staircase: the proposal's, where there is one."""
        return self.proposal.fit if self.proposal else self.final

    @cached_property
    def beliefs(self) -> dict[str, Belief]:
        """How probable it is that each effect is there, and larger than δ."""
        found = {e: self._decided(e) for e in self.included if e not in self.already}
        return beliefs(found, self.rounds[-1], _one_sided(self.models.factory))

    @property
    def odds(self) -> tuple[dict[str, float], ...]:
        """Of each group of effects that are tied, the probability that it is each of them."""
        return tuple(shared(group, self._decided(group[0])) for group in self.ties)

    @property
    def to_fit(self) -> str | None:
        """The held-out run to fit as well, where only such runs show an error."""
        return run_to_fit(self.ladder, self.ahead, self.models.policy)

    @property
    def larger(self) -> tuple[Larger, ...]:
        """What would be large instead of what was found to be small, as far as data cannot tell them apart."""
        return instead_of_small(self.rounds[0]) if self.verdict == "small" else ()

    @cached_property
    def rests_on(self) -> tuple[Resting, ...]:
        """What is named for the sake of a single run."""
        if self.verdict not in ("missing", "tie", "outside") or self.proposal:
            return ()
        decided = {e: self._decided(e) for e in self.effects if e in self.included}
        return resting(grouped([*decided], self.ties), decided, self.included, self.models.policy)

    def _decided(self, effect: str) -> Round:
        """The round that judges an effect of the final model, beside all others of it where there is such a round."""
        return _deciding(effect, self.included, self.beside, self.rounds)


def _deciding(effect: str, included: Sequence[str], beside: Sequence[Round], rounds: Sequence[Round]) -> Round:
    """The round that judges an effect of a model, beside all others of it where there is such a round."""
    again = (r for r in beside if {*r.effects, effect} == set(included) and effect not in r.effects)
    first = (r for r in reversed(rounds) if effect not in r.effects and any(c.effect == effect for c in r.candidates))
    return next(again, None) or next(first)


@threadpool_limits.wrap(limits=1)  # runs are what is shared among the cores; BLAS threads would only wait for one another
def diagnose(
    campaign: Campaign,
    variant: Variant | None = None,
    generic: Mapping[str, Effect] | None = None,
    calibrated: Sequence[str] = CALIBRATED,
    progress: Callable[[str], None] = quiet,
    experiments: Sequence[Experiment] = (),
    fixed: Iterable[str] = (),
    stepped: Callable[[Sequence[Step]], None] = lambda ladder: None,
    policy: SearchPolicy = DEFAULT,
    effort: Effort = USUAL,
) -> Diagnosis:
    """Find which effects of the catalogue are missing from `variant`, and whether anything else is left.

    The variant's own effects are in the model from the start, and estimated anew. `generic` are the terms of the leftover
    test, `experiments` the runs that could be made next, `fixed` the parameters that nobody estimates. `progress` is told
    what is being done, in words, and `stepped` the staircase whenever it has changed. Where wheels slipped that roll by the
    variant's law, nothing is looked for.
    """
    began = time.monotonic()
    campaign = windows(campaign)

    def concluded(search: _Search, terms: Mapping[str, Effect], heard: tuple[str, ...] = ()) -> Diagnosis:
        return _concluded(_to_the_top(search, stepped), terms, experiments, heard, stepped)

    def among(now: Selection | Diagnosis, heard: tuple[str, ...]) -> _Among:
        return _among_forces(now, lambda led: concluded(_begun(led, {}, stepped), {}, heard), progress)

    models = Models.of(ModelFactory(campaign, variant or Variant(), frozenset(fixed), calibrated), policy, progress, effort)
    search = _begun(models, generic or {}, stepped)
    search = search._replace(found=search.found.to_the_top(policy.unexplained))
    # Whoever searches on here looks for the rest in a model that lacks what is mainly missing: forces are asked for first.
    tried = among(search.found, search.heard) if search.found.ladder[-1].left > policy.unexplained else None
    found = tried.found if tried and tried.found else _with_forces(concluded(search, generic or {}), tried, among)
    if found.verdict == "outside" and experiments and not found.to_fit:
        found = replace(found, next_experiment=lead(found.calibration, found.unexplained))
    said = remarks(found.ladder, found.models.setting.noise_model.sd)
    notes = (*found.notes, *said, *(one.words for one in found.rests_on))
    return replace(found, notes=notes, seconds=time.monotonic() - began)


class _Search(NamedTuple):
    """Where a search began, and where it has come to."""

    begun: Beginning
    found: Selection

    @property
    def clocks(self) -> Clocks:
        """What is known of time, by run and device."""
        return clocks(self.found.top.fit.evidence, self.found.top.heldout)

    @property
    def heard(self) -> tuple[str, ...]:
        """Sentences on columns and clocks."""
        return self.begun.heard(self.clocks)


class _Among(NamedTuple):
    """A search among forces that nobody recorded: how strong these are beside the calibrated model, what was `found` if that
    counts, and what is `left` to these forces, if such a search was made."""

    before: Strength
    found: Diagnosis | None = None
    left: Unexplained | None = None


def _among_forces(now: Selection | Diagnosis, again: Callable[[Models], Diagnosis], say: Callable[[str], None]) -> _Among:
    """The search made `again` with the force among the noise that the calibrated model lacks: if that is no more than a floor
    does, and nothing orders it, it is nobody's effect."""
    calibrated = now.rounds[0].fit
    before, along = needed(now.models, (), calibrated)
    if not before.fall:
        return _Among(before)
    say("searching again, with forces that nobody recorded")
    try:
        second = again(led(now.models, calibrated, before, along))
    except SimulationError:  # forces so strong that they hide all that a model does
        return _Among(before)
    rest = left(second.models, second.included, second.top, before)
    ladder = (
        None
        if rest.ordered or not rest.like_a_floor
        else staircase(now.ladder, calibrated.values, second.ladder, second.models)
    )
    return _Among(before, replace(second, ladder=ladder, unexplained=rest) if ladder else None, rest)


def _with_forces(found: Diagnosis, tried: _Among | None, among: Callable[[Diagnosis, tuple[str, ...]], _Among]) -> Diagnosis:
    """The diagnosis, with the force that its model lacks. Where much is left that no effect explains, the search `among` such
    forces is what counts, if it does; `tried` is what came of it, where it was made."""
    if found.verdict == "outside" and found.ladder[-1].left >= found.models.policy.a_little:
        tried = tried or among(found, found.heard)
        if tried.found:
            return tried.found
        if tried.before.fall:
            rest = tried.left or left(found.models, found.included, found.top, tried.before)
            return replace(found, unexplained=rest)
    before = tried.before if tried else needed(found.models, (), found.rounds[0].fit)[0]
    return replace(found, unexplained=Unexplained(before, needed(found.models, found.included, found.top)[0], ()))


def _concluded(
    search: _Search,
    generic: Mapping[str, Effect],
    experiments: Sequence[Experiment],
    heard: tuple[str, ...],
    stepped: Callable[[Sequence[Step]], None],
) -> Diagnosis:
    """The verdict on where a search has ended; `heard` are sentences on columns and clocks that there are already."""
    beginning, found = search
    models, rounds, base = found.models, found.rounds, found.top.fit
    terms, proposal = leftover(found, generic)
    included, ladder = found.effects, found.ladder
    if proposal is not None:
        included, proposal, ladder = settled(found, generic, proposal)
        stepped(ladder)
    beside = {e: r for e, r in found.beside.items() if r} if proposal is None else {}
    decided = {e: _deciding(e, included, tuple(beside.values()), rounds) for e in found.added if e in included}
    judged = {e: decided[e] for e in found.named() if e in decided}
    effects = tuple(e for e, r in judged.items() if probable(r, e))  # what others made needless later only helps
    groups = [(group, r) for e, r in beside.items() if e in effects and len(group := tied(r, e)) > 1]
    ties = tuple(group for group, _ in groups)
    values = calibration(models.likelihood(included), proposal.fit if proposal else base)
    strained = _strained(models, values) if proposal else _of_another_chair(found, _strained(models, values))
    held = ahead(models, found.top, found.ladder, bool(effects)) if proposal is None else Ahead()
    likely = {} if effects else _likely(models.factory, decided, rounds[-1])
    facts = Facts(
        effects=effects,
        ties=ties,
        first=rounds[0],
        ladder=ladder,
        proposed=proposal is not None,
        # Where forces lead the runs, what lasts is theirs: whether anything is behind it is asked of them (see `Unexplained`).
        lasts=0.0 if models.factory.leads else correlation_time(base.evidence),
        rms=base.evidence.rms,
        worst=base.evidence.worst[0],
        ahead=held,
        strained=tuple(strained),
        likely=likely,
        powers={},
        causes={e: record.cause for e, record in models.factory.catalogue.items()},
    )
    verdict = decide(facts, models.policy)
    if verdict == "cannot_see":  # or adequate, if enough would have been seen, which nobody needs to know before
        facts = replace(facts, powers=_powers(models, rounds[0]))
        verdict = decide(facts, models.policy)
    if verdict == "outside" and ladder[-1].heldout > ladder[1].heldout:
        effects, ties, groups = (), (), []  # what foretells runs that were held out worse helps nobody
    heard = (*heard, *search.heard)
    allowed = _allowance(found)
    return Diagnosis(
        campaign=models.campaign.name,
        verdict=verdict,
        effects=_named(verdict, effects, ties, rounds[0]),
        included=included,
        already=found.already,
        ties=ties,
        ladder=ladder,
        rounds=rounds,
        beside=tuple(beside.values()),
        leftover=terms,
        proposal=proposal,
        final=base,
        calibration=tuple(values),
        intervals=_intervals(models, included, effects, base, allowed) | _of_rivals(found, groups) if proposal is None else {},
        allowance=allowed,
        models=models,
        retimed=beginning.retimed,
        clocks=search.clocks,
        heard=heard,
        notes=(*_notes(found, heard, verdict, proposal, values, likely), *which_to_fit(ladder, held, models.policy)),
        next_experiment=_next(models, verdict, groups, rounds, experiments),
        seen=facts.seen(models.policy) if verdict in ("adequate", "cannot_see") else None,
        ahead=held,
        facts=facts,
    )


def _named(verdict: str, effects: Sequence[str], ties: Sequence[Sequence[str]], first: Round) -> tuple[str, ...]:
    """The effects that a verdict is on."""
    if verdict in ("missing", "tie", "outside"):
        return tuple(dict.fromkeys(chain.from_iterable(grouped(effects, ties))))
    return slight(first) if verdict == "small" else ()


def _begun(models: Models, generic: Mapping[str, Effect], stepped: Callable[[Sequence[Step]], None]) -> _Search:
    """A search at the foot of the staircase; what asks for generic terms is compiled beside it."""
    first = _where_wheels_roll(begin(models))
    prepare(first.models, generic)
    return _Search(first, selection(first, stepped))


def _to_the_top(search: _Search, stepped: Callable[[Sequence[Step]], None]) -> _Search:
    """A search that has ended; once again where its last model shows that pushes are a little early or late."""
    first, found = search.begun, search.found.to_the_top()
    named = (*found.named(), *found.already)
    late = late_by_slopes(found.models, found.effects, named, found.top.fit)
    if not late:
        return _Search(first, found)
    again = begin(replace(found.models, factory=found.models.factory.retimed(late)))
    notes = tuple(dict.fromkeys((*first.notes, *again.notes)))
    again = replace(again, notes=notes, retimed={**first.retimed, **late, **again.retimed})
    return _Search(again, selection(again, stepped).to_the_top())


def _where_wheels_roll(first: Beginning) -> Beginning:
    """The same with nothing to look for where wheels slipped that roll by law: a search would find effects that seem to make up
    for it, one after another. Where forces lead the runs, that was asked before."""
    models = first.models
    said = () if models.factory.leads else slipped(models.campaign, models.factory.variant)
    if not said:
        return first
    return replace(first, models=replace(models, factory=models.factory.narrowed()), notes=(*first.notes, *said))


def _notes(
    found: Selection,
    heard: Sequence[str],
    verdict: str,
    proposal: Candidate | None,
    values: Sequence[Calibrated],
    likely: Mapping[str, float],
) -> tuple[str, ...]:
    """Sentences on recordings, on noise, and on what a model came out at that nobody should believe."""
    models, top, rounds = found.models, found.top, found.rounds
    thinned = (models.campaign.thinned,) if models.campaign.thinned else ()
    odd = unlike_the_others(top.fit.evidence, top.heldout)
    doubtful = (*doubts(values), *of_the_body(values), *(reliefs(rounds[-1], values) if proposal is None else ()))
    beyond_limits = beyond(models.likelihood(found.effects), top.fit.evidence)
    large = tuple(other.words for other in instead_of_small(rounds[0])) if verdict == "small" else ()
    unsure = tuple(_unsure(e, p) for e, p in likely.items()) if verdict == "cannot_see" else ()
    return (*thinned, *heard, *odd, *models.setting.notes, *doubtful, *beyond_limits, *large, *unsure)


def _likely(w: ModelFactory, decided: Mapping[str, Round], last: Round) -> dict[str, float]:
    """The probability of effects that are more probably of a size of interest than not, though none is sure enough to be named:
    of those that only help the model, by the round that decided on each, and of others beside it."""
    return {e: b.large for e, b in beliefs(decided, last, _one_sided(w)).items() if b.large > 0.5}


def _one_sided(w: ModelFactory) -> dict[str, np.ndarray]:
    """By effect, which of its parameters (k,) may only be positive."""
    return {e: w.one_sided(w.parameters(e)) for e in w.catalogue}


def _unsure(effect: str, probability: float) -> str:
    return (
        f"{effect} is probably missing, with a size of interest ({probability:.2f}), but not surely enough to be named; "
        "further runs would tell"
    )


def _allowance(found: Selection) -> dict[str, float]:
    """By how much (a standard deviation, by name) the estimates of the last model may be off by causes that nobody named. Those
    that a nuisance of the campaign stands for are allowed for by it. A model with as many effects as are put in was not
    searched for more, so that it is screened for this."""
    last = next((r for r in reversed(found.rounds) if r.effects == found.effects), None)
    return _allowed(found.models, found.top, last.scores if last else [s.score for s in screen(found.models, found.top)])


def _allowed(models: Models, model: Model, scores: Sequence[Score]) -> dict[str, float]:
    """The same of any model, with the scores of what it lacks."""
    causes = {e: record.cause for e, record in models.factory.catalogue.items()}
    named = {causes[e] for e in model.effects}
    others = [s for s in scores if causes[s.effect] not in named and s.effect not in models.doubles]
    names = model.fit.names
    covariance = allowance(others, causes, len(names), models.policy)
    return dict(zip(names, map(float, np.sqrt(np.diag(covariance))), strict=True))


def _intervals(
    models: Models, included: Sequence[str], effects: Sequence[str], found: Fit, allowed: Mapping[str, float]
) -> dict[str, tuple[float, float]]:
    """Intervals of the parameters of the effects that were found."""
    likelihood, names = models.likelihood(included), [n for e in effects for n in models.factory.parameters(e)]

    def interval(name: str) -> tuple[float, float]:
        more, record = allowed.get(name, 0.0), likelihood.records[name]
        if models.factory.leads:  # no value was found by how likely the readings are
            return interval_by_errors(found, found.names.index(name), more, record)
        return widened(profile_interval(likelihood, found, name), found.values[name], more, record)

    return {n: interval(n) for n in names if n in found.names}


def _of_rivals(found: Selection, ties: Sequence[tuple[Sequence[str], Round]]) -> dict[str, tuple[float, float]]:
    """Intervals of what is tied with an effect of the last model, each in the model that has it instead."""
    models, intervals = found.models, dict[str, tuple[float, float]]()
    for group, r in ties:
        fits = {c.effect: c.fit for c in r.candidates}
        for rival in (e for e in group if e not in found.effects):
            model = models.model((*r.effects, rival), fits[rival].values)
            allowed = _allowed(models, model, [s.score for s in screen(models, model)])
            intervals |= _intervals(models, model.effects, (rival,), model.fit, allowed)
    return intervals


def _next(
    models: Models,
    verdict: str,
    ties: Sequence[tuple[Sequence[str], Round]],
    rounds: Sequence[Round],
    experiments: Sequence[Experiment],
) -> dict[str, Any] | None:
    """What to measure next: to break the first tie, each with the round that tied it, or to see what could not be seen."""
    if not experiments:
        return None
    if verdict == "tie":
        models.say("looking for an experiment that breaks the tie")
        (group, found), *_ = ties
        fits = {c.effect: c.fit for c in found.candidates}
        return separate(models, fits[group[0]], fits[group[1]], (group[0], group[1]), experiments, found.effects)
    if verdict == "cannot_see":
        models.say("looking for an experiment that would show more")
        weak = [s.effect for s in rounds[0].scores if s.power < models.policy.power]
        return reveal(models, rounds[0].fit, weak, experiments)
    return None


def _strained(models: Models, values: Sequence[Calibrated]) -> list[str]:
    """Calibrated values that a fit has bent as far as it may. A body that swings with the pushes, and that nobody recorded,
    answers them as another mass would."""
    swings = models.setting.noise_model.body > 0
    return [v.record.name for v in values if v.beyond and not (swings and v.record.name == MASS)]


def _of_another_chair(found: Selection, strained: Sequence[str]) -> Sequence[str]:
    """Those of such values that the data insist on: no law is exact, and with effects that explain much, what held at its prior
    would cost no more than their laws may get wrong proves nothing of the chair."""
    models, fit = found.models, found.top.fit
    allowed = models.policy.inexact**2 * (found.calibrated - fit.deviance)
    if not strained or allowed <= 0 or models.factory.leads:
        return strained
    held = models.refit(found.effects, fit.values, without=frozenset(strained))
    return strained if held.deviance - fit.deviance > allowed else ()


def _powers(models: Models, first: Round) -> dict[str, float]:
    """With which power each effect would have been seen if it were there, but for what mass and geometry could be instead
    within what is known of them: in that case the model predicts as well without."""
    weak = [s.effect for s in first.scores if s.power < models.policy.power]
    exact = replace(first.fit, names=tuple(n for n in first.fit.names if n not in MEASURED))
    again = screen(models, replace(first.model, fit=exact), weak) if weak else []
    return {s.effect: s.power for s in (*first.scores, *(s.score for s in again))}
