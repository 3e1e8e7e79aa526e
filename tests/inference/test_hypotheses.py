"""Each hypothesis is fitted once: in whatever order its effects were found, and whoever asks."""

from __future__ import annotations

from dataclasses import replace

import pytest

from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.inference.models.hypothesis import Hypothesis
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.inference.search.refitting import candidate
from wheelchair_fmu.inference.search.screen import screen
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant

DRAG, BIAS = "rolling_resistance_asymmetry", "gyro_bias"


@pytest.fixture
def calibrated(sample):
    chair = Variant(catalogue={effect: bundled()[effect] for effect in (DRAG, BIAS)})
    models, base, _, _ = Models.of(ModelFactory(sample, chair)).calibrated()
    return models, base


def test_the_order_in_which_effects_were_found_makes_no_other_hypothesis():
    assert Hypothesis.of(["a", "b"]) == Hypothesis.of(["b", "a"]) == Hypothesis.of(["a+b"])
    assert Hypothesis.of(["a"]) != Hypothesis.of(["a"], frozenset({"offset.yaw_rate"}))


def test_who_asks_again_gets_the_same_fit(calibrated):
    models, base = calibrated
    found = models.fitted((DRAG, BIAS), base.fit.values)
    assert models.fitted((BIAS, DRAG), {**base.fit.values, f"effect.{DRAG}.D": 3.0}) is found


def test_what_a_round_has_fitted_to_its_end_is_not_fitted_again(calibrated):
    models, base = calibrated
    found = candidate(models, base, screen(models, base, [DRAG])[0], 1)
    assert models.fitted((DRAG,), {}).values == found.fit.values


def test_in_another_setting_a_fit_begins_where_it_ended(calibrated):
    """From values at which the chair hardly rolls no fit leads anywhere; from where the first one ended it is there at once."""
    models, base = calibrated
    first = models.fitted((DRAG,), base.fit.values)
    setting = replace(models.setting, notes=("another one",))
    again = replace(models, setting=setting).fitted((DRAG,), {**base.fit.values, f"effect.{DRAG}.D": 300.0})
    assert again is not first
    assert again.values == pytest.approx(first.values, rel=1e-3, abs=1e-6)
