"""`wheelchair import`: from loggers' files to a campaign without errors, on one clock."""

from __future__ import annotations

import json
import shutil
import tomllib

import numpy as np
import pandas as pd
import pytest
from typer.testing import CliRunner

from benchmarks.labs import AT, GIVEN
from tests.campaign import lab
from tests.campaign.test_measurements import MEASUREMENTS
from tests.campaign.test_measurements import folder as measured
from wheelchair_fmu.campaign import check, read
from wheelchair_fmu.cli.main import app
from wheelchair_fmu.inference.subject import known_parameters

LATE = {"swl": 0.7, "swr": 0.2, "imu": 0.45}


def imported(*words: object):
    return CliRunner().invoke(app, ["import", *map(str, words)])


@pytest.fixture(scope="module")
def raw(tmp_path_factory):
    folder = tmp_path_factory.mktemp("raw")
    rng = np.random.default_rng(1)
    for i, s in enumerate(lab.rides(1), 1):
        lab.rim(folder / f"run{i:02d}_SWL.csv", s, LATE["swl"], "l", rng)
        lab.rim(folder / f"run{i:02d}_SWR.csv", s, LATE["swr"], "r", rng, mirrored=True)
        lab.frame(folder / f"run{i:02d}_imu.csv", s, LATE["imu"], rng, lab.BACKWARDS)
    return folder


@pytest.fixture(scope="module")
def made(raw, tmp_path_factory):
    out = tmp_path_factory.mktemp("made") / "campaign"
    sizes = ("--radius", lab.RADIUS, "--mass", 90, "--track", 0.56, "--wheelbase", 0.44, "--cm-ahead", 0.1)
    return out, imported(raw, "-o", out, *sizes, "--caster-trail", 0.05, "--wheel-inertia", 0.12)


def test_a_folder_of_recordings_becomes_a_campaign(made):
    out, done = made
    assert done.exit_code == 0, done.output
    assert {f.name for f in out.iterdir()} == {"campaign.toml", "preview.html", "preview.png", "runs"}
    content = tomllib.loads((out / "campaign.toml").read_text(encoding="utf-8"))
    assert content["chair"] == {"m": 90, "a": 0.34, "b": 0.1, "t_r": 0.56} and content["wheel"] == {"R": lab.RADIUS}
    spin = pytest.approx(2 * 0.12 / lab.RADIUS**2, rel=1e-3)  # two wheels
    assert content["effect"] == {"caster_trail": {"c": 0.05}, "wheel_inertia": {"m": spin}}
    assert content["nuisance"] == dict.fromkeys(("F_rl", "F_rr", "yaw_rate", "a_x", "a_y"), True)
    assert [run["role"] for run in content["run"]] == ["fit", "fit", "holdout"]
    for run in content["run"]:
        first = next(iter(run["files"]))
        for device, clock in run["clocks"].items():
            assert clock["offset"] == pytest.approx(LATE[device] - LATE[first], abs=0.01)
    faults = check(out, known_parameters())
    assert not [f for f in faults if f.severity == "error"]
    assert "look at this" not in done.output, "nothing is doubtful here"
    assert f"wheelchair diagnose {out}" in done.output.replace("\n", " ")


def test_what_was_imported_is_what_happened(made):
    out, _ = made
    truth = lab.rides(1)[0]
    run = read(out).runs[0]
    first = next(iter(tomllib.loads((out / "campaign.toml").read_text(encoding="utf-8"))["run"][0]["files"]))
    time = run.time - 3.0 + LATE[first]
    for name, sd in (("yaw_rate", 0.006), ("a_x", 0.11), ("a_y", 0.11), ("wheel_speed_l", 0.03), ("wheel_speed_r", 0.03)):
        there = np.isfinite(run.channels[name])
        expected = truth["u"] * truth["yaw_rate"] if name == "a_y" else truth[name]
        assert np.std(run.channels[name][there] - np.interp(time[there], truth["t"], expected)) < 1.5 * sd, name
    for name in ("F_rl", "F_rr"):
        assert np.corrcoef(run.inputs[f"push.{name}"], np.interp(time, truth["t"], truth[name]))[0, 1] > 0.99


