"""The command line: what it writes and prints, and how it ends."""

from __future__ import annotations

import csv
import json
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from typer.testing import CliRunner

from wheelchair_fmu import __version__
from wheelchair_fmu.cli.main import COMMANDS, app
from wheelchair_fmu.model.effects import bundled
from wheelchair_fmu.model.variant import Variant, variant_text
from wheelchair_fmu.quantities import Parameter
from wheelchair_fmu.studies import Fmu, fmu_of
from wheelchair_fmu.writing import written

ROOT = Path(__file__).parents[2]
SAMPLE = ROOT / "examples" / "sample-campaign"


def wheelchair(*words: object):
    return CliRunner().invoke(app, [str(word) for word in words])


def rows_of(file: Path) -> list[dict[str, float]]:
    with file.open(newline="", encoding="utf-8") as text:
        return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(text)]


def test_simulate_writes_a_table_and_figures_and_prints_the_papers_numbers(tmp_path):
    done = wheelchair("simulate", "steady-turn", "--speed", 1, "--delta-force", 10, "-o", tmp_path)
    assert done.exit_code == 0, done.output
    assert sorted(f.name for f in tmp_path.iterdir()) == [f"steady-turn.{e}" for e in ("csv", "png", "svg")]
    assert all(str(tmp_path / f"steady-turn.{e}") in done.output for e in ("csv", "png", "svg"))
    rows = rows_of(tmp_path / "steady-turn.csv")
    last = rows[-1]
    assert len(rows) == 1001 and last["time [s]"] == 10.0 and last["push.F_rl [N]"] == 10.0
    with Fmu(fmu_of(Variant())) as fmu:
        assert {key.partition(" [")[0] for key in last} >= set(fmu.outputs)
    assert 1 / last["chair.curvature [1/m]"] == pytest.approx(3.302, abs=2e-3)  # the paper's equations give 3.30 m
    assert "3.3019" in done.output and "push needed [N]" in done.output
    assert (tmp_path / "steady-turn.svg").read_bytes().startswith(b"<?xml")


def test_former_names_are_read_with_one_note(tmp_path):
    """On top of a file that has them too: one side is changed, the other stays."""
    old, today = tmp_path / "old.toml", "effect.camber_misalignment"
    old.write_text(f'[values]\n"{today}.phi_r" = 0.01\n"{today}.phi_l" = 0.02\n', encoding="utf-8")
    by_old = wheelchair("simulate", "slalom", "--variant", old, "--set", f"{today}.phi_r=0.03", "-o", tmp_path)
    was = rows_of(tmp_path / "slalom.csv")[-1]
    by_new = wheelchair("simulate", "slalom", "--set", f"{today}.sum=0.05", "--set", f"{today}.difference=0.01", "-o", tmp_path)
    assert by_old.exit_code == by_new.exit_code == 0
    assert rows_of(tmp_path / "slalom.csv")[-1] == was
    notes = [line for line in by_old.stderr.splitlines() if line.startswith("note: ")]
    assert notes == [
        f"note: {today}.phi_r and {today}.phi_l: former names, "
        f"read as {today}.sum = 0.03 rad and {today}.difference = -0.01 rad",
        f"note: {today}.phi_r: former name, read as {today}.sum = 0.05 rad and {today}.difference = 0.01 rad",
    ]
    assert "note: " not in by_new.stderr
    both = wheelchair("simulate", "slalom", "--set", f"{today}.phi_r=0.03", "--set", f"{today}.sum=0.05")
    assert both.exit_code == 2 and len(both.stderr.splitlines()) == 1 and "both are given" in both.stderr


def test_set_reaches_the_fmu_and_more_cornering_stiffness_tightens_the_turn(tmp_path):
    radius = {}
    for stiffness in (2519, 10076):
        done = wheelchair("simulate", "steady-turn", "--set", f"tyre.C_lambda={stiffness}", "-o", tmp_path)
        assert done.exit_code == 0, done.output
        radius[stiffness] = 1 / rows_of(tmp_path / "steady-turn.csv")[-1]["chair.curvature [1/m]"]
    assert radius[10076] < radius[2519]
    assert radius[2519] / radius[10076] < 1.08


