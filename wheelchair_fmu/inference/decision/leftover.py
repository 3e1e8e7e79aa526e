"""What no effect of the catalogue explains: generic terms tried on what is left, and one of them proposed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ...model.stage import Effect
from ..estimation.statistics import estimates
from ..models.factory import TOGETHER
from ..models.hypothesis import Model
from ..models.models import Models
from ..parallel import meanwhile
from ..policy import SearchPolicy
from ..residual.staircase import Step
from ..search.candidate import Candidate, ranked
from ..search.judge import judge
from ..search.pruning import pruned
from ..search.rounds import Round
from ..search.screen import screen
from ..search.search import at_the_floor, searched
from ..search.selection import Selection


def prepare(models: Models, generic: Mapping[str, Effect]) -> None:
    """Have the model compiled, beside other work, that `leftover` asks for unless an effect with states is found."""
    if terms := _terms_of(models, generic):
        meanwhile(lambda: terms.wide().sensitivities.library)


def leftover(found: Selection, generic: Mapping[str, Effect]) -> tuple[Round | None, Candidate | None]:
    """Test the generic terms on what is left; a proposal where one is found that no effect explains."""
    terms = _terms_of(found.models, generic)
    if terms is None:
        return None, None
    models, top, base, rounds = found.models, found.top, found.top.fit, found.rounds
    models.say("looking for what no effect explains")
    first, later = rounds[0], found.effects[len(rounds[0].effects) :]
    several = len(later) > 1 or (later and base.evidence.rms > models.policy.nothing_left)
    if several:  # does one term do alone what these were to do?
        by_slopes = {s.effect: s.likelihood_ratio for s in first.scores}  # as the terms' falls are
        promised = max((by_slopes.get(e, 0.0) for e in later), default=0.0)
        alone = _terms(terms, generic, first.model, models.effort.hopeless * promised, base.deviance)
        names = [n for e in later for n in models.factory.parameters(e)]
        joint = judge(models, first.model, top, TOGETHER.join(later), names, len(first.scores))
        if alone.winner is not None and _likelier(alone.winner, joint, models.policy, len(first.scores)):
            return alone, alone.winner
    if later and at_the_floor(base.evidence, top.heldout, models.policy):
        scores = (s.score for s in screen(terms, top, list(generic)))
        return Round(top.effects, base, top.heldout, tuple(scores), ()), None  # too little is left to call what was found wrong
    known = [c for r in rounds if r.effects == top.effects for c in r.every if c.possible]
    left = _terms(terms, generic, top, models.effort.halfway * max((c.likelihood_ratio for c in known), default=0.0))
    best = left.winner
    if best is not None and not all(_likelier(best, c, models.policy, len(first.scores)) for c in known):
        best = None  # an effect of the catalogue does so, be it too small to be named
    return left, best


def _terms_of(models: Models, generic: Mapping[str, Effect]) -> Models | None:
    """The models with generic terms too; None where nothing is looked for."""
    looked_for = models.factory.catalogue.keys() - models.factory.own
    return models.widened(generic, models.policy.of_terms) if generic and looked_for else None


def _terms(terms: Models, generic: Mapping[str, Effect], base: Model, least: float, rival: float = np.inf) -> Round:
    """A round of the generic terms beside a model's effects."""
    few = replace(terms, effort=replace(terms.effort, shortlist=terms.effort.terms, alike=1.0))
    return searched(few, base, list(generic), least=least, rival=rival, odds=terms.policy.generic_odds)


def _likelier(term: Candidate, other: Candidate, policy: SearchPolicy, effects: int) -> bool:
    """Is a generic term likelier than an effect, or several, of a catalogue of so many, be these large or slight?"""
    prior = policy.log_prior(effects)
    both = {c.effect: c.support for c in ranked([term, other])}
    ours, theirs = both[term.effect], both[other.effect]
    return prior + np.log(policy.generic_odds) + ours.large > max(prior * len(other.members) + theirs.large, theirs.slight)


def settled(
    found: Selection, generic: Mapping[str, Effect], proposal: Candidate
) -> tuple[tuple[str, ...], Candidate, tuple[Step, ...]]:
    """The effects that still stand beside a proposal, this with all values anew, and the staircase; effects that it replaces
    leave that."""
    beside = tuple(e for e in found.effects if any(n.startswith(f"effect.{e}.") for n in proposal.fit.names))
    models, top = found.models.widened(generic).settled((*beside, proposal.effect), proposal.fit)
    every, fewer = pruned(models, top.effects, top.fit)
    if every != top.effects:
        models, top = models.settled(every, fewer)
    estimate, covariance = estimates(top.fit, models.factory.parameters(proposal.effect))
    kept = every[:-1]
    steps = tuple(step for step in found.ladder if not step.name.startswith("+") or step.name[1:] in kept)
    last = Step.of(f"+{proposal.effect}", top.fit.evidence, top.heldout, top.fit.values)
    usual = estimate - proposal.without, covariance, proposal.usual[2]  # no term has constants
    now = replace(proposal, fit=top.fit, heldout=top.heldout, estimate=estimate, covariance=covariance, usual=usual)
    return kept, now, (*steps, last)
