"""`wheelchair quantities`, and the page that it writes."""

from __future__ import annotations

import json
from pathlib import Path

from typer.testing import CliRunner

from wheelchair_fmu.cli.main import app

PAGE = Path(__file__).parents[2] / "docs" / "quantities.md"


def said(*words: str) -> str:
    done = CliRunner().invoke(app, words, catch_exceptions=False)
    assert done.exit_code == 0
    return done.output


def test_the_page_is_as_the_records_are(tmp_path):
    said("quantities", "--page", str(tmp_path / "page.md"))
    assert PAGE.read_text(encoding="utf-8") == (tmp_path / "page.md").read_text(encoding="utf-8"), (
        "write it again by `make docs`"
    )


def test_it_says_units_and_what_may_be_acted_on():
    told = {t["symbol"]: t for t in json.loads(said("quantities", "--json"))}
    assert told["D_r"]["unit"] == "N" and told["D_r"]["acted_on"] and told["D_r"]["components"] == "rl, rr"
    assert told["m"]["unit"] == "kg" and not told["m"]["acted_on"]
    assert said("quantities") == said("effects", "quantities")
