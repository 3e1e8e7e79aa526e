"""Which effects of a screen are refitted, by what slopes promise of them."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from wheelchair_fmu.inference.estimation.score import Score
from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.policy import USUAL
from wheelchair_fmu.inference.search.screen import Screened, shortlist
from wheelchair_fmu.model.variant import Variant

LEADER = 180.0


@pytest.fixture(scope="module")
def models(sample) -> dict[bool, Models]:
    """Of runs that no other forces lead, and of runs that are led."""
    factory = ModelFactory(sample, Variant())
    return {False: Models.of(factory), True: Models.of(factory.led())}


def one(effect: str, promised: float, place: int, linear: bool = True) -> Screened:
    """An effect of two δ, that does what no other one does, beside a model that leaves noise."""
    signature, one, noise = np.eye(20)[place], np.ones(1), SimpleNamespace(r=np.ones(100))
    score = Score(effect, ("size",), 2 * one, 0.1 * one, 0.01, promised, 1.0, 0.0, signature, one, np.eye(1), np.zeros((0, 1)))
    return Screened(score, noise, None, one, linear, USUAL)


def chosen(models: Models, *last: Screened) -> list[str]:
    """Of these and of as many that promise more as are refitted in any case, which of these are."""
    first = [one(f"first{i}", LEADER - i, i) for i in range(USUAL.shortlist)]
    return [s.score.effect for s in shortlist(models, [*first, *last])[USUAL.shortlist :]]


def test_what_may_do_as_much_as_the_leader_is_refitted_however_many_came_before(models):
    """A linear effect does what slopes promise, about; another may do ten times that, but where forces lead the runs."""
    near, far = one("near", 0.6 * LEADER, 10), one("far", 0.4 * LEADER, 11)
    bent, hopeless = one("bent", 0.3 * LEADER, 12, linear=False), one("hopeless", 0.09 * LEADER, 13, linear=False)
    assert chosen(models[False], near, far, bent, hopeless) == ["near", "bent"]
    assert chosen(models[True], near, far, bent, hopeless) == ["near"]


def test_what_looks_like_the_leader_is_refitted_whatever_it_promises(models):
    assert chosen(models[False], one("alike", 10.0, 0), one("other", 10.0, 10)) == ["alike"]


def test_where_forces_lead_the_runs_slopes_see_all_that_a_refit_finds(models):
    """Elsewhere perhaps half of it."""
    between = one("between", 1.5 * USUAL.promising, 1)
    assert shortlist(models[False], [between]) == [between] and shortlist(models[True], [between]) == []
