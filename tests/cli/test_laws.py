"""`wheelchair laws`: what there is, and whether one's own keep what every law has to keep."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from tests.pages import BLOCK, page
from wheelchair_fmu.cli.main import app
from wheelchair_fmu.model.choice import Choice, OwnLaw
from wheelchair_fmu.model.variant import Variant, variant_text

TEXT = dict(BLOCK.findall(page("your-own-law.md")))["laws/tyre/brush.py"]


def wheelchair(*words):
    return CliRunner().invoke(app, ["laws", *map(str, words)])


@pytest.fixture
def theirs(tmp_path, monkeypatch):
    """A variant with a law of somebody's own, which is trusted."""
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "cache"))
    choice = Choice(tyre="brush", own=(OwnLaw("tyre", "brush", TEXT, "brush.py"),))
    (tmp_path / "theirs.toml").write_text(variant_text(Variant(choice)), encoding="utf-8")
    assert CliRunner().invoke(app, ["trust", str(tmp_path / "theirs.toml")]).exit_code == 0
    return tmp_path / "theirs.toml"


def test_all_laws_are_listed_with_where_they_come_from(theirs):
    told = {(law["kind"], law["name"]): law for law in json.loads(wheelchair("list", "--variant", theirs, "--json").output)}
    assert told["tyre", "brush"]["from"] == f"{theirs}/brush.py" and told["tyre", "linear"]["from"] == "the package"
    assert "caster.trail" in told["caster", "ideal"]["parameters"] and ("caster", "paper") not in told
    assert "slipping" in wheelchair("list").output


def test_a_law_that_is_named_is_held_to_the_contracts_and_so_are_all_of_one_s_own(theirs):
    assert wheelchair("check", "dugoff").output == "tyre law dugoff: keeps every contract that the bundled laws keep\n"
    assert wheelchair("check", "--variant", theirs).output.startswith("tyre law brush: keeps every contract")


def test_a_law_that_is_not_there_is_said(theirs):
    done = wheelchair("check", "brusch", "--variant", theirs)
    assert done.exit_code == 2 and "no law 'brusch'; did you mean 'brush'" in done.output
    done = wheelchair("check")
    assert done.exit_code == 2 and "there are no laws of your own here; name one" in done.output
