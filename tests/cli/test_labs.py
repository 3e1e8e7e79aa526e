"""Raw folders of labs, from their files to the verdict, with nothing by hand but what stands in the protocol."""

from __future__ import annotations

import json

import pytest

from tests.campaign.test_measurements import MEASUREMENTS
from wheelchair_fmu.campaign import read
from wheelchair_fmu.loop.verdict import diagnose

from .test_import import GIVEN, imported, measured

AT = {"lab-00": None, "lab-02": "[-0.22, 0.0]"}  # where the inertial sensor sits
WITHIN = 1.25  # times the best that a simulation reaches which knows what was hidden


@pytest.fixture(scope="module", params=AT)
def found(request, tmp_path_factory):
    """A lab's name, and its diagnosis."""
    if request.param == "lab-02":
        pytest.importorskip("openpyxl", reason="reading a workbook needs openpyxl")
    mass, radius, track, wheelbase, b, t_f = GIVEN[request.param]
    out = tmp_path_factory.mktemp("lab") / request.param
    answers = json.loads((MEASUREMENTS / "lab-answers.json").read_text())[request.param]["runs"]
    kept = [word for run, told in answers.items() if told["role"] == "holdout" for word in ("--holdout", run)]
    done = imported(measured(request.param), "-o", out, "--mass", mass, "--radius", radius, "--track", track, *kept)
    assert done.exit_code == 0, done.output
    text = (out / "campaign.toml").read_text(encoding="utf-8")
    for key, value in (("a = ", wheelbase - b), ("b = ", b), ("t_f = ", t_f)):
        text = text.replace(f"# {key}", f"{key}{value:.3f} #", 1)
    if AT[request.param]:
        text = text.replace("# at = [0.0, 0.0]", f"at = {AT[request.param]} #", 1)
    (out / "campaign.toml").write_text(text, encoding="utf-8")
    return request.param, diagnose(read(out))


@pytest.mark.nightly
def test_wheels_are_foretold_about_as_well_as_can_be(found):
    lab, diagnosis = found
    floors = json.loads((MEASUREMENTS / "lab-answers.json").read_text())[lab]["floor_of_the_held_out_runs"].values()
    reached = max(floor["true_rider"]["hub_speed_rms"] for floor in floors)
    told = diagnosis.ladder[-1].physical
    assert max(told[f"wheel_speed_{side}"]["heldout_rms"] for side in "lr") < WITHIN * reached


@pytest.mark.nightly
def test_what_drags_is_named_and_what_is_left_is_the_body(found):
    lab, diagnosis = found
    named = {*diagnosis.effects, *(effect for group in diagnosis.ties for effect in group)}
    ordered = {order.by for order in diagnosis.unexplained.orders}
    if lab == "lab-02":
        assert "rolling_resistance_asymmetry" in named and ordered == {"stroke"}
    else:
        assert not ordered, "the body was measured, and an uneven floor is nobody's effect"
        assert diagnosis.unexplained.after.moment < 1.0
