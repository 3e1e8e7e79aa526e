"""Of states that no model had yet, such as the angles of casters, nobody knows how they stand where runs start."""

from __future__ import annotations

import pytest

from tests.flips import flipping
from wheelchair_fmu.inference.evidence.initial_state import TUNING
from wheelchair_fmu.inference.models.factory import CALIBRATED, ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.search.search import searched
from wheelchair_fmu.model.variant import Variant

TRAIL, TRUE = "effect.caster_trail.c", 0.05
TURNED = 0.6  # rad that one caster stands to the left where runs start, and the other to the right


@pytest.fixture(scope="module")
def aside(tmp_path_factory):
    """The models of a chair without trails, whose runs start with casters turned aside, and the calibrated one."""
    values = {TRAIL: TRUE, "start.caster_l": TURNED, "start.caster_r": -TURNED}
    chair = Variant().with_effects(["caster_trail"])
    campaign = flipping(tmp_path_factory.mktemp("aside") / "campaign", chair, values)
    models, base, *_ = Models.of(ModelFactory(campaign, Variant(), frozenset(), CALIBRATED)).calibrated()
    return models, base


def test_a_fit_with_new_states_starts_its_runs_where_these_were(aside):
    """With casters that all start behind, the trail comes out at 3 cm, and the error at more than twice the noise."""
    models, base = aside
    start = {**base.fit.values, TRAIL: 0.03}
    kept, found = models.refit(("caster_trail",), start), models.fitted(("caster_trail",), start)
    assert abs(kept.values[TRAIL] - TRUE) > 0.01 and kept.evidence.rms > 2
    assert found.values[TRAIL] == pytest.approx(TRUE, abs=0.005) and found.misfit < kept.misfit - 1000
    stood = [e.start["start.caster_l"] - e.start["start.caster_r"] for e in found.evidence.runs]
    assert all(apart > TURNED for apart in stood)


def test_a_search_judges_new_states_so(aside):
    models, base = aside
    (found,) = searched(models, base, among=["caster_trail"]).candidates
    assert found.estimate[0] == pytest.approx(TRUE, abs=0.005)


def test_what_is_held_out_starts_so_too_until_the_setting_knows_how(aside):
    models, base = aside
    effects = ("caster_trail",)
    found = models.fitted(effects, {**base.fit.values, TRAIL: TRUE})
    held, by = models.campaign.holdout, found.names
    tuned, once = (models.likelihood(effects).evidence(held, found.values, by, tune_start=n).rms for n in (TUNING, 1))
    assert models.heldout(models.likelihood(effects), found).rms == pytest.approx(tuned, rel=1e-9) != pytest.approx(once)
    settled, top = models.settled(effects, found)
    assert settled.started(effects, top.fit) is top.fit


def test_a_model_without_new_states_is_as_it_was(aside):
    models, base = aside
    assert models.started((), base.fit) is base.fit
