"""A force that no effect describes: a spring that pulls the casters straight, which is in nobody's catalogue."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from benchmarks.independent.campaigns import make
from benchmarks.independent.hidden import usual
from tests.inference.conftest import chairs, measured
from wheelchair_fmu.campaign import read
from wheelchair_fmu.cli.main import app
from wheelchair_fmu.contracts.own import load
from wheelchair_fmu.inference.decision.diagnosis import Diagnosis
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.model.generic import library, terms

AMONG = chairs(
    "caster_trail", "caster_friction", "aerodynamic_drag", "rolling_resistance_asymmetry", "scrub_torque", "floor_cross_slope"
)


@pytest.fixture(scope="module", params=AMONG)
def told(request, tmp_path_factory) -> tuple[Diagnosis, Path]:
    """What `wheelchair diagnose` found, and the folder of what it wrote."""
    campaign, folder, found = measured("open-09-outside").path, tmp_path_factory.mktemp("outside"), []

    def kept(campaign, chair, *words, **options) -> Diagnosis:
        found.append(diagnose(campaign, request.param, *words, **options))
        return found[0]

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr("wheelchair_fmu.api.diagnosing.diagnose", kept)
        done = CliRunner().invoke(app, ["diagnose", str(campaign), "--json", str(folder / "told.json"), "-o", str(folder)])
    assert done.exit_code == 0, done.output
    return found[0], folder


def test_the_term_that_is_proposed_brings_the_error_to_the_floor(told, tmp_path):
    found, _ = told
    assert found.verdict == "outside" and found.proposal is not None
    assert found.proposal.effect == "generic_M_w_spring"
    assert found.ladder[-1].heldout < 1.05
    file = tmp_path / "caster_spring.py"
    file.write_text(terms()[found.proposal.effect].file("caster_spring"), encoding="utf-8")
    assert load(tmp_path)["caster_spring"].parameters[0].unit.name == "N.m"


def test_what_is_missing_goes_with_the_casters_angle_and_with_no_other_variable(told):
    """As `--json` says it."""
    _, folder = told
    missing = json.loads((folder / "told.json").read_text(encoding="utf-8"))["missing"]
    assert (missing["words"], missing["unit"]) == ("torque on each caster", "N.m")
    panels = {p["variable"]: p for p in missing["panels"]}
    angle = [v for v in panels["mean caster angle"]["estimate"] if v is not None]
    assert len(angle) >= 3 and angle == sorted(angle, reverse=True) and angle[0] > 0 > angle[-1]
    for p in panels.values():
        assert len(p["knots"]) == len(p["estimate"]) == len(p["se"])
        assert [v is None for v in p["estimate"]] == [s is None for s in p["se"]]
    for variable in ("speed", "push of both hands"):
        assert max(abs(v) for v in panels[variable]["estimate"] if v is not None) < 0.5 * max(map(abs, angle))
    assert (folder / "missing.png").exists()


@pytest.mark.nightly
def test_a_wobble_is_outside_though_casters_that_swing_take_it_for_errors_of_the_pushes(tmp_path):
    """With them a model leaves less than the noise, and no force leads its runs, as casters flip by chance."""
    folder = make(tmp_path / "wobble", {"steering_wobble": usual("steering_wobble", 3.0)}, seed=93)
    found = diagnose(read(folder), generic=library())
    assert found.verdict == "outside" and found.ladder[-1].heldout < 1.03
