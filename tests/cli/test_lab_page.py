"""docs/lab.md on its lab folder, where that lies beside the project: what the page shows is what its commands say."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest
from typer.testing import CliRunner

from wheelchair_fmu.cli.main import app

from ..campaign.test_measurements import folder

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "lab.md").read_text(encoding="utf-8")
STEP = re.compile(r"^  (\w[\w ]*\w|\+\w+) +([\d.]+) +([\d.]+)$", re.M)
HELD = r"foretells the speeds of the wheels to ([\d.]+) and ([\d.]+) m/s and the yaw rate to ([\d.]+) °/s"
ODDS = r"^the odds: (\w+) ([\d.]+), (\w+) ([\d.]+)$"


def command(name: str) -> list[str]:
    """The words of the page's first command of that name, but for its own."""
    (block,) = re.findall(r"```console\n(.*?)```", PAGE, re.S)
    lines = block.replace("\\\n", " ").splitlines()
    return next(words[1:] for words in map(shlex.split, (line.lstrip("$ ") for line in lines)) if words[1] == name)


def done(words: list[str]) -> str:
    result = CliRunner().invoke(app, words)
    assert result.exit_code == 0, result.output
    return result.output


@pytest.mark.nightly
def test_the_page_shows_what_its_commands_say(tmp_path, monkeypatch):
    pytest.importorskip("openpyxl", reason="reading a workbook needs openpyxl")
    raw = str(folder("lab-02"))
    monkeypatch.chdir(tmp_path)
    done([raw if word == "lab-02" else word for word in command("import")])
    campaign, at = Path("chair/campaign.toml"), re.search(r"\(`(at = \[.*?\])`\)", PAGE)
    campaign.write_text(campaign.read_text(encoding="utf-8").replace("# at = [0.0, 0.0]", at[1], 1), encoding="utf-8")
    done(command("diagnose"))
    told = json.loads(Path("diagnosis.json").read_text(encoding="utf-8"))
    steps, (one, of_one, other, of_other) = STEP.findall(PAGE), re.search(ODDS, PAGE, re.M).groups()
    assert [name for name, *_ in steps] == [step["step"] for step in told["ladder"]]
    for (_, fitted, held), step in zip(steps, told["ladder"], strict=True):
        assert (float(fitted), float(held)) == pytest.approx((step["fit"], step["heldout"]), rel=0.02)
    left, right, yaw = (float(value) for value in re.search(HELD, PAGE).groups())
    final = told["ladder"][-1]["physical"]
    assert (final["wheel_speed_l"], final["wheel_speed_r"]) == pytest.approx((left, right), abs=0.001)
    assert final["yaw_rate"] == pytest.approx(yaw, abs=0.02)
    assert told["odds"][0] == pytest.approx({one: float(of_one), other: float(of_other)}, abs=0.05)
