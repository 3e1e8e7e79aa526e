"""Which effect takes the place of one that was found, by rounds and misfits as they might be."""

from __future__ import annotations

from types import SimpleNamespace as Some

import pytest

from wheelchair_fmu.loop import diagnose, ties

MARGIN = 9.2


def one(effect, drop, found=True):
    fit = Some(values={f"effect.{effect}.size": drop / 100}, evidence=None)
    return Some(effect=effect, drop=drop, found=found, small=not found, lawful=True, fit=fit)


def a_round(*candidates, helped=None):
    """A round of search from the calibrated model; `helped`: only that one went in, to help others on."""
    best = None if helped else candidates[0]
    help_ = next((c for c in candidates if c.effect == helped), None)
    return Some(effects=(), candidates=candidates, winner=best, help=help_, scores=())


class Misfits:
    """A search whose models with these effects would have these misfits; None for one that cannot run. It notes what it is
    `asked` for."""

    def __init__(self, misfits, small=()):
        self.misfits, self.small, self.asked = misfits, small, []
        self.workshop = Some(parameters=lambda effect: [f"effect.{effect}.size"], bench=lambda effects: effects)

    def remembered(self, swapped, start):
        self.asked.append((swapped, start))
        misfit = self.misfits[swapped]
        return None if misfit is None else Some(misfit=misfit, values={})

    def with_given(self, effects, base):
        return Some(misfit=1000.0), None

    def refit(self, effects, start, most):
        assert most == 0
        return Some(misfit=self.misfits.get((effects[-1], *effects[:-1]), 0.0))

    def heldout(self, bench, values):
        return None

    def judge(self, base, held, found, found_held, effect, names, tests):
        return one(effect, base.misfit - found.misfit, effect not in self.small)


@pytest.fixture
def overtaken(monkeypatch):
    """Calls `overtaken` where the final model's misfit is 0: the round again, and what was asked."""
    for module in (ties, diagnose):
        monkeypatch.setattr(module, "decisive", lambda evidence: MARGIN)

    def call(r, effects, misfits, small=()):
        search = Misfits(misfits, small)
        final = Some(misfit=0.0, evidence=None, values={"tyre.C_lambda": 5000.0})
        return ties.overtaken(search, r, effects, final), search.asked

    return call


def test_who_explains_more_beside_what_came_later_takes_the_place(overtaken):
    r = a_round(one("gain", 1000), one("inertia", 700), one("radius", 600), one("slope", 400))
    again, asked = overtaken(r, ("gain", "later"), {("inertia", "later"): -20.0, ("radius", "later"): -50.0})
    assert asked[0] == (("inertia", "later"), {"tyre.C_lambda": 5000.0, "effect.inertia.size": 7.0})
    assert [swapped[0] for swapped, _ in asked] == ["inertia", "radius"]  # a slope did too little alone
    assert again.effects == ("later",) and again.winner.effect == "radius"
    # the round says what each does beside what was found later, the one overtaken as well
    assert [(c.effect, c.drop) for c in again.candidates] == [("radius", 1050.0), ("inertia", 1020.0), ("gain", 1000.0)]


@pytest.mark.parametrize("misfit", [-9.0, 50.0, None])
def test_who_does_not_explain_more_by_far_does_not(overtaken, misfit):
    r = a_round(one("gain", 1000), one("inertia", 700))
    assert overtaken(r, ("gain", "later"), {("inertia", "later"): misfit})[0] is None


def test_what_is_not_found_beside_what_came_later_takes_no_place(overtaken):
    r = a_round(one("gain", 1000), one("inertia", 700))
    assert overtaken(r, ("gain", "later"), {("inertia", "later"): -20.0}, small=("inertia",))[0] is None


def test_nobody_is_tried_again_where_nothing_came_later_or_the_effect_is_needed_no_more(overtaken):
    r = a_round(one("gain", 1000), one("inertia", 700))
    assert overtaken(r, ("gain",), {}) == (None, [])
    assert overtaken(r, ("inertia", "later"), {}) == (None, [])


def test_what_only_helped_gives_way_to_what_is_found(overtaken):
    r = a_round(one("cross_slope", 1700, found=False), one("camber", 1300), helped="cross_slope")
    again, _ = overtaken(r, ("cross_slope",), {("camber",): -140.0}, small=("cross_slope",))
    assert again.effects == () and again.winner.effect == "camber"
