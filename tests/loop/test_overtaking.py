"""Which effect takes the place of one that was found, by rounds and misfits as they might be."""

from __future__ import annotations

from types import SimpleNamespace as Some

import pytest

from wheelchair_fmu.loop import ties

MARGIN = 9.2


def one(effect, drop, found=True):
    return Some(effect=effect, drop=drop, found=found, fit=Some(values={f"effect.{effect}.size": drop / 100}))


def a_round(*candidates, helped=None):
    """A round of search from the calibrated model; `helped`: only that one went in, to help others on."""
    best = None if helped else candidates[0]
    return Some(effects=(), candidates=candidates, winner=best, help=next((c for c in candidates if c.effect == helped), None))


@pytest.fixture
def overtaker(monkeypatch):
    """Calls `overtaker` where a model with these effects would have these misfits; None for one that cannot run."""
    monkeypatch.setattr(ties, "decisive", lambda evidence: MARGIN)

    def call(r, effects, misfits):
        asked = []

        def remembered(swapped, start):
            asked.append((swapped, start))
            return None if misfits[swapped] is None else Some(misfit=misfits[swapped])

        search = Some(workshop=Some(parameters=lambda effect: [f"effect.{effect}.size"]), remembered=remembered)
        final = Some(misfit=0.0, evidence=None, values={"tyre.C_lambda": 5000.0})
        return ties.overtaker(search, r, effects, final), asked

    return call


def test_who_explains_more_beside_what_came_later_takes_the_place(overtaker):
    r = a_round(one("gain", 1000), one("inertia", 700), one("radius", 600), one("slope", 400))
    found, asked = overtaker(r, ("gain", "later"), {("inertia", "later"): -20.0, ("radius", "later"): -50.0})
    assert found[0] == "gain" and found[1].effect == "radius" and found[2].misfit == -50.0
    assert asked[0] == (("inertia", "later"), {"tyre.C_lambda": 5000.0, "effect.inertia.size": 7.0})
    assert [swapped[0] for swapped, _ in asked] == ["inertia", "radius"]  # a slope did too little alone


@pytest.mark.parametrize("misfit", [-9.0, 50.0, None])
def test_who_does_not_explain_more_by_far_does_not(overtaker, misfit):
    r = a_round(one("gain", 1000), one("inertia", 700))
    assert overtaker(r, ("gain", "later"), {("inertia", "later"): misfit})[0] is None


def test_nobody_is_tried_again_where_nothing_came_later_or_the_effect_is_needed_no_more(overtaker):
    r = a_round(one("gain", 1000), one("inertia", 700))
    assert overtaker(r, ("gain",), {}) == (None, [])
    assert overtaker(r, ("inertia", "later"), {}) == (None, [])


def test_what_only_helped_gives_way_to_what_is_found(overtaker):
    r = a_round(one("cross_slope", 1700, found=False), one("camber", 1300), helped="cross_slope")
    found, _ = overtaker(r, ("cross_slope",), {("camber",): -140.0})
    assert found[:2] == ("cross_slope", r.candidates[1])
