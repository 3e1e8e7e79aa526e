"""`wheelchair check --plot`: every signal of every run is drawn, also of a campaign that has faults."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

from PIL import Image
from typer.testing import CliRunner

from tests.kit import with_settings
from wheelchair_fmu.cli.main import app

SAMPLE = Path(__file__).parents[2] / "examples" / "sample-campaign"


def check(*words: object):
    return CliRunner().invoke(app, ["check", *map(str, words)])


def test_every_signal_is_drawn(tmp_path):
    done = check(SAMPLE, "--plot", "-o", tmp_path, "--json")
    assert done.exit_code == 0
    assert json.loads(done.stdout)["errors"] == 0
    assert sorted(f.name for f in tmp_path.iterdir()) == ["preview-1.png", "preview-2.png", "preview.html"]
    with Image.open(tmp_path / "preview-1.png") as picture:
        assert picture.width > 1000
    page = (tmp_path / "preview.html").read_text(encoding="utf-8")
    assert page.count("<svg") == 2 and "http" not in page.split("<svg")[0] and "Nothing odd was found." in page


def test_what_is_odd_is_marked_and_said(tmp_path):
    campaign = tmp_path / "a <b> campaign"
    shutil.copytree(SAMPLE, campaign)
    file = campaign / "runs" / "slalom-slow.csv"
    rows = file.read_text(encoding="utf-8").splitlines()
    cells = rows[500].split(",")
    cells[rows[0].split(",").index("yaw_rate [rad/s]")] = "9.0"
    file.write_text("\n".join([*rows[:500], ",".join(cells), *rows[501:]]), encoding="utf-8")
    head, *runs = (campaign / "campaign.toml").read_text(encoding="utf-8").replace("m = 80.0", "mm = 80.0").split("[[run]]")
    few = [run for run in runs if "slalom-slow" in run or "coast-down" in run]  # each takes a second to draw
    (campaign / "campaign.toml").write_text("[[run]]".join([head, *few]), encoding="utf-8")
    done = check(campaign, "--plot", "-o", tmp_path / "out")
    assert done.exit_code == 1 and "chair.mm" in done.stdout
    page = (tmp_path / "out" / "preview.html").read_text(encoding="utf-8")
    assert "a &lt;b&gt; campaign" in page and "<b>" not in page
    assert '<li class="error">' in page and "yaw_rate reads 9 rad/s" in page


def test_clocks_are_found_also_where_a_campaign_gives_a_size_to_an_effect_of_ones_own(tmp_path):
    place = with_settings(SAMPLE, tmp_path / "campaign", {"coast-down": '{ "effect.mine.q" = 2.0 }'})
    told = CliRunner().invoke(app, ["sync", str(place), "--dry-run", "-o", str(tmp_path)])
    assert told.exit_code == 0 and "every run has one clock" in told.output


def test_the_old_spelling_of_output_still_works(tmp_path):
    campaign = tmp_path / "campaign"
    shutil.copytree(SAMPLE, campaign)
    head, *runs = (campaign / "campaign.toml").read_text(encoding="utf-8").split("[[run]]")
    (campaign / "campaign.toml").write_text("[[run]]".join([head, runs[0]]), encoding="utf-8")
    check(campaign, "--plot", "--out", tmp_path / "old")
    assert (tmp_path / "old" / "preview.html").exists()
    assert "--out " not in check("--help").stdout