@pytest.mark.nightly
def test_an_effect_with_a_state_is_built_in_when_set_names_it(tmp_path):
    done = wheelchair("simulate", "slalom", "--time", 1, "--set", "effect.relaxation_length.sigma=0.2", "-o", tmp_path)
    assert done.exit_code == 0, done.output
    assert "effect.relaxation_length.lagged_slip.rl [rad]" in rows_of(tmp_path / "slalom.csv")[0]


def test_a_variant_gives_its_values(tmp_path):
    (tmp_path / "v.toml").write_text(variant_text(Variant().with_values({"chair.m": 160.0})))
    for words in ((), ("--variant", tmp_path / "v.toml")):
        assert wheelchair("simulate", "steady-turn", *words, "--time", 2, "-o", tmp_path / str(len(words))).exit_code == 0
    light, heavy = (rows_of(tmp_path / n / "steady-turn.csv")[-1]["load.rl [N]"] for n in ("0", "2"))
    assert heavy == pytest.approx(2 * light)


def test_a_finished_fmu_is_driven_as_it_is(tmp_path):
    path = fmu_of(Variant(), "none")
    done = wheelchair("simulate", "coast-down", "--fmu", path, "--time", 1, "-o", tmp_path)
    assert done.exit_code == 0 and (tmp_path / "coast-down.csv").exists()
    done = wheelchair("simulate", "coast-down", "--fmu", path, "--effects", "all", "-o", tmp_path)
    assert done.exit_code == 2 and "leave out" in done.stderr


def test_leaving_the_models_range_is_said_on_stderr(tmp_path):
    done = wheelchair("simulate", "spin", "--delta-force", 400, "--time", 2, "-o", tmp_path)
    assert done.exit_code == 0 and "warning: " in done.stderr


@pytest.mark.parametrize(
    ("words", "code", "sentence"),
    [
        (["stedy-turn"], 2, "no manoeuvre 'stedy-turn'; did you mean 'steady-turn'?"),
        (["slalom", "--set", "nonsense"], 2, "--set 'nonsense' is not NAME=VALUE; write for example --set chair.m=90"),
        (["slalom", "--set", "chair.m="], 2, "--set 'chair.m=' is not NAME=VALUE"),
        (["slalom", "--set", "chair.m=-1"], 2, "chair.m = -1 is outside its bounds 1 to 1000 kg; give a value between them"),
        (["slalom", "--set", "chair.m=nan"], 2, "chair.m = nan is outside its bounds"),
        (["slalom", "--set", "chair.m=heavy"], 2, "chair.m = 'heavy' is not a number; give a number in kg"),
        (["slalom", "--set", "chair.mm=1"], 2, "no parameter 'chair.mm'; did you mean 'chair.m'"),
        (["slalom", "--set", "effect.relaxation.sigma=1"], 2, "no effect 'relaxation'; did you mean 'relaxation_length'"),
        (["slalom", "--set", "effect.push_force_delay.tau=0.1"], 2, "shifts recorded pushes in time and is no part of an FMU"),
        (["slalom", "--set", "tyre.law=magic"], 2, "choose one of linear, dugoff, magic_formula"),
        (["slalom", "--speed", "nan"], 2, "--speed nan m/s is impossible here; give a number above 0, at most 20 m/s"),
        (["slalom", "--speed", "fast"], 2, "--speed"),
        (["slalom", "--effects", "relaxation"], 2, "no effect 'relaxation'; did you mean 'relaxation_length'"),
        (["slalom", "--equations", "papr"], 2, "did you mean 'paper'?"),
        (["slalom", "--variant", "none.toml"], 1, "none.toml: no such file"),
        (["slalom", "--fmu", "none.fmu"], 1, "none.fmu: no such file; build one with `wheelchair build`"),
        (["start-stop", "--equations", "paper", "--effects", "none"], 1, "the equations give NaN or infinity"),
        (["slalom", "--varient", "x.toml"], 2, "no option --varient; did you mean --variant?"),
        (["slalom", "--colour", "red"], 2, "slalom has no --colour; it takes --speed, --delta-force, --period, --time"),
    ],
)
def test_bad_input_gets_one_sentence_and_writes_nothing(tmp_path, words, code, sentence):
    done = wheelchair("simulate", *words, "-o", tmp_path / "out")
    assert done.exit_code == code and sentence in done.stderr
    assert "Traceback" not in done.output and not (tmp_path / "out").exists()


