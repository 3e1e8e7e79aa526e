"""The verdict: missing, tie, small, adequate, cannot_see or outside, with the evidence for it."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import chain
from typing import Any, NamedTuple

from threadpoolctl import threadpool_limits

from ...campaign import Campaign, windows
from ...errors import SimulationError
from ...model.stage import Effect
from ...model.variant import Variant
from ..estimation.calibration import Calibrated, calibration, doubts, of_the_body
from ..estimation.statistics import correlation_time
from ..evidence.disturbance import Strength
from ..evidence.limits import beyond
from ..models.factory import CALIBRATED, ModelFactory
from ..models.models import Models, quiet
from ..policy import DEFAULT, USUAL, Effort, SearchPolicy
from ..preflight.slipping import slipped
from ..preflight.timing import clocks, unlike_the_others
from ..residual.lead import lead
from ..residual.staircase import Step
from ..residual.unexplained import Unexplained
from ..search.beginning import Beginning, Clocks, begin, late_by_slopes
from ..search.candidate import Candidate
from ..search.relief import reliefs
from ..search.rounds import Round
from ..search.selection import Selection, selection
from ..search.ties import grouped, probable, tied
from .ahead import Ahead, ahead, which_to_fit
from .among_forces import led, left, needed, staircase
from .decide import Facts, decide, instead_of_small, slight
from .diagnosis import Diagnosis, deciding
from .experiment import Experiment, reveal, separate
from .foretold import on_led_runs, remarks, worse
from .intervals import allowance_of, intervals_of, intervals_of_rivals
from .leftover import leftover, prepare, settled
from .strain import of_another_chair, strained_values
from .unseen import likely_of, powers_of, unsure


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

    def among(now: Selection | Diagnosis, heard: tuple[str, ...]) -> _Among:
        def again(led: Models, before: Strength) -> Diagnosis:
            return _concluded(_to_the_top(_begun(led, {}, stepped), stepped), {}, experiments, heard, stepped, before)

        return _among_forces(now, again, progress)

    models = Models.of(ModelFactory(campaign, variant or Variant(), frozenset(fixed), calibrated), policy, progress, effort)
    search = _begun(models, generic or {}, stepped)
    search = search._replace(found=search.found.to_the_top(policy.unexplained))
    # Whoever searches on here looks for the rest in a model that lacks what is mainly missing: forces are asked for first.
    tried = among(search.found, search.heard) if search.found.ladder[-1].left > policy.unexplained else None
    found = tried.whole if tried else None
    if not found:
        found = _concluded(_to_the_top(search, stepped), generic or {}, experiments, (), stepped)
        found = _with_forces(found, tried, among)
    if found.verdict == "outside" and experiments and not found.to_fit:
        found = replace(found, next_experiment=lead(found.calibration, found.unexplained))
    said = remarks(found.ladder, found.models.setting.noise_model.sd)
    rests = found.resting()
    notes = (*found.notes, *said, *(one.words for one in rests))
    return replace(found, notes=notes, rests_on=rests, seconds=time.monotonic() - began)


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
    """A search among forces that nobody recorded: how strong these are beside the calibrated model, what was `found`, and the
    staircase, if the model at its top foretells more than a calibrated one."""

    before: Strength
    found: Diagnosis | None = None
    ladder: tuple[Step, ...] | None = None

    @property
    def better(self) -> Diagnosis | None:
        """What was found, if its model foretells more than a calibrated one."""
        return replace(self.found, ladder=self.ladder) if self.found and self.ladder else None

    @property
    def whole(self) -> Diagnosis | None:
        """The same where, besides, its model lacks nothing, and what is left to forces is nobody's effect."""
        return self.better if self.better and self.better.verdict != "outside" else None


def _among_forces(
    now: Selection | Diagnosis, again: Callable[[Models, Strength], Diagnosis], say: Callable[[str], None]
) -> _Among:
    """The search made `again` with the force among the noise that the calibrated model lacks."""
    calibrated = now.rounds[0].fit
    before, along = needed(now.models, (), calibrated)
    if not before.fall:
        return _Among(before)
    say("searching again, with forces that nobody recorded")
    try:
        found = again(led(now.models, calibrated, before, along), before)
    except SimulationError:  # forces so strong that they hide all that a model does
        return _Among(before)
    return _Among(before, found, staircase(now.ladder, calibrated.values, found.ladder, found.models))