def test_a_campaign_that_is_there_stays_unless_forced(raw, tmp_path):
    (tmp_path / "campaign.toml").write_text("# mine\n")
    done = imported(raw, "-o", tmp_path)
    assert done.exit_code == 2 and "stays as it is" in done.output
    assert (tmp_path / "campaign.toml").read_text() == "# mine\n"
    done = imported(raw / "run01_imu.csv", "-o", tmp_path, "--force", "--link", "--axes", "ISO-8855")
    assert done.exit_code == 0, done.output
    assert (tmp_path / "runs" / "run01_imu.csv").is_symlink()
    assert "no push force" in done.output, "what the campaign still lacks is said"


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--radius", "-1"], "no size of a wheelchair"),
        (["--wheelbase", "0.4", "--cm-ahead", "0.4"], "beyond the casters' pivots"),
        (["--caster-trail", "5"], "no size of a wheelchair"),
        (["--wheel-inertia", "12"], "no size of a wheelchair"),
        (["--mass", "8.5"], "mass of chair and rider, kg); give one from 10 to 400"),
        (["--axes", "ISO"], "no axes"),
        (["--holdout", "run9"], "no run 'run9'"),
    ],
)
def test_what_cannot_be_meant_is_refused(raw, tmp_path, words, said):
    done = imported(raw, "-o", tmp_path / "c", *words)
    assert done.exit_code == 2 and said in done.output and not (tmp_path / "c").exists()


def test_a_wheel_s_inertia_waits_for_its_radius(raw, tmp_path):
    imported(raw / "run01_imu.csv", "-o", tmp_path / "c", "--axes", "ISO-8855", "--wheel-inertia", 0.12)
    text = (tmp_path / "c" / "campaign.toml").read_text(encoding="utf-8")
    assert "# wheel_inertia.m =   # 2 I/R2" in text and not tomllib.loads(text)["effect"]


def test_a_misspelt_heading_is_said_by_import(raw, tmp_path):
    folder = tmp_path / "raw"
    shutil.copytree(raw, folder)
    odd = folder / "run02_imu.csv"
    odd.write_text(odd.read_text().replace("Gyroscope Z", "Gyrscope Z"))
    done = imported(folder, "-o", tmp_path / "c", "--radius", lab.RADIUS)
    said = [line for line in done.output.splitlines() if "Gyrscope Z" in line]
    assert said == [
        "warning: run runs/run02_imu.csv line 1 column 'Gyrscope Z (deg/s)': it is called 'Gyroscope Z (deg/s)' in 2 other "
        "files, and yaw_rate is not read from it; correct the header in this file"
    ]


def test_at_a_terminal_it_asks_what_no_signal_tells(raw, tmp_path, monkeypatch):
    monkeypatch.setattr("wheelchair_fmu.cli.import_._at_terminal", lambda: True)
    words = ["import", *map(str, sorted(raw.glob("run01*"))), "-o", str(tmp_path), "--track", "0.5"]
    done = CliRunner().invoke(app, words, input="x\n88,5\n\n0,44\n0.1\n\n5\n0.05\n\n")
    assert done.exit_code == 0 and "give a number from 0.001 to 0.3" in done.output, done.output
    content = tomllib.loads((tmp_path / "campaign.toml").read_text(encoding="utf-8"))
    assert content["chair"] == {"m": 88.5, "a": 0.34, "b": 0.1, "t_r": 0.5} and content["wheel"] == {}
    assert "rider alone" not in done.output, "no marker is on a body"
    assert "the wheels' radius is missing" in done.output and "plausible" not in done.output, "what was left open is said"


