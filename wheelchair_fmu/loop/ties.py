"""Effects that a campaign cannot tell apart: as likely within odds of a hundred to one, or as good on what was held out."""

from __future__ import annotations

from collections.abc import Sequence

from ..errors import SimulationError
from .diagnose import Candidate, Round, Search
from .fit import Fit
from .statistics import decisive, difference_blocks, resampled_totals

NEARLY = 0.95  # of a fall: who reaches it may be tied by what is held out or found later, and no generic term replaces it


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
    group = tied(r)
    if not group or group[0] not in effects:  # or needed no more
        return ()
    if set(effects) == {*r.effects, group[0]}:
        return group
    leader = next(c for c in r.candidates if c.effect == group[0])
    near = (c.effect for c in r.candidates if c.lawful and c.drop >= NEARLY * leader.drop)
    rivals = dict.fromkeys((*group, *near))
    candidates, margin = {c.effect: c.fit.values for c in r.candidates}, decisive(final.evidence)

    def keeps_up(rival: str) -> bool:
        own = {n: candidates[rival][n] for n in search.workshop.parameters(rival)}
        swapped = [rival if e == group[0] else e for e in effects]
        try:
            found = search.refit(swapped, {**final.values, **own}, rival=final.misfit)
        except SimulationError:
            return False
        return found.misfit - final.misfit < margin

    return (group[0], *(rival for rival in rivals if rival not in effects and keeps_up(rival)))


def _same_on_heldout(one: Candidate, other: Candidate) -> bool:
    """Do both predict the held-out runs equally well, but for the bootstrap's standard error?"""
    if one.heldout is None or other.heldout is None or not one.heldout.runs:
        return False
    blocks = difference_blocks(one.heldout, other.heldout)
    return abs(float(blocks.sum())) < float(resampled_totals(blocks).std())
