"""Effects that a campaign cannot tell apart: as likely within odds of a hundred to one, or such as no run that was held out
tells apart; and the search again, beside all others that were found, that tells."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...errors import SimulationError
from ..estimation.statistics import difference_blocks
from ..models.hypothesis import Model
from ..models.models import Models
from .candidate import Candidate, ranked
from .judge import judge
from .refitting import candidate
from .rounds import Round
from .screen import screen, shortlist

NEARLY = 0.95  # of a fall: who reaches it may be tied by what is held out, and no generic term replaces it
CHANCE = 4.0  # sum of squares D by which readings of two models differ: above, the mean of −2 log odds between them, D, is
# larger than their standard deviation, 2 √D


def grouped(effects: Sequence[str], ties: Sequence[Sequence[str]]) -> tuple[tuple[str, ...], ...]:
    """The effects in the order found, each with those it is tied with: groups of one, or of several."""
    return tuple(dict.fromkeys(tuple(next((group for group in ties if e in group), (e,))) for e in effects))


def tied(r: Round, effect: str) -> tuple[str, ...]:
    """An effect that a round found, and every other that this campaign cannot tell from it, however small it would be. What
    predicts held-out runs better is so much likelier, if it was found. In a search again, beside all that was found,
    fitted runs alone tell; but what is more probable than the effect itself, by all runs, is never told from it, nor the most
    probable others that have to be named for it to be likelier than not that one of all these is there."""
    leader = _of(r, effect)
    group = [leader.effect]
    for c in r.candidates:
        if c is leader or not c.lawful:
            continue
        ahead = 0.0 if r.again else _ahead_on_heldout(c, leader)
        behind = _behind(c, leader)
        near = behind <= r.policy.tied or (behind - ahead / leader.scale <= r.policy.tied and c.matters)
        same = not r.again and _unchecked(c, leader) and c.matters and c.likelihood_ratio >= NEARLY * leader.likelihood_ratio
        likelier = c.matters and r.beliefs[c.effect].there > r.beliefs[effect].there
        if near or same or likelier:
            group.append(c.effect)
    return (*group, *_needed_beside(r, group))


def _needed_beside(r: Round, group: Sequence[str]) -> list[str]:
    """The others, the most probable first, that make it likelier than not that one of them or of a `group` is there; none where
    all together do not."""
    others = [c.effect for c in r.candidates if c.lawful and c.matters and c.effect not in group]
    if not others:
        return []
    others.sort(key=lambda e: -r.beliefs[e].there)
    sums = sum(r.beliefs[e].there for e in group) + np.cumsum([0.0, *(r.beliefs[e].there for e in others)])
    enough = np.flatnonzero(sums > 0.5)
    return others[: enough[0]] if len(enough) else []


def probable(r: Round, effect: str) -> bool:
    """Is an effect, or one that this campaign cannot tell from it, likelier to be there than not, by a round that judges it?"""
    return sum(r.beliefs[e].there for e in tied(r, effect)) > 0.5


def beside(models: Models, effect: str, final: Model, before: Round | None, calibrated: float = 0.0) -> Round | None:
    """One effect of a `final` model searched for again, beside all the others. `before` is the round that found it, if that
    knew the same noise, `calibrated` the deviance of the model without any effect. None where it stands without that, or where
    the model cannot run without it."""
    others = tuple(e for e in final.effects if e != effect)
    try:
        base = models.model(others, final.fit.values)  # runs start where the final model wants them, for rivals as well
    except SimulationError:
        return None
    started = models.likelihood(others).restarted(base.fit.evidence, base.fit.values)
    base = replace(base, fit=replace(base.fit, evidence=started))
    without = models.rival_of(effect, base)
    as_known = replace(final, fit=models.compared(final.fit, effect, without.fit))
    fall = without.fit.deviance - as_known.fit.deviance
    if before and _stands(effect, final.effects, fall, before, models.effort.halfway):
        return None
    screened = screen(models, base)
    own = judge(models, without, as_known, effect, models.factory.parameters(effect), len(screened))
    promising = shortlist(models, [s for s in screened if s.score.effect != effect])
    tried = (candidate(models, base, s, len(screened), least=models.effort.halfway * fall) for s in promising)
    candidates = tuple(ranked([own, *(c for c in tried if c)]))
    bare, held, scores = (
        replace(base.fit, evidence=base.fit.evidence.summary()),
        base.heldout.summary(),
        [s.score for s in screened],
    )
    explained = calibrated - base.fit.deviance
    return Round(others, bare, held, tuple(scores), candidates, again=True, explained=explained, policy=models.policy)


def _stands(effect: str, effects: Sequence[str], fall: float, before: Round, halfway: float) -> bool:
    """Did no other come near an effect in the round that found it, and does it still do most of what it did then? If not, it
    may have done what others do that were found later, and one that does the rest may not have shown."""
    then = _of(before, effect)
    near = {c.effect for c in before.candidates if c.lawful and c.likelihood_ratio >= halfway * then.likelihood_ratio}
    most = fall >= halfway * (before.fit.deviance - then.fit.deviance)
    return most and then.matters and near.union(tied(before, effect)) <= set(effects)


def _of(r: Round, effect: str) -> Candidate:
    return next(c for c in r.candidates if c.effect == effect)


def overtaker(r: Round, effect: str) -> Candidate | None:
    """What a search again for one effect of a model found, if it is another, with which that explains more by far."""
    ahead = r.winner
    another = r.again and ahead is not None and ahead.effect != effect
    return ahead if another and ahead and _behind(_of(r, effect), ahead) > r.policy.tied else None


def _behind(one: Candidate, other: Candidate) -> float:
    """How much less likely one is than another by fitted runs, whatever their sizes, in −2 log likelihood."""
    return 2 * (other.support.fitted - one.support.fitted)


def _unchecked(one: Candidate, other: Candidate) -> bool:
    """Were runs held out, on which two models differ by less than chance moves their odds? This asks the models alone: which of
    them came out ahead is chance's doing then."""
    runs = [*zip(one.heldout.runs, other.heldout.runs, strict=True)] if one.heldout and other.heldout else []
    return bool(runs) and sum(float(np.nansum((a.r - b.r) ** 2)) for a, b in runs) <= CHANCE * other.scale


def _ahead_on_heldout(one: Candidate, other: Candidate) -> float:
    """By how much one predicts the held-out runs better than the other, in −2 log likelihood; 0 where none were held out."""
    return float(difference_blocks(other.heldout, one.heldout).sum()) if one.heldout and other.heldout else 0.0