def test_at_a_terminal_it_asks_for_the_wheel_and_the_unit_that_no_file_tells(tmp_path, monkeypatch):
    monkeypatch.setattr("wheelchair_fmu.cli.import_._at_terminal", lambda: True)
    rng = np.random.default_rng(2)
    for i, s in enumerate(lab.rides(2), 1):
        lab.rim(tmp_path / f"run{i}_wheel.csv", s, 0.5, "l", rng)
        time, right = lab.seen(s, 100, 0.2, "wheel_speed_r")
        pd.DataFrame({"t [s]": time, "speed right": right / 0.3}).to_csv(tmp_path / f"run{i}_tacho.csv", index=False)
    words = ["import", str(tmp_path), "-o", str(tmp_path / "c"), "--mass", "90", "--radius", "0.3", "--track", "0.56"]
    done = CliRunner().invoke(app, words, input="left\nkg\nrad/s\n\n\n\n\n\n\n\n")
    assert done.exit_code == 0, done.output
    assert (
        "wheel: on which wheel is it" in done.output and "'kg' is no unit of it; give one such as m/s or rad/s" in done.output
    )
    content = tomllib.loads((tmp_path / "c" / "campaign.toml").read_text(encoding="utf-8"))
    tacho, wheel = sorted(content["recording"], key=lambda one: one["device"])
    assert tacho["columns"]["wheel_speed_r"] == {"column": "speed right", "unit": "rad/s"}
    assert set(wheel["columns"]) >= {"F_rl", "wheel_angle_l"}
    done = CliRunner().invoke(app, [*words, "--force"], input="\n\n\n\n\n\n\n")
    assert "no name tells of which wheel" in done.output and "next: fill in what is open" in done.output


def test_recordings_that_lie_in_the_campaign_stay_where_they_are(raw, tmp_path):
    (tmp_path / "data").mkdir()
    for file in raw.glob("run0*_SW*"):
        (tmp_path / "data" / file.name).write_bytes(file.read_bytes())
    done = imported(tmp_path, "-o", tmp_path, "--radius", lab.RADIUS)
    assert done.exit_code == 0 and not (tmp_path / "runs").exists(), done.output
    content = tomllib.loads((tmp_path / "campaign.toml").read_text(encoding="utf-8"))
    assert content["run"][0]["files"]["swl"] == "data/run01_SWL.csv"


def test_a_recording_without_time_is_said_once_with_a_cure(tmp_path):
    pd.DataFrame({"gyro_z [deg/s]": np.arange(50.0), "acc_x [g]": np.arange(50.0)}).to_csv(tmp_path / "a.csv", index=False)
    said = imported(tmp_path / "a.csv", "-o", tmp_path / "c").output
    assert said.count("no time column among 'gyro_z [deg/s]', 'acc_x [g]'") == 1 and "write rate = ... in Hz" in said


def test_wheels_that_were_exchanged_in_one_run_are_said(tmp_path):
    """Their instruments mirror each other, so that the chair seems to go backwards in it; or they do not, and it seems to turn
    the other way."""
    rng = np.random.default_rng(3)
    for mirrored, odd in (
        (True, "the wheels gain speed where a_x has the chair lose it"),
        (False, "the wheels' speeds differ against the chair's turning"),
    ):
        raw, out = tmp_path / f"raw {mirrored}", tmp_path / f"made {mirrored}"
        raw.mkdir()
        for i, s in enumerate(lab.rides(1), 1):
            names = ("right", "left") if i == 2 else ("left", "right")
            for name, side, late in zip(names, "lr", (0.5, 0.1), strict=True):
                lab.spoke(raw / f"run{i:02d}_{name}.csv", s, late, side, -1 if mirrored and side == "r" else 1, rng)
            lab.frame(raw / f"run{i:02d}_frame.csv", s, 0.3, rng)
        told = imported(raw, "-o", out, "--radius", lab.RADIUS).output.splitlines()
        said = [line for line in told if "unlike in other runs" in line]
        assert len(said) == 1 and said[0].startswith(f"warning: run run02: {odd}"), said
        assert "exchange the files of left and right in this run, or correct the sign of" in said[0]


