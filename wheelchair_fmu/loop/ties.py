"""Effects that a campaign cannot tell apart: as likely within odds of a hundred to one, or as good on what was held out."""

from __future__ import annotations

from collections.abc import Sequence

from .diagnose import Candidate, Round, Search
from .fit import Fit
from .statistics import decisive, difference_blocks, resampled_totals

HALF = 0.5  # of a fall: who reaches it alone may do as much as the leader, or more, beside what is found later
NEARLY = 0.95  # of a fall: who reaches it may be tied by what is held out, and no generic term replaces it


def grouped(effects: Sequence[str], ties: Sequence[Sequence[str]]) -> tuple[tuple[str, ...], ...]:
    """The effects in the order found, each with those it is tied with: groups of one, or of several."""
    return tuple(dict.fromkeys(tuple(next((group for group in ties if e in group), (e,))) for e in effects))


def tied(r: Round) -> tuple[str, ...]:
    """The effect a round found, and every other that this campaign cannot tell from it, however small it would be."""
    leader = r.winner
    if leader is None:
        return ()
    group, margin = [leader.effect], decisive(leader.fit.evidence)
    for c in r.candidates:
        near = leader.drop - c.drop <= margin
        same = c.found and c.drop >= NEARLY * leader.drop and _same_on_heldout(leader, c)
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


def overtaker(search: Search, r: Round, effects: Sequence[str], final: Fit) -> tuple[str, Candidate, Fit] | None:
    """What a round put in, another effect it found that in its place explains more by far, now that what was found later is in
    too, and the model with that. Alone the one put in had done what others do; or it was small, and helped others on."""
    taken = r.winner or r.help
    if taken is None or taken.effect not in effects or (r.winner and set(effects) == {*r.effects, taken.effect}):
        return None
    rivals = [c for c in r.candidates if c.found and c.effect not in effects and c.drop >= HALF * taken.drop]
    fits = [(c, in_place(search, c, taken.effect, effects, final)) for c in rivals]
    better = [(taken.effect, c, f) for c, f in fits if f and f.misfit < final.misfit - decisive(final.evidence)]
    return min(better, key=lambda found: found[2].misfit, default=None)


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
