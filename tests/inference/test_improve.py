"""Adding goes on; what is proposed can be added; an experiment that was proposed breaks the tie."""

from __future__ import annotations

import json
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from benchmarks.independent.campaigns import make
from benchmarks.independent.hidden import usual
from benchmarks.independent.manoeuvres import STRAIGHT, Run, coast
from tests.inference.conftest import among, measured
from wheelchair_fmu.campaign import read
from wheelchair_fmu.cli.main import app
from wheelchair_fmu.contracts.own import load
from wheelchair_fmu.handling.experiments import experiments
from wheelchair_fmu.inference.decision.improve import add
from wheelchair_fmu.inference.decision.verdict import diagnose
from wheelchair_fmu.inference.estimation.statistics import standard_errors
from wheelchair_fmu.inference.models.factory import MEASURED
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant, read_variant

FAST = Run("fast-coast", "coast-down", "fit", 2.5, 14.0, coast(0.0, 1.0))


def run(*words: object):
    return CliRunner().invoke(app, [str(w) for w in words], catch_exceptions=False)


def test_improve_finds_adds_and_then_finds_nothing(tmp_path):
    short = [replace(run, duration=6.0) for run in STRAIGHT]
    folder = make(tmp_path / "drag", {"aerodynamic_drag": {"k": 0.8}}, manoeuvres=[*short, FAST], seed=21)
    better = tmp_path / "better.toml"
    done = run("improve", folder, "-o", better, "--json", tmp_path / "last.json")
    assert done.exit_code == 0, done.output
    last = json.loads((tmp_path / "last.json").read_text())
    assert "aerodynamic_drag" in last["effects"]
    assert last["ladder"][1]["heldout"] > last["ladder"][-1]["heldout"]
    chair = read_variant(better)
    assert 0.5 < chair.values["effect.aerodynamic_drag.k"] < 1.1
    again = diagnose(read(folder), chair)
    assert again.already == ("aerodynamic_drag",) and again.effects == ()
    assert again.verdict in ("adequate", "cannot_see", "small")


@pytest.mark.nightly
def test_an_effect_that_nobody_needs_can_be_added_and_gains_nothing(sample):
    """Toe, which a screen looks at by sizes: none promises anything once the drag of the left wheel is in."""
    dragging = add(sample, Variant(), ["rolling_resistance_asymmetry"])
    toed = add(sample, dragging.variant, ["toe_misalignment"])
    assert [step.name for step in toed.ladder[2:]] == ["+rolling_resistance_asymmetry", "+toe_misalignment"]
    both = add(sample, Variant(), ["rolling_resistance_asymmetry", "toe_misalignment"])
    assert [step.name for step in both.ladder] == [step.name for step in toed.ladder]
    assert both.variant.effects == toed.variant.effects
    assert abs(both.ladder[-1].heldout - toed.ladder[-1].heldout) < 0.01
    assert abs(toed.ladder[-1].heldout - dragging.ladder[-1].heldout) < 0.01
    toe = "effect.toe_misalignment.sum"
    assert abs(toed.fit.values[toe]) < 3 * standard_errors(toed.fit)[toe]


@among("aerodynamic_drag", "rolling_resistance_speed", "longitudinal_slip", "wheel_inertia")
def test_the_proposed_runs_break_the_tie(tmp_path, chair):
    """Two drags look alike at low speed; coast-downs from 2.5 m/s, made by another author's chair, decide. The mass is known
    exactly, as with noise four times as large an uncertain one leaves more than two in the tie."""
    hidden = {"aerodynamic_drag": usual("aerodynamic_drag", 1.2)}
    noisy = {"noise_scale": 4.0, "seed": 7}
    tied = diagnose(
        read(make(tmp_path / "one", hidden, manoeuvres="straight", **noisy)), chair, experiments=experiments(), fixed=MEASURED
    )
    assert tied.verdict == "tie" and tied.next_experiment is not None
    assert set(tied.effects) == {"aerodynamic_drag", "rolling_resistance_speed"} == set(tied.next_experiment["separates"])
    assert tied.next_experiment["manoeuvre"] == "a coast-down from 2.5 m/s"
    more = [replace(FAST, name=f"fast-{i}") for i in range(tied.next_experiment["repeats"])]
    decided = diagnose(read(make(tmp_path / "two", hidden, manoeuvres=[*STRAIGHT, *more], **noisy)), chair, fixed=MEASURED)
    assert decided.verdict == "missing" and decided.ties == ()
    assert decided.rounds[0].candidates[0].effect == "aerodynamic_drag"


@pytest.mark.nightly
def test_improve_adds_the_term_it_proposes(tmp_path):
    """Its law is about that of the hidden springs; of what it leaves, casters that trail may take up a part."""
    campaign = measured("open-09-outside")
    better = tmp_path / "better.toml"
    done = run("improve", campaign.path if campaign.path.is_dir() else campaign.path.parent, "-o", better)
    assert done.exit_code == 0, done.output
    chair = read_variant(better, {**bundled(), **load(tmp_path / "better-effects")})
    assert chair.effects[0] == "proposed_m_w_spring" and set(chair.effects[1:]) <= {"caster_trail"}
    assert "nothing more is missing" in done.stdout or "Nothing was found" in done.stdout
