"""docs/lab.md on its lab folder, where that lies beside the project: what the page shows is what its commands say."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from ..campaign.test_measurements import folder
from ..pages import page, shown_commands, shown_steps, told_by

PAGE = page("lab.md")
HELD = r"foretells the speeds of the wheels to ([\d.]+) and ([\d.]+) m/s and the yaw rate to ([\d.]+) °/s"
ODDS = r"^the odds: (\w+) ([\d.]+), (\w+) ([\d.]+)$"


def do(name: str, **places: str) -> None:
    """The page's first command of that name, with what the page calls `places` where it lies."""
    command = next(command for command, _ in shown_commands("lab.md") if command.split()[1] == name)
    for called, place in places.items():
        command = command.replace(f" {called} ", f" {place} ")
    told_by(command, Path(), code=0)


@pytest.mark.nightly
def test_the_page_shows_what_its_commands_say(tmp_path, monkeypatch):
    pytest.importorskip("openpyxl", reason="reading a workbook needs openpyxl")
    monkeypatch.chdir(tmp_path)
    do("import", **{"lab-02": str(folder("lab-02"))})
    campaign, at = Path("chair/campaign.toml"), re.search(r"\(`(at = \[.*?\])`\)", PAGE)
    campaign.write_text(campaign.read_text(encoding="utf-8").replace("# at = [0.0, 0.0]", at[1], 1), encoding="utf-8")
    do("diagnose")
    told = json.loads(Path("diagnosis.json").read_text(encoding="utf-8"))
    steps, (one, of_one, other, of_other) = shown_steps("lab.md"), re.search(ODDS, PAGE, re.M).groups()
    assert [name for name, *_ in steps] == [step["step"] for step in told["ladder"]]
    for (_, fitted, held), step in zip(steps, told["ladder"], strict=True):
        assert (float(fitted), float(held)) == pytest.approx((step["fit"], step["heldout"]), rel=0.02)
    left, right, yaw = (float(value) for value in re.search(HELD, PAGE).groups())
    final = told["ladder"][-1]["physical"]
    assert (final["wheel_speed_l"], final["wheel_speed_r"]) == pytest.approx((left, right), abs=0.001)
    assert final["yaw_rate"] == pytest.approx(yaw, abs=0.02)
    assert told["odds"][0] == pytest.approx({one: float(of_one), other: float(of_other)}, abs=0.05)