def test_devices_that_share_nothing_are_said(tmp_path):
    rng = np.random.default_rng(3)
    one, other = lab.rides(3, 1)[0], lab.rides(4, 1)[0]
    lab.rim(tmp_path / "run1_SWL.csv", one, 0.1, "l", rng)
    lab.frame(tmp_path / "run1_imu.csv", other | {"a_x": 0 * other["t"], "yaw_rate": 0 * other["t"]}, 0.2, rng)
    done = imported(tmp_path, "-o", tmp_path / "c", "--radius", lab.RADIUS)
    assert f"then\n    wheelchair sync {tmp_path / 'c'}\n" in done.output
    told = "run1: imu measured nothing that sets its clock beside that of any other device; give its offset by hand"
    assert told in " ".join(done.output.split())
    assert "is not sure: give it in clocks" in (tmp_path / "c" / "campaign.toml").read_text(encoding="utf-8")


def test_what_another_device_measures_too_tells_of_clocks_all_the_same(tmp_path):
    """Its own accelerometer tells them better than what pushes do to a chair, of which nobody knows more than some ms."""
    rng, raw = np.random.default_rng(5), tmp_path / "raw"
    raw.mkdir()
    for i, s in enumerate(lab.rides(5), 1):
        time, *values = lab.seen(s, 100, 0.6, "F_rl", "F_rr", "a_x")
        noisy = [v + rng.normal(0, sd, len(time)) for v, sd in zip(values, (0.5, 0.5, 0.1), strict=True)]
        columns = dict(zip(("time [s]", "F_rl [N]", "F_rr [N]", "a_x [m/s2]"), (time, *noisy), strict=True))
        pd.DataFrame(columns).to_csv(raw / f"run{i:02d}_rims.csv", index=False)
        lab.frame(raw / f"run{i:02d}_imu.csv", s, 0.3, rng)
    imported(raw, "-o", tmp_path / "c", "--radius", lab.RADIUS)
    content = tomllib.loads((tmp_path / "c" / "campaign.toml").read_text(encoding="utf-8"))
    readers = [d["device"] for d in content["recording"] if d["columns"].get("a_x")]
    assert readers == ["imu"] and len(content["run"]) == 3
    first = next(iter(content["run"][0]["files"]))
    for run in content["run"]:
        ((device, clock),) = run["clocks"].items()
        assert clock["offset"] == pytest.approx(-0.3 if first == "rims" else 0.3, abs=4 * clock["sd"]), device
        assert clock["sd"] < 0.003


ZEROED = {"lab-02": ("F_rl", "F_rr")}  # rims that need no baseline, by the protocol


def by_hand(name: str, text: str) -> tuple[str, int]:
    """The campaign.toml with what stands in the protocol, and how many lines that are: three lengths, where the sensor sits,
    and that the noise is as the samples show it."""
    *_, wheelbase, b, t_f = GIVEN[name]
    lines = text.split("\n")
    for key, value in (("a", wheelbase - b), ("b", b), ("t_f", t_f)):
        at = next(i for i, line in enumerate(lines) if line.startswith(f"# {key} = "))
        lines[at] = f"{key} = {value:.3f}"
    if name in AT:
        at = next(i for i, line in enumerate(lines) if line.startswith("# at = "))
        lines[at] = f"at = {AT[name]}"
    noise = lines.index(next(line for line in lines if line.startswith("# [noise]")))
    end = lines.index("", noise)
    lines[noise:end] = [line.removeprefix("# ") for line in lines[noise:end]]
    for rim in ZEROED.get(name, ()):
        lines[lines.index(f"{rim} = true")] = f"# {rim} = true"
    return "\n".join(lines), sum(one != other for one, other in zip(lines, text.split("\n"), strict=True))


