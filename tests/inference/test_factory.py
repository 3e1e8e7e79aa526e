"""Which effects a likelihood can switch on, and that likelihoods of one model agree."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest

from wheelchair_fmu.engine import cache
from wheelchair_fmu.engine.cache import Wanted
from wheelchair_fmu.inference.decision import leftover
from wheelchair_fmu.inference.decision.leftover import prepare
from wheelchair_fmu.inference.models.factory import CALIBRATED, ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.policy import USUAL
from wheelchair_fmu.inference.search.beginning import begin
from wheelchair_fmu.inference.search.refitting import candidate
from wheelchair_fmu.inference.search.screen import screen
from wheelchair_fmu.model.caster import slipping
from wheelchair_fmu.model.choice import Choice, OwnLaw
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.generic import library
from wheelchair_fmu.model.variant import Variant

SIGMA, TOE = "effect.relaxation_length.sigma", "effect.toe_misalignment.sum"


@pytest.fixture(scope="module")
def shop(sample):
    return ModelFactory(sample, Variant(catalogue=bundled()))


def test_a_bench_carries_what_was_asked_for_and_light_effects_where_that_costs_no_state(shop):
    light = set(shop.light)
    assert set(shop.likelihood().variant.effects) == set(shop.likelihood(["toe_misalignment"]).variant.effects) == light
    assert shop.likelihood(["relaxation_length"]).variant.effects == ("relaxation_length",)
    assert set(shop.likelihood(["relaxation_length", "toe_misalignment"]).variant.effects) == light | {"relaxation_length"}
    assert set(shop.wide(["relaxation_length"]).variant.effects) == light | {"relaxation_length"}


def test_benches_of_one_model_agree(shop):
    values, runs = {SIGMA: 0.1}, shop.campaign.fit[:2]
    narrow, wide = (
        likelihood.evidence(runs, values, [SIGMA])
        for likelihood in (shop.likelihood(["relaxation_length"]), shop.wide(["relaxation_length"]))
    )
    assert np.abs(narrow.r - wide.r).max() < 1e-9
    assert np.abs(narrow.S - wide.S).max() < 1e-9 * np.abs(wide.S).max()
    again = shop.rerun(["relaxation_length"]).resimulated(wide, {SIGMA: 0.12})
    assert np.abs(again.r - shop.wide(["relaxation_length"]).resimulated(wide, {SIGMA: 0.12}).r).max() < 1e-9


def test_a_bench_without_parameters_to_fit_derives_by_where_runs_start(sample):
    shop = ModelFactory(sample, Variant(catalogue=bundled()).with_effects(["relaxation_length"]), {*CALIBRATED, SIGMA})
    evidence = shop.likelihood().evidence(sample.fit[:1], {}, tune_start=1)
    assert evidence.S.shape[1] == 0 and np.isfinite(evidence.rms)


def test_a_variant_s_own_effects_are_on_every_likelihood(sample):
    shop = ModelFactory(sample, Variant(catalogue=bundled()).with_effects(["relaxation_length"]))
    for likelihood in (shop.likelihood(), shop.wide(), shop.rerun(["trunk_motion"])):
        assert "relaxation_length" in likelihood.variant.effects
    assert TOE in shop.wide().records and TOE not in shop.likelihood().records


def test_what_a_law_of_swinging_casters_leaves_open_is_calibrated_whoever_wrote_it(sample):
    """Be it bundled, or a user's own that comes along with the chair; ideal casters leave nothing open."""
    text = Path(slipping.__file__).read_text(encoding="utf-8").replace('"slipping"', '"mine"')
    own = Choice(caster="mine", own=(OwnLaw("caster", "mine", text, "mine.py"),))
    ideal, bundled_, mine = (ModelFactory(sample, Variant(c)).calibrated for c in (Choice(), Choice(caster="slipping"), own))
    assert not any(n.startswith("caster.") for n in ideal)
    assert {"caster.trail", "caster.I", "caster.M", "caster.C_lambda"} == set(bundled_) - set(ideal)
    assert mine == bundled_


def test_no_model_is_compiled_with_derivatives_for_an_effect_that_promises_too_little(sample, monkeypatch):
    models = Models.of(ModelFactory(sample, Variant(catalogue=bundled())))
    begun = begin(models)
    (scored,) = (s for s in screen(begun.models, begun.calibrated) if s.score.effect == "relaxation_length")
    asked: list[object] = []
    load = cache.library

    def watched(*words, **options):
        asked.append(words[2])
        return load(*words, **options)

    monkeypatch.setattr(cache, "library", watched)
    refit = partial(candidate, begun.models, begun.calibrated, scored, 40)
    assert refit(least=2 * USUAL.beyond * scored.score.likelihood_ratio) is None and not asked
    assert refit() is not None and asked


def test_what_may_be_left_is_compiled_beside_other_work(sample, monkeypatch):
    """The very library that is asked for in the end, and none where nothing is looked for."""
    models, terms = Models.of(ModelFactory(sample, Variant(catalogue=bundled()))), library()
    compiled: list[Wanted] = []
    monkeypatch.setattr(leftover, "meanwhile", lambda do: do())
    monkeypatch.setattr(cache, "library", lambda *words: compiled.append(Wanted.of(*words)) or "loaded")
    prepare(models, terms)
    assert models.widened(terms).wide(["toe_misalignment"]).sensitivities.library == "loaded"
    assert len(compiled) == 2 and compiled[0] == compiled[1]
    prepare(models, {})
    prepare(replace(models, factory=models.factory.narrowed()), terms)
    assert len(compiled) == 2
