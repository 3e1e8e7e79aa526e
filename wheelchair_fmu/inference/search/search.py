"""One round of the search: screen the catalogue, refit what is promising, and judge."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from ..estimation.marginal import of_score
from ..evidence.evidence import Evidence
from ..models.hypothesis import Model
from ..models.models import Models
from ..policy import Effort, SearchPolicy
from .candidate import Candidate, ranked
from .refitting import candidate
from .rounds import Round
from .screen import Screened, screen, screen_groups, shortlist


def searched(
    models: Models,
    base: Model,
    among: Iterable[str] | None = None,
    rival: float = math.inf,
    least: float = 0.0,
    odds: float = 1.0,
    explained: float = 0.0,
) -> Round:
    """Screen, refit the shortlist, and rank. What lowers −2 log likelihood by less than `least`, as far as slopes tell, is not
    refitted; what looks like the leader is, however many there are; and groups of effects, where the whole catalogue is asked.
    `rival` is the deviance of another model to be compared with; for `odds` and `explained` see `Round`."""
    screened, joined = screen_groups(models, base) if among is None else (screen(models, base, among), [])
    candidates: list[Candidate] = []
    least = max(least, models.promising)
    leader, hope, tests = math.inf, least, len(screened) + len(joined)
    likely = [s for s in screened if _hopeful(models, s, len(screened), odds)]
    for s in (*shortlist(models, likely), *joined):
        c = candidate(models, base, s, tests, min(leader, rival), hope)
        if c is None:
            continue
        candidates.append(c)
        if c.fit.deviance < leader:
            leader = c.fit.deviance
            hope = max(least, _hope(models.effort, base.fit.deviance - leader, s.score.likelihood_ratio))
    best = ranked(candidates)
    alone, groups = (tuple(c for c in best if (len(c.members) > 1) == several) for several in (False, True))
    scores = tuple(s.score for s in screened)
    return Round(
        base.effects, base.fit, base.heldout, scores, alone, groups=groups, odds=odds, explained=explained, policy=models.policy
    )


def _hopeful(models: Models, s: Screened, effects: int, odds: float) -> bool:
    """May a refit find that an effect is there, large or slight, as far as slopes tell, which is nearly all of it where it is
    linear and the model about right, or where forces make up for the rest?"""
    far = float(np.mean(s.evidence.r**2)) > models.effort.far
    if not models.factory.leads and (far or not s.linear):
        return True
    told = of_score(s.score, models.factory.one_sided(s.score.names), models.policy)
    prior = models.policy.log_prior(effects) + float(np.log(odds))
    return prior + max(told.large, told.slight) > -0.25 * models.policy.tied


def _hope(effort: Effort, fall: float, promised: float) -> float:
    """What another effect must promise beside one that did `fall`, and `promised` so much, to be refitted."""
    least = effort.hopeless * fall
    return min(least, effort.halfway * promised) if effort.beyond * promised > fall else least


def at_the_floor(fitted: Evidence, held: Evidence | None, policy: SearchPolicy) -> bool:
    """Does a model leave nothing to explain, on fitted and on held-out runs?"""
    return fitted.rms < policy.nothing_left and (held is None or not held.runs or held.rms < policy.nothing_left)