@pytest.fixture(scope="module", params=GIVEN)
def made_lab(request, tmp_path_factory):
    """A lab's name, its campaign, and its truth: mass, radius and track were given with the command."""
    name = request.param
    if name == "lab-02":
        pytest.importorskip("openpyxl", reason="reading a workbook needs openpyxl")
    mass, radius, track, *_ = GIVEN[name]
    out = tmp_path_factory.mktemp("labs") / name
    done = imported(measured(name), "-o", out, "--mass", mass, "--radius", radius, "--track", track)
    assert done.exit_code == 0, done.output
    return name, out, json.loads((MEASUREMENTS / "lab-answers.json").read_text())[name]["runs"]


@pytest.mark.nightly
def test_clocks_and_roles_of_imported_labs_are_right(made_lab):
    _, out, truth = made_lab
    for run in tomllib.loads((out / "campaign.toml").read_text(encoding="utf-8"))["run"]:
        assert run["role"] == truth[run["name"]]["role"]
        true = {
            device: truth[run["name"]]["files"][file.rpartition("/")[2]]["offset_s"] for device, file in run["files"].items()
        }
        first = next(iter(true))  # whose clock is the run's
        assert {first, *run["clocks"]} == set(true)
        for device, clock in run["clocks"].items():
            assert clock["offset"] == pytest.approx(true[device] - true[first], abs=0.02), (run["name"], device)


@pytest.mark.nightly
@pytest.mark.parametrize("side", ["left", "right"])
def test_baselines_of_imported_labs_are_within_two_standard_errors(made_lab, side):
    name, out, truth = made_lab
    push = f"F_r{side[0]}"
    told = {run: found[push] for run, found in read(out).rims.items() if push in found}
    assert len(told) == (6 if name == "lab-02" else 7), "in a circle of lab-02 a hand is on either rim nearly all the time"
    z = {run: (rim["offset"] - truth[run]["baseline_Nm"][side]) / rim["se"] for run, rim in told.items()}
    assert max(map(abs, z.values())) < 2.0, z


@pytest.mark.nightly
def test_with_at_most_twenty_lines_by_hand_check_is_clean(made_lab):
    name, out, _ = made_lab
    written, lines = by_hand(name, (out / "campaign.toml").read_text(encoding="utf-8"))
    (out / "campaign.toml").write_text(written, encoding="utf-8")
    assert [str(f) for f in check(out, known_parameters()) if f.severity != "note"] == []
    assert lines <= 20


@pytest.mark.parametrize("person", [67.2, None])
def test_the_mass_of_what_moves_as_a_measured_position_says_is_written(tmp_path, person):
    """A position of the body that is called by the channel's own name is used, with its mass or a place to fill it in."""
    t = np.arange(0, 6, 0.02)
    frame = {
        "time [s]": t,
        "u [m/s]": 1 + 0.1 * np.sin(t),
        "rider.s [m]": 0.05 * np.sin(5 * t),
        "F_rl [N]": 0 * t,
        "F_rr [N]": 0 * t,
    }
    pd.DataFrame(frame).to_csv(tmp_path / "run01_coast.csv", index=False)
    words = ("--mass", 90, "--json", *(() if person is None else ("--person", person)))
    done = imported(tmp_path / "run01_coast.csv", "-o", tmp_path / "made", *words)
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert any("mass that moves" in fault["fact"] for fault in found["faults"]) == (person is None)
    assert "rider.s" in [column["channel"] for device in found["devices"] for column in device["columns"]]
    content = tomllib.loads((tmp_path / "made" / "campaign.toml").read_text(encoding="utf-8"))
    assert content["columns"]["rider.s"] == "rider.s [m]"
    assert content.get("rider", {}).get("m") == person
    faults = [f for f in check(tmp_path / "made", known_parameters()) if f.severity == "error"]
    assert ["mass that moves" in f.fact for f in faults] == ([] if person else [True])
