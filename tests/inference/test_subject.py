"""What a campaign may name: parameters of the bundled effects and of a user's own."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from typer.testing import CliRunner

import wheelchair_fmu as wc
from wheelchair_fmu.cli.effects import template
from wheelchair_fmu.cli.main import app
from wheelchair_fmu.inference.subject import known_parameters

SAMPLE = Path(__file__).parents[2] / "examples" / "sample-campaign"


@pytest.fixture
def folder(tmp_path):
    """A campaign that gives an effect of a user's own a size, and the effect's file beside it."""
    shutil.copytree(SAMPLE, tmp_path / "campaign")
    file = tmp_path / "campaign" / "campaign.toml"
    file.write_text(file.read_text(encoding="utf-8") + "\n[effect]\nmine.q = 2.0\n", encoding="utf-8")
    (tmp_path / "effects").mkdir()
    (tmp_path / "effects" / "mine.py").write_text(template("force", "mine"), encoding="utf-8")
    return tmp_path


def wheelchair(*words):
    return CliRunner().invoke(app, list(map(str, words)))


def test_a_campaign_may_give_an_effect_of_ones_own_a_size(folder):
    done = wheelchair("check", folder / "campaign", "--effects", folder / "effects")
    assert done.exit_code == 0, done.output
    measured = wc.read(folder / "campaign", own_effects=folder / "effects")
    assert measured._record.effects == ("mine",)


def test_without_its_file_nobody_knows_it(folder):
    done = wheelchair("check", folder / "campaign")
    assert done.exit_code == 1 and "effect.mine.q" in done.output
    with pytest.raises(wc.CampaignError, match=r"effect\.mine\.q"):
        wc.read(folder / "campaign")


def test_the_bundled_effects_are_known_anyway():
    assert known_parameters()["effect.gyro_bias.b"][0] < 0
