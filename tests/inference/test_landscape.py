"""The likelihood about the estimates, of the sample campaign."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from tests.kit import SAMPLE_DIAGNOSIS
from wheelchair_fmu.campaign import read, windows
from wheelchair_fmu.inference.explain.landscape import landscape
from wheelchair_fmu.inference.models.factory import ModelFactory
from wheelchair_fmu.inference.models.models import Models
from wheelchair_fmu.model.variant import Variant

ROOT = Path(__file__).parents[2]
TOLD = json.loads(SAMPLE_DIAGNOSIS.read_text())


@pytest.fixture(scope="module")
def models():
    return Models.of(ModelFactory(windows(read(ROOT / "examples" / "sample-campaign")), Variant()))


def test_a_profile_crosses_its_level_where_the_interval_ends(models):
    """The interval was found by another search, for roots; both follow one likelihood."""
    (one,) = landscape(models, TOLD)["profiles"]
    heights, lower = np.array(one["heights"]), int(np.argmin(one["heights"]))
    assert heights[lower] == pytest.approx(0, abs=0.2) and one["values"][lower] == pytest.approx(one["estimate"], abs=0.01)
    left = np.interp(-one["level"], -heights[: lower + 1], one["values"][: lower + 1])
    right = np.interp(one["level"], heights[lower:], one["values"][lower:])
    assert [left, right] == pytest.approx(TOLD["ranking"][0]["parameters"]["D"]["interval"], abs=0.004)


def test_what_was_not_found_has_no_landscape(models):
    assert landscape(models, {**TOLD, "effects": [], "models": TOLD["models"][:2]}) == {"profiles": [], "pair": None}


@pytest.mark.nightly
def test_two_rivals_have_the_contours_of_their_joint_fit(models):
    """Inside its grid the likelihood is lowest at the joint fit, and about as high as a parabola one step off."""
    pair = landscape(models, {**TOLD, "effects": TOLD["effects"]})["pair"]
    heights, about = np.array(pair["heights"], float), np.array(pair["about"])
    middle = len(about) // 2
    assert pair["effects"][0] == TOLD["effects"][0] != pair["effects"][1]
    assert np.nanmin(heights) == pytest.approx(0, abs=1e-9)
    assert heights[middle, middle] < 0.5
    across = heights[middle, [middle - 1, middle + 1]]
    assert np.mean(across) == pytest.approx(about[middle + 1] ** 2, rel=0.5)
    assert pair["share"] == pytest.approx(0.95)
    assert pair["alone_heights"][0] < pair["alone_heights"][1], "what was found does without its rival"
    tied = landscape(models, {**TOLD, "ties": [pair["effects"]]})["pair"]
    assert tied["level"] == pytest.approx(2 * np.log(100)) and tied["share"] == pytest.approx(0.99), "a hundred to one"
