"""Effects that a campaign cannot tell apart: as likely within odds of a hundred to one, or as good on what was held out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from .diagnose import Candidate, Round, Search
from .fit import Fit
from .statistics import decisive, difference_blocks, resampled_totals

HALF = 0.5  # of a fall: who reaches it alone may do as much as the leader, or more, beside what is found later
NEARLY = 0.95  # of a fall: who reaches it may be tied by what is held out, and no generic term replaces it


def grouped(effects: Sequence[str], ties: Sequence[Sequence[str]]) -> tuple[tuple[str, ...], ...]:
    """The effects in the order found, each with those it is tied with: groups of one, or of several."""
    return tuple(dict.fromkeys(tuple(next((group for group in ties if e in group), (e,))) for e in effects))


def tied(r: Round) -> tuple[str, ...]:
    """The effect a round found, and every other that this campaign cannot tell from it, however small it would be. Beside what
    was found later likelihoods alone tell, as in `still_tied`."""
    leader = r.winner
    if leader is None:
        return ()
    group, margin = [leader.effect], decisive(leader.fit.evidence)
    for c in r.candidates:
        near = leader.drop - c.drop <= margin
        same = not r.again and c.found and c.drop >= NEARLY * leader.drop and _same_on_heldout(leader, c)
        if c is not leader and c.lawful and (near or same):
            group.append(c.effect)
    return tuple(group)


def still_tied(search: Search, r: Round, effects: Sequence[str], final: Fit) -> tuple[str, ...]:
    """What a round tied, and what came near, less those that fall behind in the place of its effect once all that was found
    later is in too: of a model that leaves much the very best values are not known, nor which of two is ahead."""
    leader = r.winner
    if leader is None or leader.effect not in effects:  # or needed no more
        return ()
    group = tied(r)
    if set(effects) == {*r.effects, leader.effect}:
        return group
    near = (c.effect for c in r.candidates if c.lawful and c.drop >= HALF * leader.drop)
    rivals, margin = {*group, *near}.difference(effects), decisive(final.evidence)
    fits = {c.effect: in_place(search, c, leader.effect, effects, final) for c in r.candidates if c.effect in rivals}
    return (leader.effect, *(e for e, found in fits.items() if found and found.misfit - final.misfit < margin))


def overtaken(search: Search, r: Round, effects: Sequence[str], final: Fit) -> Round | None:
    """A round of search again, beside what was found later, if there another effect that it found explains more by far than the
    one it put in: alone that one had done what others do; or it was small, and helped others on."""
    taken = r.winner or r.help
    if taken is None or taken.effect not in effects or (r.winner and set(effects) == {*r.effects, taken.effect}):
        return None
    rivals = [c for c in r.candidates if c.found and c.effect not in effects and c.drop >= HALF * taken.drop]
    fits = {c.effect: in_place(search, c, taken.effect, effects, final) for c in rivals}
    known = {e: found for e, found in fits.items() if found}
    if all(found.misfit >= final.misfit - decisive(final.evidence) for found in known.values()):
        return None
    again = _beside(search, r, tuple(e for e in effects if e != taken.effect), {taken.effect: final, **known})
    return again if again.winner and again.winner.effect != taken.effect else None


def _beside(search: Search, r: Round, effects: tuple[str, ...], fits: Mapping[str, Fit]) -> Round:
    """A round again, from the model with these `effects`; `fits` are the models with one more."""
    w, candidates = search.workshop, []
    base, held = search.with_given(effects, next(iter(fits.values())))
    for e, found in fits.items():
        there = search.refit((*effects, e), found.values, most=0)  # as it is, with slopes
        there_held = search.heldout(w.bench((*effects, e)), found.values)
        candidates.append(search.judge(base, held, there, there_held, e, w.parameters(e), len(r.scores)))
    return Round(effects, base, held, r.scores, tuple(sorted(candidates, key=lambda c: -c.drop)), again=True)


def in_place(search: Search, rival: Candidate, of: str, effects: Sequence[str], final: Fit) -> Fit | None:
    """The `final` model of these `effects` with a rival in the place of one of them, refitted; None where that cannot run."""
    own = {n: rival.fit.values[n] for n in search.workshop.parameters(rival.effect)}
    swapped = tuple(rival.effect if e == of else e for e in effects)
    return search.remembered(swapped, {**final.values, **own})


def _same_on_heldout(one: Candidate, other: Candidate) -> bool:
    """Do both predict the held-out runs equally well, but for the bootstrap's standard error?"""
    if one.heldout is None or other.heldout is None or not one.heldout.runs:
        return False
    blocks = difference_blocks(one.heldout, other.heldout)
    return abs(float(blocks.sum())) < float(resampled_totals(blocks).std())
