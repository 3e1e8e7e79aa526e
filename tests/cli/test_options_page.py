"""docs/options.md says what `--help` says."""

from __future__ import annotations

from pathlib import Path

from typer.testing import CliRunner

from wheelchair_fmu.cli.main import COMMANDS, app
from wheelchair_fmu.cli.options_page import page

PAGE = Path(__file__).parents[2] / "docs" / "options.md"


def test_the_page_is_as_the_commands_are():
    assert PAGE.read_text(encoding="utf-8") == page(), "write it again by `make docs`"


def test_it_has_every_command_and_what_its_help_has():
    text = page()
    assert [name for name in COMMANDS if f"## wheelchair {name}" not in text] == []
    told = CliRunner().invoke(app, ["simulate", "--help"]).output
    options = {word for word in told.split() if word.startswith("--")} - {"--help"}
    section = text.partition("## wheelchair simulate\n")[2].partition("\n## ")[0]
    assert len(options) > 6 and all(f"{option}" in section for option in options)
