"""Of states that no model had yet, such as the angles of casters, nobody knows how they stand where runs start."""

from __future__ import annotations

import pytest

from tests.flips import flipping
from wheelchair_fmu.inference.estimation.fit import fit
from wheelchair_fmu.inference.evidence.initial_state import TUNING
from wheelchair_fmu.inference.evidence.likelihood import Likelihood
from wheelchair_fmu.inference.models.factory import CALIBRATED, ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.policy import USUAL
from wheelchair_fmu.inference.search.screen import at_prior_mean
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
    """With casters that all start behind and pushes without errors, slopes lead to a trail of 3 cm, with more than twice the
    noise left. A descent that looks beyond a step, with runs that follow there, comes to the trail by itself."""
    models, base = aside
    start = {**base.fit.values, TRAIL: 0.03}
    kept, found = models.refit(("caster_trail",), start), models.fitted(("caster_trail",), start)
    for ended in (kept, found):
        assert ended.values[TRAIL] == pytest.approx(TRUE, abs=0.005) and ended.evidence.rms < 1.05
    assert found.deviance <= kept.deviance
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


def test_what_lies_beside_its_bound_in_every_chair_is_not_put_onto_it(sample):
    """A refit starts with a bent stiffness as it was given, and with the speed over which drag sets in as it was found: at zero
    dry friction holds whatever stands, and no slope tells of anything."""
    bent = {"tyre.C_lambda": 9000.0, "resistance.onset": 0.006}
    models, likelihood = Models.of(ModelFactory(sample, Variant())), Likelihood(sample, Variant())
    base = fit(likelihood, list(bent), bent, most=0)
    assert at_prior_mean(models, likelihood, base, USUAL.bent) == [{**bent, "tyre.C_lambda": 5038.0}]
    alone = fit(likelihood, ["resistance.onset"], {"resistance.onset": 0.05}, most=0)
    assert at_prior_mean(models, likelihood, alone, USUAL.bent) == []