def test_an_output_folder_that_is_a_file_is_said(tmp_path):
    (tmp_path / "out").write_text("mine")
    done = wheelchair("simulate", "slalom", "--time", 1, "-o", tmp_path / "out")
    assert done.exit_code == 1 and "out: file exists; give another place" in done.stderr
    assert (tmp_path / "out").read_text() == "mine"


def test_a_failing_write_leaves_what_was_there(tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("old")
    with pytest.raises(KeyboardInterrupt), written(file) as beside:
        beside.write_text("half")
        raise KeyboardInterrupt
    assert file.read_text() == "old" and [f.name for f in tmp_path.iterdir()] == ["a.csv"]


def test_check_finds_nothing_in_the_sample_campaign():
    done = wheelchair("check", SAMPLE)
    assert done.exit_code == 0 and "no faults" in done.output and "holdout-slalom" in done.output
    told = json.loads(wheelchair("check", SAMPLE, "--json").output)
    assert told == {"campaign": str(SAMPLE), "errors": 0, "warnings": 0, "notes": 0, "faults": []}


def test_check_wants_a_campaign_toml(tmp_path):
    done = wheelchair("check", tmp_path)
    assert done.exit_code == 1 and "no campaign.toml in this folder; write one" in done.output
    done = wheelchair("check", tmp_path / "none")
    assert done.exit_code == 1 and "no such folder or file" in done.output


def spoilt(folder: Path) -> Path:
    """The sample campaign with ten faults in it."""
    place = folder / "spoilt"
    shutil.copytree(SAMPLE, place)
    toml = (place / "campaign.toml").read_text()
    for old, new in (
        ("m = 80.0", "m = -80.0"),  # impossible
        ("C_lambda = 5038.0", "C_lamda = 5038.0"),  # misspelt
        ('axes = "SAE-J670"', 'axes = "SAE"'),  # unknown axes
        ("yaw_rate = 0.006", "yaw_rate = -0.006"),  # impossible noise
        ('file = "runs/steady-right.csv"', 'file = "runs/steady-rigth.csv"'),  # no such file
        ('role = "holdout"', 'role = "spare"'),  # unknown role, the first of three
    ):
        assert old in toml
        toml = toml.replace(old, new, 1)
    (place / "campaign.toml").write_text(toml)
    runs = place / "runs"

    def change(name: str, old: str, new: str) -> None:
        text = (runs / name).read_text()
        assert old in text
        (runs / name).write_text(text.replace(old, new, 1))

    change("coast-down.csv", "F_rr [N]", "F_rr [furlong]")  # wrong unit
    change("straight-strokes.csv", "\n0.02,", "\n-0.05,")  # time goes back
    (runs / "steady-left.csv").write_text((runs / "steady-left.csv").read_text().splitlines()[0] + "\n")  # empty
    (runs / "slalom-slow.csv").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(40))  # no recording at all
    return place


def test_check_reports_ten_faults_at_once(tmp_path):
    place = spoilt(tmp_path)
    done = wheelchair("check", place)
    assert done.exit_code == 1 and "Traceback" not in done.output
    for word in (
        "campaign.toml line",
        "C_lamda",
        "'SAE'",
        "steady-rigth.csv",
        "spare",
        "furlong",
        "time goes back",
        "steady-left.csv",
        "a PNG picture",
        "-80",
        "-0.006",
    ):
        assert word in done.output, word
    told = json.loads(wheelchair("check", place, "--json").output)
    assert told["errors"] >= 10 and told["errors"] == sum(f["severity"] == "error" for f in told["faults"])
    assert {"file", "line", "column", "fact", "cure"} <= told["faults"][0].keys()


