"""`wheelchair trust`, the question on a terminal, and commands with a variant that carries an effect."""

from __future__ import annotations

import io
import json

import pytest
from typer.testing import CliRunner

from wheelchair_fmu.cli.effects import template
from wheelchair_fmu.cli.main import app
from wheelchair_fmu.contracts.own import untrusted
from wheelchair_fmu.model.effects import bundled, defined
from wheelchair_fmu.model.variant import Variant, variant_text

ASKED = "carries the effect mine, a program that runs with your rights; "


class Typed(io.StringIO):
    """What a person at a terminal types."""

    def isatty(self) -> bool:
        return True


@pytest.fixture
def theirs(tmp_path, monkeypatch):
    """A variant from elsewhere that carries an effect."""
    monkeypatch.setenv("WHEELCHAIR_CACHE", str(tmp_path / "cache"))
    known = {**bundled(), **defined((("mine.py", template("force", "mine")),))}
    chair = Variant(catalogue=known).with_values({"effect.mine.q": 2.0})
    (tmp_path / "theirs.toml").write_text(variant_text(chair), encoding="utf-8")
    return tmp_path / "theirs.toml"


def wheelchair(*words):
    return CliRunner().invoke(app, list(map(str, words)))


COMMANDS = {
    "build": ("-o", "out.fmu"),
    "simulate": ("coast-down",),
    "linearize": (),
    "steady": (),
    "compare": ("campaign",),
    "diagnose": ("campaign",),
    "add": ("gyro_bias", "campaign", "-o", "more.toml"),
    "improve": ("campaign", "-o", "more.toml"),
    "report": ("campaign",),
    "export": ("campaign", "-o", "problem"),
    "fleet": ("campaign", "-o", "fleet.csv"),
    "ssp build": (),
    "effects list": (),
    "effects show": ("mine",),
}


@pytest.mark.parametrize("command", COMMANDS)
def test_no_command_runs_what_nobody_trusts(theirs, command, monkeypatch):
    monkeypatch.chdir(theirs.parent)
    done = wheelchair(*command.split(), *COMMANDS[command], "--variant", theirs.name)
    assert (done.exit_code, ASKED in done.output) == (1, True), done.output


def test_nor_does_a_plan_or_a_parameter_set(theirs):
    plan = theirs.parent / "plan.toml"
    plan.write_text('[[variant]]\nfile = "theirs.toml"\n[[manoeuvre]]\nname = "spin"\n', encoding="utf-8")
    assert ASKED in wheelchair("sweep", plan, "-o", plan.with_suffix(".parquet")).output
    assert ASKED in wheelchair("ssp", "parameters", theirs, "-o", theirs.with_suffix(".ssv")).output


def test_a_person_who_sweeps_is_asked_about_each_variant_of_the_plan(theirs, monkeypatch):
    plan, seen = theirs.parent / "plan.toml", []
    twice = '[[variant]]\nfile = "theirs.toml"\n' * 2 + '[[variant]]\nname = "no file"\n'
    plan.write_text(f'{twice}[[manoeuvre]]\nname = "spin"\n', encoding="utf-8")
    monkeypatch.setattr("wheelchair_fmu.cli.sweep.asked", seen.append)
    assert ASKED in wheelchair("sweep", plan, "-o", plan.with_suffix(".parquet")).output
    assert seen == [theirs]
    plan.write_text("[[variant]\n", encoding="utf-8")
    assert wheelchair("sweep", plan, "-o", plan.with_suffix(".parquet")).exit_code == 1 and seen == [theirs]


def test_once_trusted_a_variant_needs_no_further_option(theirs):
    done = wheelchair("trust", theirs)
    assert done.exit_code == 0 and done.output.startswith("effect mine is trusted (sha256 ")
    assert wheelchair("ssp", "parameters", theirs, "-o", theirs.with_suffix(".ssv")).exit_code == 0
    assert 'name="effect.mine.q"' in theirs.with_suffix(".ssv").read_text(encoding="utf-8")
    shown = json.loads(wheelchair("effects", "show", "mine", "--variant", theirs, "--json").output)
    assert shown["own"] and not shown["in_default_fmu"]
    assert "(your own)" in wheelchair("effects", "list", "--variant", theirs).output


def test_a_plan_may_vary_what_all_its_variants_carry(theirs):
    wheelchair("trust", theirs)
    plan = theirs.parent / "plan.toml"
    varied = '[parameters]\n"effect.mine.q" = [0.0, 2.0]\n'
    plan.write_text(f'{varied}[[variant]]\nfile = "theirs.toml"\n[[manoeuvre]]\nname = "spin"\n', encoding="utf-8")
    from wheelchair_fmu.studies.sweep import read_plan

    planned = read_plan(plan)
    assert planned.chairs[0].variant().effects == ("mine",) and planned.runs == 2


def test_there_must_be_something_to_trust(tmp_path):
    (tmp_path / "plain.toml").write_text("", encoding="utf-8")
    assert "carries no effects or laws of anybody's own" in wheelchair("trust", tmp_path / "plain.toml").output
    assert "no such file" in wheelchair("trust", tmp_path / "none.toml").output


@pytest.mark.parametrize(("typed", "trusted"), [("y\n", True), ("n\n", False), ("\n", False)])
def test_a_person_at_a_terminal_is_asked(theirs, monkeypatch, capsys, typed, trusted):
    from wheelchair_fmu.cli.trust import asked

    monkeypatch.setattr("sys.stdin", Typed(typed))
    monkeypatch.setattr("sys.stderr", told := Typed())
    assert asked(theirs) == theirs
    assert ASKED in told.getvalue() and (untrusted(theirs) == {}) == trusted


def test_a_variant_without_programs_asks_nothing(tmp_path, monkeypatch):
    from wheelchair_fmu.cli.trust import asked

    (tmp_path / "plain.toml").write_text("", encoding="utf-8")
    monkeypatch.setattr("sys.stdin", Typed("n\n"))
    monkeypatch.setattr("sys.stderr", told := Typed())
    assert asked(tmp_path / "plain.toml") and asked(tmp_path / "none.toml") and told.getvalue() == ""
