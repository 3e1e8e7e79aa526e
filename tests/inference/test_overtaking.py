"""Which effect takes the place of one that was found, by rounds and misfits as they might be."""

from __future__ import annotations

from types import SimpleNamespace as Some

import numpy as np
import pytest

from wheelchair_fmu.inference.estimation.fit import Fit
from wheelchair_fmu.inference.evidence.evidence import Evidence
from wheelchair_fmu.inference.policy import DEFAULT
from wheelchair_fmu.inference.search import ties
from wheelchair_fmu.inference.search.selection import StepwiseSelection
from wheelchair_fmu.inference.search.ties import beside, overtaker, tied

WITHOUT = 1000.0  # misfit of a model that lacks an effect; with it, 0


def fit(misfit):
    return Fit((), {}, np.zeros((0, 0)), Evidence((), ()), misfit, np.zeros(0))


def one(effect, misfit):
    support = Some(fitted=-misfit / 2, large=-misfit / 2)
    return Some(effect=effect, fit=fit(misfit), drop=WITHOUT - misfit, heldout=None, support=support, scale=1.0)


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
    """A search that knows what every model does; it notes what refits it is `asked` for."""

    def __init__(self, misfits):
        self.misfits, self.asked, self.policy = misfits, [], DEFAULT
        self.factory = Some(parameters=lambda effect: [f"effect.{effect}.size"], likelihood=lambda effects: self)

    def restarted(self, evidence, values):
        return evidence

    def screen(self, base, effects):
        return [Some(score=Some(effect=e, drop=WITHOUT - m)) for e, m in self.misfits.items()]

    def refit(self, effects, start):
        assert effects == ("later",)
        return fit(WITHOUT)

    def heldout(self, likelihood, values):
        return Evidence((), ())

    def compared(self, found, effect, base):
        return found

    def rival_of(self, effect, effects, base, held):
        return base, held

    def judge(self, base, held, found, found_held, effect, names, tests):
        assert names == [f"effect.{effect}.size"] and tests == len(self.misfits)
        return one(effect, found.misfit)

    def candidate(self, base, held, effects, s, tests, least):
        self.asked.append((s.score.effect, least))
        return one(s.score.effect, self.misfits[s.score.effect]) if s.score.drop >= least else None


def before(*others, alone=0.0, small=False):
    """The round that found a gain of the force sensors, alone, and others with these misfits."""
    gain = Some(**vars(one("gain", alone)) | {"matters": not small})
    rest = (Some(**vars(one(e, m)), lawful=True) for e, m in others)
    return Some(fit=fit(WITHOUT), candidates=(Some(**vars(gain), lawful=True), *rest), again=True, policy=DEFAULT)


@pytest.fixture
def search(monkeypatch):
    monkeypatch.setattr(ties, "shortlist", lambda screened, most, alike: screened)
    monkeypatch.setattr(ties, "ranked", lambda found: sorted(found, key=lambda c: -c.drop))
    return Known({"gain": 0.0, "inertia": -50.0, "radius": 300.0, "slope": 900.0})


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
def test_an_effect_is_searched_for_again_beside_all_others(search, found_in):
    r = beside(search, "gain", ("gain", "later"), fit(0.0), None, found_in)
    assert r.again and r.effects == ("later",)
    # the effect is as it is in the model; others are refitted, where they promise half as much
    assert [(c.effect, c.drop) for c in r.candidates] == [("inertia", 1050.0), ("gain", 1000.0), ("radius", 700.0)]
    assert search.asked == [("inertia", 500.0), ("radius", 500.0), ("slope", 500.0)]
    assert {s.effect for s in r.scores} == set(search.misfits)


def test_where_none_came_near_and_it_does_what_it_did_nobody_searches(search):
    assert beside(search, "gain", ("gain", "later"), fit(0.0), None, before(("slope", 900.0), ("later", 100.0))) is None
    assert not search.asked


def test_ties_of_a_search_again_are_with_the_effect_of_the_model_whoever_was_found():
    """Without held-out runs, say, nobody is found who is not plain: then the best found may be far behind."""
    lawful = [
        Some(**vars(one(e, m)), lawful=True, matters=e == "slope")
        for e, m in (("gain", 0.0), ("inertia", 8.0), ("radius", 20.0), ("slope", 450.0))
    ]
    assert tied(Some(candidates=lawful, again=True, policy=DEFAULT), "gain") == ("gain", "inertia")


@pytest.mark.parametrize(
    ("behind", "ahead", "se", "is_tied"),
    [
        (9.0, -300.0, 60.0, True),  # as likely on fitted runs
        (12.0, 5.0, 2.0, True),  # and on all runs together
        (20.0, 5.0, 2.0, False),
        (40.0, 5.0, 60.0, True),  # nobody can tell on held-out runs
        (60.0, 5.0, 60.0, False),  # but it explains too little
        (40.0, -300.0, 60.0, False),
    ],
)
def test_who_explains_nearly_as_much_is_tied_by_what_is_held_out(monkeypatch, behind, ahead, se, is_tied):
    monkeypatch.setattr(ties, "_ahead_on_heldout", lambda one, other: (ahead, se) if one is not other else (0.0, 0.0))
    candidates = [Some(**vars(one(e, m)), lawful=True, matters=True) for e, m in (("drag", 0.0), ("speed", behind))]
    assert tied(Some(candidates=candidates, again=False, policy=DEFAULT), "drag") == (
        ("drag", "speed") if is_tied else ("drag",)
    )


@pytest.mark.parametrize(("rms", "stays"), [(1.0, True), (1.2, True), (1.3, False)])
def test_an_effect_that_raises_the_error_once_its_runs_start_anew_is_not_put_in(monkeypatch, rms, stays):
    def settled(effects, fit):
        factory.starts["spin"] = {"start.u": 1.0}
        return Some(evidence=Some(rms=rms)), "held with it"

    factory = Some(starts={"spin": {"start.u": 0.0}})
    selection = object.__new__(StepwiseSelection)
    selection.__dict__ |= {
        "search": Some(factory=factory, settled=settled),
        "effects": ("drag",),
        "base": Some(evidence=Some(rms=1.15)),
        "rounds": [Some(effects=("drag",))],
        "held": "held",
        "helping": {"toe"},
        "ladder": ["nominal", "calibrated", "+drag"],
    }
    monkeypatch.setattr(StepwiseSelection, "_step", lambda self: self.ladder.append("+toe"))
    monkeypatch.setattr(StepwiseSelection, "_prune", lambda self: None)
    assert selection._put_in(Some(effect="toe", fit=None)) == stays
    assert selection.effects == (("drag", "toe") if stays else ("drag",))
    assert selection.ladder == ["nominal", "calibrated", "+drag", *(["+toe"] if stays else [])]
    assert selection.held == ("held with it" if stays else "held")
    assert factory.starts["spin"]["start.u"] == (1.0 if stays else 0.0)
    assert selection.helping == ({"toe"} if stays else set())
