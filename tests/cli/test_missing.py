"""What `diagnose --json` says of a force that no effect describes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from wheelchair_fmu.cli.main import app

CAMPAIGN = Path(__file__).resolve().parents[3] / "shared" / "measurements" / "open-09-outside"


@pytest.mark.skipif(not CAMPAIGN.exists(), reason="no measurements beside the project")
def test_what_is_missing_goes_with_the_casters_angle_and_with_no_other_variable(tmp_path):
    """The truth has a torque that pulls the casters straight."""
    file = tmp_path / "diagnosis.json"
    done = CliRunner().invoke(app, ["diagnose", str(CAMPAIGN), "--json", str(file), "-o", str(tmp_path)])
    assert done.exit_code == 0, done.output
    missing = json.loads(file.read_text())["missing"]
    assert (missing["words"], missing["unit"]) == ("torque on each caster", "N.m")
    panels = {p["variable"]: p for p in missing["panels"]}
    angle = [v for v in panels["mean caster angle"]["estimate"] if v is not None]
    assert len(angle) >= 3 and angle == sorted(angle, reverse=True) and angle[0] > 0 > angle[-1]
    for p in panels.values():
        assert len(p["knots"]) == len(p["estimate"]) == len(p["se"])
        assert [v is None for v in p["estimate"]] == [s is None for s in p["se"]]
    for variable in ("speed", "push of both hands"):
        assert max(abs(v) for v in panels[variable]["estimate"] if v is not None) < 0.5 * max(map(abs, angle))
    assert (tmp_path / "missing.png").exists()
