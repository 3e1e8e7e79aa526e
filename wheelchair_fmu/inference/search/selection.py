"""Up the staircase: effect after effect goes into the model, and what it makes needless leaves, until nothing more is found."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from ...errors import SimulationError
from ..estimation.calibration import calibration
from ..estimation.problem import Fit
from ..evidence.initial_state import TUNING
from ..models.hypothesis import Model
from ..models.models import Models
from ..residual.staircase import Step
from .beginning import LED, Beginning, first_steps
from .candidate import Candidate
from .joint import parted, together
from .judge import surely_large
from .pruning import pruned
from .refitting import risen
from .rounds import Round
from .search import searched
from .ties import beside, overtaker


@dataclass(frozen=True)
class Selection:
    """A search on its way up: the `models` that it may ask for, the one at the `top`, the staircase `ladder` that led there,
    the `rounds` of search, and for an effect that was found the one that judges it `beside` all others.

    `already` are the effects that the chair came with; of others `helping` are in though they may be too small to be named, and
    `parts` as members of a group. `calibrated` is the deviance without any effect; so many rounds, `noisier`, were searched
    with other noise than is known now. `stepped` is told the staircase whenever it has changed. A search that has `ended` finds
    no more.
    """

    models: Models
    top: Model
    ladder: tuple[Step, ...]
    calibrated: float
    stepped: Callable[[Sequence[Step]], None]
    rounds: tuple[Round, ...] = ()
    beside: Mapping[str, Round | None] = field(default_factory=dict)
    already: tuple[str, ...] = ()
    helping: frozenset[str] = frozenset()
    parts: frozenset[str] = frozenset()
    tried_together: bool = False
    noisier: int = 0
    ended: bool = False

    @property
    def effects(self) -> tuple[str, ...]:
        """Those of the model at the top."""
        return self.top.effects

    @property
    def added(self) -> tuple[str, ...]:
        """Those of them that the chair came without."""
        return self.effects[len(self.already) :]

    def to_the_top(self, far: float = math.inf) -> Selection:
        """Search, put in what was found, leave out what that makes needless, and let others take the place of what they
        overtake, as long as anything is found; or until a step does little where an error of `far` and more is left."""
        now = self
        for _ in range(self.models.effort.most_steps):
            if now.ended:
                return now
            below, now = now, now._one_step()
            if now.ladder[-1].left > far and now._did_little(below):
                return now
        return replace(now, beside={effect: now._beside(effect) for effect in now.added}, ended=True)

    def _did_little(self, below: Selection) -> bool:
        """Is most left of what there was a step `below`? What explains less is not what is mainly missing."""
        before = self.ladder[min(len(below.ladder), len(self.ladder) - 1) - 1]  # by the noise that is known now
        return not self.ended and self.ladder[-1].left ** 2 - 1 > self.models.effort.most_left * (before.left**2 - 1)

    def _one_step(self) -> Selection:
        """The same until the model at the top is another one; or `ended`, where nothing is found."""
        now, best = self._found() if len({*self.added} - self.helping) < self.models.effort.most_effects else (self, None)
        higher = now._with(best) if best else None
        if higher is not None:
            return higher
        now, overtaken = replace(now, ladder=self.ladder, helping=self.helping)._looked_beside()
        return replace(now, ended=not overtaken)

    def named(self) -> tuple[str, ...]:
        """The effects that were found, without those that only help: what is likelier slight, be it of a group, unless all of
        the group are."""
        doubtful = self.helping.union(self.parts).intersection(self.added)
        large = {e for e in doubtful if surely_large(self.models, self.top, e)}
        helping, parts = self.helping.difference(large), self.parts.difference(large)
        return tuple(e for e in self.added if e not in helping and (e not in parts or not large.intersection(self.parts)))

    def _with(self, best: Candidate) -> Selection | None:
        """The model with what the last round found, and without what that makes needless; None if the error rises once runs
        start where this model wants them, or it cannot run from there."""
        try:
            known = self.models.afresh() if best.afresh else self.models
            models, top = known.settled((*self.rounds[-1].effects, best.effect), best.fit)
        except SimulationError:
            return None
        if risen(self.top.fit, top.fit, self.models.policy, led=self.models.factory.leads):
            return None
        return self.up_to(models, top)._pruned()

    def _pruned(self) -> Selection:
        """The model without what its last effect makes needless; but never one that was searched from before, as the search
        would come back to here."""
        needed, fewer = pruned(self.models, self.effects, self.top.fit, self.already)
        if needed == self.effects or any(set(r.effects) == set(needed) for r in self.rounds):
            return self
        self.models.say("starting again without what is needed no more")
        return self._anew(needed, fewer)

    def _looked_beside(self) -> tuple[Selection, bool]:
        """Each effect searched for again beside all others, and another put in its place where that explains more by far; was
        one?"""
        now = replace(self, beside={})
        for effect in self.added:
            r = now._beside(effect)
            if r and (ahead := overtaker(r, effect)):
                self.models.say(f"starting again with {ahead.effect} in the place of {effect}")
                now = replace(now, rounds=(*now.rounds, r))
                return now._anew((*r.effects, ahead.effect), ahead.fit)._pruned(), True
            now = replace(now, beside={**now.beside, effect: r})
        return now, False

    def _beside(self, effect: str) -> Round | None:
        """The round that found an effect beside all others of the model, or else a search again."""
        latest = max(i for i, r in enumerate(self.rounds) if any(c.effect == effect for c in r.candidates))
        before = self.rounds[latest]
        whole = not before.contested and {*before.effects, effect} == set(self.effects)
        if whole and before.winner and before.winner.effect == effect:
            return before
        self.models.say(f"searching for {effect} again, beside all others")
        known = before if latest >= self.noisier and not before.contested else None
        return beside(self.models, effect, self.top, known, self.calibrated)

    def _found(self) -> tuple[Selection, Candidate | None]:
        """What a round of search finds: one effect, or a group; failing that, several of one law; failing that, one that only
        helps."""
        self.models.say(f"screening {'what is left' if self.effects else 'the catalogue'}")
        r = searched(self.models, self.top, explained=self.calibrated - self.top.fit.deviance)
        now, best = replace(self, rounds=(*self.rounds, r)), r.winner
        if best is not None and len(best.members) > 1:
            now, best = now._parted(r, best)
            best = best or replace(r, groups=()).winner
        if best is None and now.ladder[-1].left > self.models.effort.several and not now.tried_together:
            self.models.say("trying effects of one law together")
            now, joined = replace(now, tried_together=True), together(self.models, r)
            now, best = now._parted(r, joined) if joined else (now, None)
        if best is None and r.slight and now._unsettled():
            best = r.slight[0]
            now = replace(now, helping=now.helping | {best.effect})
        return now, best

    def _unsettled(self) -> bool:
        """Is a model off the noise floor, or on it only with forces that nobody recorded, or with given values bent as far as
        they may be?"""
        if self.models.factory.leads or self.ladder[-1].fit > self.models.policy.nothing_left:
            return True
        return any(v.beyond for v in calibration(self.models.likelihood(self.effects), self.top.fit))

    def _parted(self, r: Round, group: Candidate) -> tuple[Selection, Candidate | None]:
        """The last effect of a group that a round found; the others are steps by then. None where the model cannot run with a
        part of the group: nobody can say what is needed of it."""
        try:
            rounds = parted(self.models, r, group)
        except SimulationError:
            return self, None
        last, parts = rounds[-1], self.parts | {c.effect for one in rounds for c in one.candidates}
        steps = tuple(self._passed(last, i) for i in range(len(r.effects) + 1, len(last.effects) + 1))
        found = replace(self, rounds=(*self.rounds, *rounds), parts=parts, ladder=(*self.ladder, *steps))
        return found, last.candidates[0]

    def _passed(self, last: Round, count: int) -> Step:
        """The step up to the model with the first so many effects of a round's, judged where each run starts and is pushed by
        this model, as by anyone who simulates it: casters that swing may go another way than along what fits kept."""
        fewer, campaign = last.effects[:count], self.models.campaign
        fit = last.fit if fewer == last.effects else self.models.fitted(fewer, last.fit.values)
        likelihood = self.models.likelihood(fewer)
        fitted, held = (likelihood.evidence(runs, fit.values, tune_start=TUNING) for runs in (campaign.fit, campaign.holdout))
        return Step.of(f"+{fewer[-1]}", fitted, held, fit.values)

    def up_to(self, models: Models, top: Model) -> Selection:
        """A step up to another model, by the noise that shows now that its last effect is in. What dry friction tells depends
        on how strong forces are, and these were as strong as a model without it needs: both are found one from another."""
        now, anew = replace(self, models=models, top=top), None
        slips = models.factory.leads and any(map(models.factory.dry, top.effects))
        for _ in range(LED if slips else 1):
            known = now.models.with_noise_of(now.top.fit, again=True)
            if known is None:
                break
            known.say("calibrating with the noise that is left")
            now = anew = replace(now, models=known, noisier=len(self.rounds))._anew(now.effects, now.top.fit)
        return anew or now._told(self.ladder)

    def _anew(self, effects: tuple[str, ...], found: Fit) -> Selection:
        """The model with these effects, fitted about so, and its staircase, from the first step."""
        begun = first_steps(self.models)
        models, base, ladder = begun.models, begun.calibrated.fit, begun.ladder
        calibrated = base.deviance
        for i in range(1, len(effects)):
            models, passed = models.with_given(effects[:i], replace(found, values={**found.values, **base.values}))
            base, ladder = passed.fit, (*ladder, _step_to(passed))
        models, top = models.settled(effects, found)
        return replace(self, models=models, top=top, calibrated=calibrated)._told(ladder)

    def _told(self, below: tuple[Step, ...]) -> Selection:
        """With the staircase up to the model at hand, which is said."""
        now = replace(self, ladder=(*below, _step_to(self.top)))
        self.stepped(now.ladder)
        return now


def selection(beginning: Beginning, stepped: Callable[[Sequence[Step]], None]) -> Selection:
    """The foot of the staircase: calibrated, and with the effects that the chair came with estimated anew."""
    now = Selection(beginning.models, beginning.calibrated, beginning.ladder, beginning.calibrated.fit.deviance, stepped)
    stepped(now.ladder)
    w = beginning.models.factory
    for effect in w.variant.effects:
        if w.parameters(effect):
            models, top = now.models.with_given((*now.effects, effect), now.top.fit)
            now = now.up_to(models, top)
    return replace(now, already=now.effects)


def _step_to(model: Model) -> Step:
    return Step.of(f"+{model.effects[-1]}", model.fit.evidence, model.heldout, model.fit.values)
