"""A real chair that coasts, where its recording lies beside the project: docs/real-chair.md shows what is found in it."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from typer.testing import CliRunner

from wheelchair_fmu.cli.main import app

from ..campaign.test_measurements import folder

PAGE = Path(__file__).resolve().parents[2] / "docs" / "real-chair.md"
STEP = re.compile(r"^  (\+?\w+) +([\d.]+) +([\d.]+)$", re.M)
CHANNEL = re.compile(r"^  (\w+) \[\S+\] +[\d.]+ +([\d.]+)", re.M)


@pytest.fixture(scope="module")
def told(tmp_path_factory):
    written = tmp_path_factory.mktemp("coasting") / "told.json"
    done = CliRunner().invoke(app, ["diagnose", str(folder("real/worklab")), "--json", str(written)])
    assert done.exit_code == 0, done.output
    return json.loads(written.read_text())


def test_of_two_searches_the_one_counts_that_foretells_more(told):
    """Among forces that nobody recorded, the mass, the CM and both wheels' radii made up for the drift: the right wheel was
    foretold to 0.043 m/s and the yaw rate to 3.9 °/s, which is twice as bad as without forces."""
    errors = told["ladder"][-1]["physical"]
    assert max(errors["wheel_speed_l"], errors["wheel_speed_r"]) < 0.028 and errors["yaw_rate"] < 1.7
    assert told["verdict"] == "outside"


def test_the_page_shows_what_is_found(told):
    page = PAGE.read_text(encoding="utf-8")
    steps, channels = STEP.findall(page), CHANNEL.findall(page)
    assert [name for name, *_ in steps] == [step["step"] for step in told["ladder"]] and len(channels) == 4
    for (_, fitted, held), step in zip(steps, told["ladder"], strict=True):
        assert (float(fitted), float(held)) == pytest.approx((step["fit"], step["heldout"]), rel=0.01)
    for channel, final in channels:
        assert float(final) == pytest.approx(told["ladder"][-1]["physical"][channel], rel=0.02)
