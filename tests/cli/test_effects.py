"""wheelchair effects, as a user types it."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from wheelchair_fmu.cli.diagnose import LIKELIEST, _ranking
from wheelchair_fmu.cli.effects import KINDS
from wheelchair_fmu.cli.main import app
from wheelchair_fmu.model.effects import bundled


def run(*words: object):
    return CliRunner().invoke(app, [str(w) for w in words], catch_exceptions=False)


@pytest.mark.parametrize("kind", KINDS)
def test_new_writes_an_effect_that_show_finds_good_and_says_what_to_do_next(tmp_path, kind):
    folder = tmp_path / "my effects"
    done = run("effects", "new", "my_own", "-o", folder, "--kind", kind)
    file, _, *following = done.stdout.splitlines()
    assert file == str(folder / "my_own.py")
    assert [line.split()[1] for line in following] == ["effects", "diagnose", "add"]
    assert all(f"--effects '{folder}'" in line for line in following)
    shown = run("effects", "show", "my_own", "--effects", folder)
    assert shown.exit_code == 0, shown.output
    assert (
        "your own; it keeps every contract" in shown.stdout
        and f"effect.my_own.{'load' if kind == 'body' else 'q'} [" in shown.stdout
    )
    assert "my_own" in run("effects", "list", "--effects", folder).stdout


def test_a_spoilt_effect_is_refused_wherever_it_would_be_used(tmp_path):
    assert run("effects", "new", "my_own", "-o", tmp_path).exit_code == 0
    file = tmp_path / "my_own.py"
    file.write_text(file.read_text(encoding="utf-8").replace("N_S_M", "N"), encoding="utf-8")
    for words in (
        ("effects", "list"),
        ("effects", "show", "my_own"),
        ("diagnose", "examples/sample-campaign"),
        ("add", "my_own", "examples/sample-campaign", "-o", tmp_path / "x.toml"),
        ("improve", "examples/sample-campaign", "-o", tmp_path / "x.toml"),
        ("simulate", "coast-down"),
        ("linearize", "--radius", "2"),
        ("sweep", "examples/sweep.toml", "-o", tmp_path / "x.parquet"),
        ("report", "examples/sample-campaign", "-o", tmp_path / "x.html"),
        ("fleet", "examples", "-o", tmp_path / "x.csv"),
    ):
        done = run(*words, "--effects", tmp_path)
        assert done.exit_code == 1, words
        assert done.stderr == (
            "effect my_own, units: its term in F_x comes out in W where N belongs; "
            "give q the unit N.s/m instead of N, or change the law\n"
        )


def test_a_misspelt_effect_of_ones_own_is_suggested(tmp_path):
    assert run("effects", "new", "my_own", "-o", tmp_path).exit_code == 0
    wrong = run("effects", "show", "my_onw", "--effects", tmp_path)
    assert wrong.exit_code == 2 and "did you mean 'my_own'?" in wrong.stderr
    assert "no kind of effect 'froce'; did you mean 'force'?" in run("effects", "new", "a", "--kind", "froce").stderr


def test_parameters_have_one_name_everywhere():
    """The last part of the name in the FMU, whatever a law calls them."""
    shown = {e["id"]: [p["name"] for p in e["parameters"]] for e in json.loads(run("effects", "list", "--json").stdout)}
    listed = {line.split()[0]: line for line in run("effects", "list").stdout.splitlines() if line.strip()}
    for id, effect in bundled().items():
        assert [f"effect.{id}.{p.name}" for p in effect.parameters] == shown[id][: len(effect.parameters)]
        assert f" {effect.parameters[0].name} " in listed[id]


def test_quantities_are_what_a_law_may_name():
    told = {q["symbol"]: q for q in json.loads(run("effects", "quantities", "--json").stdout)}
    assert told["F_x"]["acted_on"] and told["F_x"]["unit"] == "N"
    assert not told["u"]["acted_on"] and told["u"]["needs"] == {}
    assert told["swivel_rate"]["needs"] == {"caster": "swivelling"}
    assert 'needs={"caster": "swivelling"}' in run("effects", "quantities").stdout


def test_ones_own_effects_are_in_the_ranking_however_unlikely():
    parameter = {"q": {"estimate": 1.0, "se": 0.5, "unit": "N", "smallest_interesting": 1.0}}
    rows = [
        {
            "effect": f"e{i}",
            "p": 10.0**-i,
            "power": 0.5,
            "probability": None,
            "lr": 3.0,
            "verdict": "not needed",
            "parameters": parameter,
        }
        for i in range(20)
    ]
    rows[0] |= {"p": 0.0, "verdict": "cannot_see", "probability": 0.987}
    rows[1] |= {"p": 0.9, "verdict": "cannot_see"}
    rows[3] |= {"one_form_of": "the motion of the rider's body"}
    columns = [list(c.cells) for c in _ranking({"ranking": rows}, {"e3", "e17"}).columns]
    assert columns[0] == [f"e{i}" for i in range(LIKELIEST)] + ["e17"]
    assert columns[4][:2] == ["0.99", ""]
    assert columns[7][:4] == ["not chosen", "cannot see", "not needed", "not needed in this form"]
