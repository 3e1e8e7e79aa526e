"""Up the staircase: effect after effect goes into the model, and what it makes needless leaves, until nothing more is found."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from ...errors import SimulationError
from ..estimation.fit import Fit
from ..residual.staircase import Step
from .beginning import begin, first_steps
from .candidate import Candidate
from .joint import parted, together
from .rounds import Round
from .screen import AT_THE_FLOOR
from .search import Search
from .ties import beside, overtaker

MOST_EFFECTS = 4  # that are put in: whoever lacks more needs another model
MOST_STEPS = 8  # that put one in, or one in the place of another
RISEN = 1.1  # times the whitened RMS error, which an effect may cost on fitted runs
MUCH = 1.2  # whitened RMS error, fitted and held out, that is worth a search for several effects at once


class StepwiseSelection:
    """A model on its way up: its `effects`, the fit `base` with all of them, the `held`-out evidence, the staircase `ladder`
    that led there, the `rounds` of search, and for an effect that was found the one that judges it `beside` all others.

    `already` are the effects that the variant came with; of others `helping` are in though they may be too small to be named,
    and `parts` as members of a group.
    `stepped` is told the staircase whenever it has changed.
    """

    def __init__(self, search: Search, stepped: Callable[[Sequence[Step]], None]):
        self.search, self._stepped = search, stepped
        self.effects: tuple[str, ...] = ()
        self.rounds: list[Round] = []
        self.beside: dict[str, Round | None] = {}
        self.helping: set[str] = set()
        self.parts: set[str] = set()
        self._tried_together = False
        self._noise_known_since = 0  # rounds that were searched with other noise than is known now
        self.base, self.held, self.ladder = begin(search, search.say)
        self._calibrated = self.base.misfit
        self._tell()
        for effect in search.factory.variant.effects:
            if search.factory.parameters(effect):
                self.effects = (*self.effects, effect)
                self.base, self.held = search.with_given(self.effects, self.base)
                self._step()
        self.already = self.effects

    def to_the_top(self) -> None:
        """Search, put in what was found, leave out what that makes needless, and let others take the place of what they
        overtake, as long as anything is found."""
        for _ in range(MOST_STEPS):
            best = self._found() if len(self.effects) - len(self.already) < MOST_EFFECTS else None
            if not (best and self._put_in(best)) and not self._overtaken():
                return  # which has looked beside all
        self.beside = {effect: self._beside(effect) for effect in self.effects[len(self.already) :]}

    def _put_in(self, best: Candidate) -> bool:
        """The model with what the last round found, and without what that makes needless; as before, if the error rises once
        runs start where this model wants them."""
        factory, effects = self.search.factory, (*self.rounds[-1].effects, best.effect)
        before = dict(factory.starts)
        base, held = self.search.settled(effects, best.fit)
        if base.evidence.rms > RISEN * self.base.evidence.rms:
            factory.starts, self.ladder = before, self.ladder[: 2 + len(self.effects)]
            self.helping.discard(best.effect)
            return False
        self.effects, self.base, self.held = effects, base, held
        self._step()
        self._prune()
        return True

    def named(self) -> tuple[str, ...]:
        """The effects that were found, without those that only help: what is likelier slight, be it of a group, unless all of
        the group are."""
        found = [e for e in self.effects if e not in self.already]
        large = {e for e in self.helping.union(self.parts).intersection(found) if self.search.surely_large(self.base, e)}
        helping, parts = self.helping.difference(large), self.parts.difference(large)
        return tuple(e for e in found if e not in helping and (e not in parts or not large.intersection(self.parts)))

    def _prune(self) -> None:
        """The model without what its last effect makes needless."""
        needed, fewer = self.search.pruned(self.effects, self.base, self.already)
        if needed != self.effects:
            self.search.say("starting again without what is needed no more")
            self.effects = needed
            self._anew(fewer)

    def _overtaken(self) -> bool:
        """Search again for each effect beside all others, and put another in its place where that explains more by far."""
        self.beside = {}
        for effect in self.effects[len(self.already) :]:
            self.beside[effect] = r = self._beside(effect)
            if r and (ahead := overtaker(r, effect)):
                self.search.say(f"starting again with {ahead.effect} in the place of {effect}")
                self.rounds.append(r)
                self.effects = (*r.effects, ahead.effect)
                self._anew(ahead.fit)
                self._prune()
                return True
        return False

    def _beside(self, effect: str) -> Round | None:
        """The round that found an effect beside all others of the model, or else a search again."""
        latest = max(i for i, r in enumerate(self.rounds) if any(c.effect == effect for c in r.candidates))
        before = self.rounds[latest]
        whole = not before.contested and {*before.effects, effect} == set(self.effects)
        if whole and before.winner and before.winner.effect == effect:
            return before
        self.search.say(f"searching for {effect} again, beside all others")
        known = before if latest >= self._noise_known_since and not before.contested else None
        return beside(self.search, effect, self.effects, self.base, self.held, known, self._calibrated)

    def _found(self) -> Candidate | None:
        """What a round of search finds: one effect, or a group; failing that, several of one law; failing that, one that only
        helps."""
        self.search.say(f"screening {'what is left' if self.effects else 'the catalogue'}")
        now = self.search.round(self.effects, self.base, self.held, explained=self._explained)
        self.rounds.append(now)
        best = now.winner
        if best is not None and len(best.members) > 1:
            best = self._parted(now, best) or replace(now, groups=()).winner
        if best is None and self.ladder[-1].left > MUCH and not self._tried_together:
            self.search.say("trying effects of one law together")
            self._tried_together = True
            joined = together(self.search, now)
            best = self._parted(now, joined) if joined else None
        if best is None and self.ladder[-1].fit > AT_THE_FLOOR:
            best = next(iter(now.slight), None)
            self.helping |= {best.effect} if best else set()
        return best

    def _parted(self, now: Round, group: Candidate) -> Candidate | None:
        """The last effect of a group that a round found; the others are steps by then. None where the model cannot run with a
        part of the group: nobody can say what is needed of it."""
        try:
            rounds = parted(self.search, now, group)
        except SimulationError:
            return None
        self.rounds += rounds
        self.parts |= {c.effect for r in rounds for c in r.candidates}
        steps = rounds[-1].effects[len(now.effects) :]
        for i, effect in enumerate(steps, len(now.effects) + 1):
            fewer, fit = rounds[-1].effects[:i], rounds[-1].fit
            fit = fit if fewer == rounds[-1].effects else self.search.refit(fewer, fit.values)
            held = self.search.heldout(self.search.factory.likelihood(fewer), fit.values)
            self.ladder.append(Step.of(f"+{effect}", fit.evidence, held))
        return rounds[-1].candidates[0]

    def _step(self) -> None:
        """A step up to the model at hand, by the noise that shows now that its last effect is in."""
        if self.search.reestimate_noise(self.base, again=True):
            self.search.say("calibrating with the noise that is left")
            self._noise_known_since = len(self.rounds)
            self._anew(self.base)
        else:
            self.ladder.append(self._top())
            self._tell()

    def _anew(self, found: Fit) -> None:
        """The model with these effects, fitted about so, and its staircase, from the first step."""
        base, _, self.ladder = first_steps(self.search)
        self._calibrated = base.misfit
        for i in range(1, len(self.effects)):
            base, held = self.search.with_given(self.effects[:i], replace(found, values={**found.values, **base.values}))
            self.ladder.append(Step.of(f"+{self.effects[i - 1]}", base.evidence, held))
        self.base, self.held = self.search.settled(self.effects, found)
        self.ladder.append(self._top())
        self._tell()

    def _top(self) -> Step:
        return Step.of(f"+{self.effects[-1]}", self.base.evidence, self.held)

    @property
    def _explained(self) -> float:
        """By how much −2 log likelihood fell to the model at hand from the calibrated one, by the same noise."""
        return self._calibrated - self.base.misfit

    def _tell(self) -> None:
        self._stepped(tuple(self.ladder))
