"""A real chair that coasts, where its recording lies beside the project: docs/real-chair.md shows what is found in it."""

from __future__ import annotations

import json
from contextlib import chdir

import pytest

from ..campaign.test_measurements import folder
from ..pages import agrees, shown_commands, shown_steps, told_by

PAGE = "real-chair.md"
((COMMAND, SHOWN),) = (pair for pair in shown_commands(PAGE) if " diagnose " in pair[0])


@pytest.fixture(scope="module")
def printed_and_told(tmp_path_factory):
    place, written = folder("real/worklab").parent, tmp_path_factory.mktemp("coasting") / "told.json"
    with chdir(place):
        printed = told_by(f"{COMMAND} --json {written}", place, code=0)
    return printed, json.loads(written.read_text(encoding="utf-8"))


def test_of_two_searches_the_one_counts_that_foretells_more(printed_and_told):
    """Among forces that nobody recorded, the mass, the CM and both wheels' radii made up for the drift: the right wheel was
    foretold to 0.043 m/s and the yaw rate to 3.9 °/s, which is twice as bad as without forces."""
    _, told = printed_and_told
    errors = told["ladder"][-1]["physical"]
    assert max(errors["wheel_speed_l"], errors["wheel_speed_r"]) < 0.028 and errors["yaw_rate"] < 1.7
    assert told["verdict"] == "outside"


def test_the_page_shows_what_is_found(printed_and_told):
    printed, told = printed_and_told
    assert [name for name, *_ in shown_steps(PAGE)] == [step["step"] for step in told["ladder"]]
    assert agrees(SHOWN, printed) == []