def test_effects_list_and_show_come_from_the_records():
    told = json.loads(wheelchair("effects", "list", "--json").output)
    assert [effect["id"] for effect in told] == list(bundled())
    done = wheelchair("effects", "show", "relaxation_length")
    assert done.exit_code == 0
    for word in ("effect.relaxation_length.sigma [m]", "smallest interesting size: 0.05 m", "DellOrto2023", "0 to 1 m"):
        assert word in done.output
    one = json.loads(wheelchair("effects", "show", "push_force_delay", "--json").output)
    assert one["in_default_fmu"] is False and one["acts_on"] == []
    assert all(effect in wheelchair("effects", "list").output for effect in bundled())


def test_an_unknown_effect_is_bad_usage():
    done = wheelchair("effects", "show", "relaxation")
    assert done.exit_code == 2 and "no effect 'relaxation'; did you mean 'relaxation_length'" in done.stderr


def test_every_source_that_looks_like_a_key_is_in_the_references():
    keys = {
        line.partition("{")[2].rstrip(",")
        for line in (ROOT / "references.bib").read_text().splitlines()
        if line.startswith("@")
    }
    records: list[Parameter] = list(Variant().with_effects(bundled()).parameters())
    cited = {p.source for p in records if p.source[-4:].isdigit() and " " not in p.source}
    assert cited and cited <= keys


def test_version_help_and_unknown_commands():
    assert wheelchair("--version").output == f"wheelchair-fmu {__version__}\n"
    listed = wheelchair("--help").output
    assert all(f"  {name} " in listed and what in listed for name, what in COMMANDS.items())
    assert "no command 'simulat'; did you mean 'simulate'?" in wheelchair("simulat").stderr
    for words in (["simulat"], ["simulate"], ["effects", "shw", "x"], ["check"], ["--verson"]):
        assert wheelchair(*words).exit_code == 2, words


@pytest.mark.parametrize(
    "command, unit", [("simulate", "Forward speed [m/s]"), ("paper", "slalom [s]"), ("linearize", "R_c [m]")]
)
def test_help_of_a_command_tells_units(command, unit):
    assert unit in " ".join(wheelchair(command, "--help").output.split())


def test_help_waits_for_no_command():
    script = (
        "import sys\nfrom wheelchair_fmu.cli.main import COMMANDS, main\nsys.argv = ['wheelchair', '--help']\n"
        "try:\n    main()\nexcept SystemExit:\n    pass\n"
        "sys.exit(any(f'wheelchair_fmu.cli.{name}' in sys.modules for name in COMMANDS))"
    )
    assert subprocess.run([sys.executable, "-c", script], capture_output=True, check=False).returncode == 0


@pytest.mark.skipif(sys.platform == "win32", reason="sends SIGINT")
def test_an_interrupt_ends_with_one_line_and_130(tmp_path):
    # where the tests run in the background SIGINT is ignored, and children inherit that
    script = (
        "import wheelchair_fmu.api.runs as s, signal, time, sys\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "def wait(*a, **k): print('waiting', flush=True); time.sleep(60)\n"
        "s.fmu_of = wait\n"
        "from wheelchair_fmu.cli.main import main\n"
        "sys.argv = ['wheelchair', 'simulate', 'slalom']\n"
        "main()\n"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", script],
        cwd=tmp_path,
        env={"PYTHONPATH": str(ROOT), "PATH": ""},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert process.stdout and process.stdout.readline() == "waiting\n"
    time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=20)
    assert process.returncode == 130
    assert "interrupted" in said and "Traceback" not in said and not list(tmp_path.iterdir())
