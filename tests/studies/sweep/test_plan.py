"""A plan: what it means, and every fault of it at once."""

from __future__ import annotations

import pytest

from wheelchair_fmu.studies.sweep import PlanError, read_plan

GOOD = """
[sweep]
method = "grid"

[parameters]
"chair.m" = [60, 80, 100]
tyre = { C_lambda = { from = 2500, to = 10000, steps = 3, log = true }, law = ["dugoff", "linear"] }

[[manoeuvre]]
name = "slalom"
delta_force = [5, 10]
period = [3, 4]
"""


def plan_of(tmp_path, text):
    (tmp_path / "plan.toml").write_text(text, encoding="utf-8")
    return read_plan(tmp_path / "plan.toml")


def test_a_plan_is_a_product(tmp_path):
    plan = plan_of(tmp_path, GOOD)
    assert plan.design.chairs == 18 and plan.cases == 4 and plan.runs == 72
    assert [axis.name for axis in plan.design.axes] == ["chair.m", "tyre.C_lambda", "tyre.law"]
    assert plan.courses[1].label == "slalom delta_force=5 period=4"
    assert plan.courses[1].manoeuvre().inputs["push.F_rl"][0] == 5
    assert plan.design.axes[1].levels == pytest.approx([2500, 5000, 10000])
    assert plan.design.axes[2].shown(plan.design.axes[2].levels) == ["dugoff", "linear"]


def test_an_effect_that_is_named_is_on_in_every_variant(tmp_path):
    (tmp_path / "v.toml").write_text('[laws]\ntyre = "dugoff"\n[values]\n"chair.m" = 90\n')
    plan = plan_of(
        tmp_path,
        """
[parameters]
"effect.relaxation_length.sigma" = [0, 0.1]
[[manoeuvre]]
name = "spin"
[[variant]]
file = "v.toml"
""",
    )
    (chair,) = plan.chairs
    assert chair.label == "v" and chair.effects == ("relaxation_length",) and chair.variant().choice.tyre == "dugoff"


def test_all_faults_come_together_with_line_and_cure(tmp_path):
    with pytest.raises(PlanError) as refused:
        plan_of(
            tmp_path,
            """[sweep]
method = "sobol"
samples = 1000
sed = 1
campaign = "nowhere"
[parameters]
"tyre.C_lamda" = { from = 2500, to = 10000 }
"chair.m" = { from = 60, to = -100 }
chair.b = 3
"chair.a" = { from = 0.1, to = 0.2, steps = 3 }
"tyre.law" = ["linear", "magic"]
"chair.t_r" = { from = 0.6, to = 0.5 }
"chair.t_f" = { from = 0.4, till = 0.5 }
"effect.push_force_delay.tau" = { from = 0.0, to = 0.1 }
g = [nan]
[[manoeuvre]]
name = "steady-trun"
[[manoeuvre]]
name = "slalom"
perod = 3
speed = "fast"
[[manoeuvre]]
name = "spin"
delta_force = 9000
[[manoeuvre]]
name = "coast-down"
[[manoeuvre]]
name = "coast-down"
[[variant]]
name = "better"
[[variant]]
file = "none.toml"
[extra]
""",
        )
    said = {fault.line: str(fault) for fault in refused.value.faults}
    for line, words in {
        3: "samples = 1000 is no power of two, and Sobol' points are even only then; give 512 or 1024",
        4: "no 'sed'; did you mean 'seed'?",
        5: "no such folder",
        7: "did you mean 'tyre.C_lambda'",
        8: "chair.m = -100 is outside its bounds 1 to 1000 kg",
        9: "chair.b: 3 is neither a list nor a range; write [3]",
        10: "steps mean nothing for sobol",
        11: "tyre.law = magic; choose one of linear",
        12: "the range goes from 0.6 to 0.5; let it rise",
        13: "a range has no 'till'",
        14: "shifts recorded pushes",
        15: "g = nan is outside its bounds",
        17: "no manoeuvre 'steady-trun'; did you mean 'steady-turn'?",
        20: "slalom has no 'perod'; did you mean 'period'",
        21: "speed = 'fast' is no number",
        22: "delta_force 9000 N is outside ±2000 N",
        27: "manoeuvre 'coast-down' comes twice",
        29: "the variant has no file",
        32: "none.toml: no such file",
        33: "no table 'extra'",
    }.items():
        assert words in said.get(line, ""), (line, words, said)
    assert len(refused.value.faults) == 20


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[sweep", "line 1: not valid TOML"),
        ("[sweep]\n", "there is nothing to run"),
        ('[sweep]\nmethod = "morris"\nsamples = 4\n[[manoeuvre]]\nname = "spin"\n', "morris needs parameters to vary"),
        ('[sweep]\nmethod = "morris"\nsamples = 4\n[parameters]\n"chair.m" = [60, 80]\n', "sensitivity indices need a range"),
        (
            '[sweep]\nmethod = "random"\n[parameters]\n"chair.m" = [60, 80]\n',
            "samples is missing; write for example samples = 64",
        ),
        ('[sweep]\nmethod = "sobel"\n', "line 2: no method 'sobel'; did you mean 'sobol'?"),
        ('[parameters]\n"chair.m" = { from = 60, to = 80 }\n', "a grid needs steps"),
        ('[parameters]\n"tyre.law" = { from = 1, to = 3 }\n', "named choices have no range"),
        ('[parameters]\n"chair.m" = []\n', "is no list of values"),
        ('manoeuvre = "spin"\n', "write [[manoeuvre]] on a line of its own"),
    ],
)
def test_what_cannot_be_is_refused(tmp_path, text, words):
    with pytest.raises(PlanError) as refused:
        plan_of(tmp_path, text)
    assert words in str(refused.value)


def test_a_plan_that_is_not_there_or_no_text(tmp_path):
    with pytest.raises(PlanError, match="no such file"):
        read_plan(tmp_path / "none.toml")
    (tmp_path / "b.toml").write_bytes(b"\xff\xfe[")
    with pytest.raises(PlanError, match="not UTF-8"):
        read_plan(tmp_path / "b.toml")
