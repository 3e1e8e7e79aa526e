"""Which effect takes the place of one that was found, by rounds and deviances as they might be."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace as Some

import numpy as np
import pytest

from wheelchair_fmu.inference.estimation.problem import Fit
from wheelchair_fmu.inference.evidence.evidence import Evidence
from wheelchair_fmu.inference.models.hypothesis import Model
from wheelchair_fmu.inference.policy import DEFAULT, USUAL
from wheelchair_fmu.inference.residual.staircase import Step
from wheelchair_fmu.inference.search import selection as selecting
from wheelchair_fmu.inference.search import ties
from wheelchair_fmu.inference.search.rounds import Belief
from wheelchair_fmu.inference.search.selection import Selection
from wheelchair_fmu.inference.search.ties import beside, overtaker, probable, tied

WITHOUT = 1000.0  # deviance of a model that lacks an effect; with it, 0


def fit(deviance):
    return Fit((), {}, np.zeros((0, 0)), Evidence((), ()), deviance, np.zeros(0))


def readings(apart):
    """Evidence that is so far from that of 0, in squares."""
    return Evidence((Some(r=np.array([[np.sqrt(apart)]]), run=Some(time=np.arange(2.0))),), ())


def one(effect, deviance, held=None):
    support = Some(fitted=-deviance / 2, large=-deviance / 2)
    heldout = None if held is None else readings(held)
    return Some(
        effect=effect, fit=fit(deviance), likelihood_ratio=WITHOUT - deviance, heldout=heldout, support=support, scale=1.0
    )


@pytest.mark.parametrize(
    ("ahead", "again", "expected"),
    [
        (one("inertia", -20.0), True, True),
        (one("inertia", -9.0), True, False),  # not by far
        (one("gain", -20.0), True, False),  # the effect itself, from another start
        (one("inertia", -20.0), False, False),  # the round that found it: others were judged beside the same
        (None, True, False),
    ],
)
def test_who_explains_more_by_far_beside_all_others_takes_the_place(ahead, again, expected):
    r = Some(winner=ahead, again=again, candidates=[one("gain", 0.0)], policy=DEFAULT)
    assert overtaker(r, "gain") is (ahead if expected else None)


class Known:
    """Models of which it is known what every one does; it is noted what refits are `asked` for."""

    def __init__(self, deviances):
        self.deviances, self.asked, self.policy, self.effort = deviances, [], DEFAULT, USUAL
        self.factory = Some(parameters=lambda effect: [f"effect.{effect}.size"])

    def likelihood(self, effects):
        return Some(restarted=lambda evidence, values: evidence)

    def model(self, effects, start):
        assert effects == ("later",)
        return Model(effects, fit(WITHOUT), Evidence((), ()))

    def compared(self, found, effect, base):
        return found

    def rival_of(self, effect, base):
        return base


def screen(models, base):
    return [Some(score=Some(effect=e, likelihood_ratio=WITHOUT - m)) for e, m in models.deviances.items()]


def judge(models, base, found, effect, names, tests):
    assert names == [f"effect.{effect}.size"] and tests == len(models.deviances)
    return one(effect, found.fit.deviance)


def candidate(models, base, s, tests, least):
    models.asked.append((s.score.effect, least))
    return one(s.score.effect, models.deviances[s.score.effect]) if s.score.likelihood_ratio >= least else None


def before(*others, alone=0.0, small=False):
    """The round that found a gain of the force sensors, alone, and others with these deviances."""
    gain = Some(**vars(one("gain", alone)) | {"matters": not small})
    rest = (Some(**vars(one(e, m)), lawful=True, matters=False) for e, m in others)
    return Some(fit=fit(WITHOUT), candidates=(Some(**vars(gain), lawful=True), *rest), again=True, policy=DEFAULT)


def believed(*there):
    """What a round believes of effects, by name and the probability that they are there."""
    return {effect: Belief(p, p) for effect, p in there}


@pytest.fixture
def models(monkeypatch):
    for part in (screen, judge, candidate):
        monkeypatch.setattr(ties, part.__name__, part)
    monkeypatch.setattr(ties, "shortlist", lambda models, screened: screened)
    monkeypatch.setattr(ties, "ranked", lambda found: sorted(found, key=lambda c: -c.likelihood_ratio))
    return Known({"gain": 0.0, "inertia": -50.0, "radius": 300.0, "slope": 900.0})


FINAL = Model(("gain", "later"), fit(0.0), Evidence((), ()))


@pytest.mark.parametrize(
    "found_in",
    [
        before(("inertia", 400.0)),  # somebody came near
        before(alone=-1500.0),  # what it did alone others do now
        before(small=True),  # it only helped others on
        before(("inertia", 992.0), alone=983.0),  # somebody was as good, of little
        None,  # nobody knew the noise
    ],
)
def test_an_effect_is_searched_for_again_beside_all_others(models, found_in):
    r = beside(models, "gain", FINAL, found_in)
    assert r.again and r.effects == ("later",)
    # the effect is as it is in the model; others are refitted, where they promise half as much
    assert [(c.effect, c.likelihood_ratio) for c in r.candidates] == [("inertia", 1050.0), ("gain", 1000.0), ("radius", 700.0)]
    assert models.asked == [("inertia", 500.0), ("radius", 500.0), ("slope", 500.0)]
    assert {s.effect for s in r.scores} == set(models.deviances)


def test_where_none_came_near_and_it_does_what_it_did_nobody_searches(models):
    assert beside(models, "gain", FINAL, before(("slope", 900.0), ("later", 100.0))) is None
    assert not models.asked


def test_ties_of_a_search_again_are_with_the_effect_of_the_model_whoever_was_found():
    """Without held-out runs, say, nobody is found who is not plain: then the best found may be far behind."""
    lawful = [
        Some(**vars(one(e, m)), lawful=True, matters=e == "slope")
        for e, m in (("gain", 0.0), ("inertia", 8.0), ("radius", 20.0), ("slope", 450.0))
    ]
    beliefs = believed(("gain", 0.85), ("inertia", 0.05), ("radius", 0.0), ("slope", 0.1))
    assert tied(Some(candidates=lawful, again=True, policy=DEFAULT, beliefs=beliefs), "gain") == ("gain", "inertia")


@pytest.mark.parametrize(
    ("there", "is_tied", "found"),
    [
        ((0.42, 0.49), True, True),
        ((0.49, 0.42), True, True),
        ((0.6, 0.38), False, True),  # likelier than not by itself
        ((0.4, 0.003), False, False),  # the rest is that nothing is there
    ],
)
def test_what_may_well_be_there_instead_is_not_told_from_an_effect(there, is_tied, found):
    """By fitted runs alone a trunk is ahead by far; by those held out, resampled, the other form of a body's motion is as good.
    Neither is likelier than not by itself, and nobody is to say that nothing is there."""
    lawful = [Some(**vars(one(e, m)), lawful=True, matters=True) for e, m in (("trunk", 0.0), ("strokes", 200.0))]
    r = Some(candidates=lawful, again=True, policy=DEFAULT, beliefs=believed(*zip(("trunk", "strokes"), there, strict=True)))
    assert tied(r, "trunk") == (("trunk", "strokes") if is_tied else ("trunk",))
    assert probable(r, "trunk") == found


@pytest.mark.parametrize(
    ("behind", "ahead", "held", "is_tied"),
    [
        (9.0, -300.0, 80.0, True),  # as likely on fitted runs
        (12.0, 5.0, 40.0, True),  # and on all runs together
        (20.0, 5.0, 40.0, False),
        (40.0, -5.0, 3.0, True),  # nobody can tell on held-out runs
        (40.0, 1.0, 5.0, False),  # where somebody could, whoever is ahead
        (60.0, -5.0, 3.0, False),  # but it explains too little
        (40.0, -300.0, None, False),  # nothing was held out
    ],
)
def test_who_explains_nearly_as_much_is_tied_by_what_is_held_out(monkeypatch, behind, ahead, held, is_tied):
    monkeypatch.setattr(ties, "_ahead_on_heldout", lambda one, other: ahead if one is not other else 0.0)
    drag, speed = one("drag", 0.0, held=0.0), one("speed", behind, held)
    candidates = [Some(**vars(c), lawful=True, matters=True) for c in (drag, speed)]
    r = Some(candidates=candidates, again=False, policy=DEFAULT, beliefs=believed(("drag", 0.9), ("speed", 0.1)))
    assert tied(r, "drag") == (("drag", "speed") if is_tied else ("drag",))


@pytest.mark.parametrize(("rms", "stays"), [(1.0, True), (1.2, True), (1.3, False)])
def test_an_effect_that_raises_the_error_once_its_runs_start_anew_is_not_put_in(monkeypatch, rms, stays):
    """What it did to the search goes with it: where runs start, the steps to it, and that it helped."""

    def top(*effects, rms):
        return Model(effects, replace(fit(0.0), evidence=Some(rms=rms)), Evidence((), ()))

    usual = {"effort": USUAL, "policy": DEFAULT, "factory": Some(leads=False)}
    moved = Some(**usual)
    models = Some(**usual, settled=lambda effects, found: (moved, top(*effects, rms=rms)))
    *ladder, part, toe = (Step(name, rms, rms) for name in ("nominal", "calibrated", "+drag", "+part", "+toe"))
    foot = Selection(models, top("drag", rms=1.15), tuple(ladder), 0.0, print, rounds=(Some(effects=("drag",)),))
    helped = replace(foot, ladder=(*ladder, part), helping=frozenset({"toe"}))
    found = iter([lambda now: (helped, Some(effect="toe", fit=None, afresh=False)), lambda now: (now, None)])
    monkeypatch.setattr(Selection, "_found", lambda self: next(found)(self))
    monkeypatch.setattr(Selection, "_looked_beside", lambda self: (self, False))
    monkeypatch.setattr(
        Selection, "up_to", lambda self, models, top: replace(self, models=models, top=top, ladder=(*self.ladder, toe))
    )
    monkeypatch.setattr(Selection, "_pruned", lambda self: self)
    now = foot.to_the_top()
    assert now.effects == (("drag", "toe") if stays else ("drag",))
    assert now.ladder == ((*ladder, part, toe) if stays else tuple(ladder))
    assert now.models is (moved if stays else models)
    assert now.helping == ({"toe"} if stays else set())


@pytest.mark.parametrize(
    ("rms", "far", "reached"),
    [
        ((5.0, 3.0, 2.9, 1.0), 1.3, 2),  # the second step leaves nearly all that the first one left
        ((5.0, 4.0, 2.0, 1.0), 1.3, 1),  # and here the first leaves more than half
        ((5.0, 3.0, 1.5, 1.0), 1.3, 3),  # here all do much
        ((1.29, 1.28, 1.27, 1.0), 1.3, 3),  # what is left is little
        ((5.0, 3.0, 2.9, 1.0), np.inf, 3),
    ],
)
def test_a_search_pauses_where_a_step_does_little_and_much_is_left(monkeypatch, rms, far, reached):
    """It goes on from there as if it had not."""
    steps = [Step(f"+{i}", one, one) for i, one in enumerate(rms)]

    def one_step(self):
        ended = len(self.ladder) == len(steps) + 1
        return replace(self, ended=ended, ladder=self.ladder if ended else (*self.ladder, steps[len(self.ladder) - 1]))

    monkeypatch.setattr(Selection, "_one_step", one_step)
    foot = Selection(
        Some(effort=USUAL, policy=DEFAULT),
        Model((), fit(0.0), Evidence((), ())),
        (Step("nominal", 9.0, 9.0), steps[0]),
        0.0,
        print,
    )
    now = foot.to_the_top(far)
    assert len(now.ladder) == 2 + reached and now.ended == (reached == 3)
    assert now.to_the_top().ladder == (foot.ladder[0], *steps) and now.to_the_top().ended


@pytest.mark.parametrize(("searched", "effects"), [([(), ("toe",)], ("drag",)), ([(), ("toe",), ("drag",)], ("toe", "drag"))])
def test_a_search_does_not_go_in_circles(monkeypatch, searched, effects):
    """Each of two effects makes the other needless, and is found again beside it: a model that was searched from is not left
    for another one and come back to."""
    monkeypatch.setattr(selecting, "pruned", lambda models, every, found, keep: (("drag",), fit(1.0)))
    monkeypatch.setattr(Selection, "_anew", lambda self, needed, fewer: replace(self, top=replace(self.top, effects=needed)))
    both = Model(("toe", "drag"), fit(0.0), Evidence((), ()))
    rounds = tuple(Some(effects=one) for one in searched)
    now = Selection(Some(say=lambda words: None), both, (), 0.0, print, rounds=rounds)
    assert now._pruned().effects == effects