def _with_forces(found: Diagnosis, tried: _Among | None, among: Callable[[Diagnosis, tuple[str, ...]], _Among]) -> Diagnosis:
    """The diagnosis, with the force that its model lacks. Where much is left that no effect explains, the search `among` such
    forces is what counts: its estimates are not bent by what is left, be it nobody's effect or a law that is not known. But
    a term that does what no effect does says more than forces do, and so does a model that foretells more without them. `tried`
    is what came of that search, where it was made."""
    if found.verdict == "outside" and found.ladder[-1].left >= found.models.policy.a_little:
        tried = tried or among(found, found.heard)
        if best := tried.whole or (None if found.proposal or _outdone(tried, found) else tried.better):
            return best
        if tried.before.fall:
            rest = tried.found.unexplained if tried.found else left(found.models, found.included, found.top, tried.before)
            return replace(found, unexplained=rest)
    before = tried.before if tried else needed(found.models, (), found.rounds[0].fit)[0]
    return replace(found, unexplained=Unexplained(before, needed(found.models, found.included, found.top)[0], ()))


def _outdone(tried: _Among, found: Diagnosis) -> bool:
    """Does the last model of a search among forces foretell held-out runs worse than that of the one without?"""
    if not (among := tried.better):
        return False
    without = on_led_runs(found.ladder[-1], found.top.values, among.models, found.included)
    return worse(without, among.ladder[-1])


def _concluded(
    search: _Search,
    generic: Mapping[str, Effect],
    experiments: Sequence[Experiment],
    heard: tuple[str, ...],
    stepped: Callable[[Sequence[Step]], None],
    before: Strength | None = None,
) -> Diagnosis:
    """The verdict on where a search has ended; `heard` are sentences on columns and clocks that there are already. `before` is
    how strong the forces are that the calibrated model lacks, of a search among them."""
    beginning, found = search
    models, rounds, base = found.models, found.rounds, found.top.fit
    terms, proposal = leftover(found, generic)
    included, ladder = found.effects, found.ladder
    if proposal is not None:
        included, proposal, ladder = settled(found, generic, proposal)
        stepped(ladder)
    beside = {e: r for e, r in found.beside.items() if r} if proposal is None else {}
    decided = {e: deciding(e, included, tuple(beside.values()), rounds) for e in found.added if e in included}
    judged = {e: decided[e] for e in found.named() if e in decided}
    effects = tuple(e for e, r in judged.items() if probable(r, e))  # what others made needless later only helps
    groups = [(group, r) for e, r in beside.items() if e in effects and len(group := tied(r, e)) > 1]
    ties = tuple(group for group, _ in groups)
    values = calibration(models.likelihood(included), proposal.fit if proposal else base)
    bent = strained_values(models, values)
    strained = bent if proposal else of_another_chair(found, bent)
    held = ahead(models, found.top, found.ladder, bool(effects)) if proposal is None else Ahead()
    likely = {} if effects else likely_of(models.factory, decided, rounds[-1])
    rest = left(models, included, base, before) if before else None
    facts = Facts(
        effects=effects,
        ties=ties,
        first=rounds[0],
        ladder=ladder,
        proposed=proposal is not None,
        forced=rest is not None and not rest.nobodys,
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
        facts = replace(facts, powers=powers_of(models, rounds[0]))
        verdict = decide(facts, models.policy)
    if verdict == "outside" and ladder[-1].heldout > ladder[1].heldout:
        effects, ties, groups = (), (), []  # what foretells runs that were held out worse helps nobody
    heard = (*heard, *search.heard)
    allowed, intervals = allowance_of(found), dict[str, tuple[float, float]]()
    if proposal is None:
        intervals = intervals_of(models, included, effects, base, allowed) | intervals_of_rivals(found, groups)
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
        intervals=intervals,
        allowance=allowed,
        models=models,
        retimed=beginning.retimed,
        clocks=search.clocks,
        heard=heard,
        notes=(*_notes(found, heard, verdict, proposal, values, likely), *which_to_fit(ladder, held, models.policy)),
        next_experiment=_next(models, verdict, groups, rounds, experiments),
        unexplained=rest,
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
    doubted = tuple(unsure(e, p) for e, p in likely.items()) if verdict == "cannot_see" else ()
    return (*thinned, *heard, *odd, *models.setting.notes, *doubtful, *beyond_limits, *large, *doubted)


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
