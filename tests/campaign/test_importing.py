"""What recordings tell about themselves: runs and devices by names, columns by headers, signs and sides by signals."""

from __future__ import annotations

import tomllib

import numpy as np
import pandas as pd
import pytest

from wheelchair_fmu.campaign.importing import Wanted, find, held_out, text
from wheelchair_fmu.campaign.importing.gathering import opened, sources
from wheelchair_fmu.campaign.importing.guesses import guess
from wheelchair_fmu.campaign.importing.markers import is_markers
from wheelchair_fmu.campaign.importing.markers import place_on_body as on_the_body_of
from wheelchair_fmu.campaign.importing.naming import placed
from wheelchair_fmu.errors import Failure, UsageError

from . import lab


def named(files: list[str], kind=lambda file: 0) -> dict[str, tuple[str, str]]:
    return {p.file: (p.run, p.device) for p in placed(files, {file: kind(file) for file in files})}


@pytest.mark.parametrize(
    ("files", "expected"),
    [
        (
            ["run01_SWL.csv", "run01_SWR.csv", "run01.trc", "run02_SWL.csv", "run02_SWR.csv", "run02.trc"],
            {"run01_SWR.csv": ("run01", "swr"), "run02.trc": ("run02", "trc")},
        ),
        (
            ["m01.xlsx", "m01_Moment.csv", "m01_imu.mat", "m02.xlsx", "m02_Moment.csv", "m02_imu.mat"],
            {"m01.xlsx": ("m01", "xlsx"), "m02_Moment.csv": ("m02", "moment")},
        ),
        (
            ["imu trial 2.csv", "imu trial 10.csv", "rad-trial 2.csv", "rad-trial 10.csv"],
            {"imu trial 2.csv": ("trial_2", "imu"), "rad-trial 10.csv": ("trial_10", "rad")},
        ),
        (["run01_imu1.csv", "run01_imu2.csv", "run02_imu1.csv", "run02_imu2.csv"], {"run02_imu1.csv": ("run02", "imu1")}),
        (
            ["slalom_imu.csv", "slalom_wheels.csv", "coast_imu.csv", "coast_wheels.csv"],
            {"coast_wheels.csv": ("coast", "wheels")},
        ),
        (["run01/imu.csv", "run02/imu.csv", "run01/rim.csv", "run02/rim.csv"], {"run02/rim.csv": ("run02", "rim")}),
        (["run1_imu.csv", "run1_imu.mat", "run2_imu.csv"], {"run1_imu.mat": ("run1", "imu_mat")}),
        (["left.csv", "right.csv", "frame.csv"], {"left.csv": ("run", "left"), "frame.csv": ("run", "frame")}),
        (["left_slalom.csv", "right_slalom.csv", "left_coast.csv", "right_coast.csv"], {"left_coast.csv": ("coast", "left")}),
    ],
)
def test_runs_and_devices_are_told_by_names(files, expected):
    found = named(files, lambda file: file.rpartition(".")[2])
    assert {file: found[file] for file in expected} == expected
    assert len(set(found.values())) == len(files), "no file is lost"


def test_columns_of_one_length_for_each_axis_are_markers(tmp_path):
    """And those of an inertial sensor are none."""
    for name, unit, taken in (("LHUB", "mm", True), ("Mag", "uT", False), ("Vel", "m/s", False)):
        heads = [f"{name}{i}_{axis} [{unit}]" for i in (1, 2) for axis in "XYZ"]
        pd.DataFrame(np.ones((20, 6)), columns=heads).assign(**{"time [s]": np.arange(20) / 100}).to_csv(
            tmp_path / "m1.csv", index=False
        )
        (source,), _ = sources(opened([(tmp_path / "m1.csv", "m1.csv")])[0])
        assert is_markers(source) is taken


WHAT = ("coast", "straight", "slalom", "left", "right")


@pytest.mark.parametrize(
    "form",
    [
        "S03_{what}_{n:02d}_{device}.csv",
        "S03_{n:02d}_{what}_{device}.csv",
        "S03_{what}_{device}.csv",
        "2024-05-24_{what}_{device}.csv",
        "20240524_S3_{what}_{device}.csv",
        "{what}_S3_{device}.csv",
        "{device}_S3_{what}.csv",
        "SUB1/{what}/{device}.csv",
    ],
)
def test_a_number_of_the_subject_or_the_day_makes_no_run_of_all_files(form):
    files = {
        form.format(what=what, n=n, device=device): (what, device)
        for n, what in enumerate(WHAT, 1)
        for device in ("rad_links", "rad_rechts", "imu")
    }
    found = named(list(files), lambda file: "imu" if "imu" in file else "wheel")
    assert {device for _, device in found.values()} == {"rad_links", "rad_rechts", "imu"}
    runs = {what: {found[file][0] for file, (of, _) in files.items() if of == what} for what in WHAT}
    assert all(len(of) == 1 for of in runs.values()) and len(set.union(*runs.values())) == len(WHAT)


def test_repeated_trials_of_a_subject_are_runs_of_their_own():
    found = named([f"S03_{what}_{n}_{device}.csv" for what in WHAT for n in (1, 2) for device in ("imu", "wheels")])
    assert found["S03_coast_2_imu.csv"] == ("S03_coast_2", "imu") and len(set(found.values())) == 20


def test_two_wheels_of_one_run_are_no_runs():
    files = [f"run1_{side}_{what}.csv" for side in ("left", "right") for what in ("wheel", "imu")]
    assert {run for run, _ in named(files, lambda file: file.rpartition("_")[2]).values()} == {"run1"}


def test_recordings_without_a_pattern_are_runs_of_one_device():
    by_words = ["slalom-quick.csv", "slalom-slow.csv", "straight-quick.csv", "straight-slow.csv"]
    people = ["P01_run1.csv", "P01_run2.csv", "P02_run1.csv", "P02_run2.csv"]
    for files in (by_words, people):
        assert len({device for _, device in named(files).values()}) == 1 and len({run for run, _ in named(files).values()}) == 4
    assert named(["slalom.csv", "coast-down.csv"]) == {
        "slalom.csv": ("slalom", "slalom"),
        "coast-down.csv": ("coast_down", "slalom"),
    }


SEVERAL = [f"run{i}_{device}" for i in range(1, 4) for device in ("torque.csv", "imu.csv", "cart.csv")]
LOGGERS = [f"{logger}_{what}.csv" for what in ("slalom", "coast", "spin") for logger in ("alpha", "beta", "gamma")]


def test_most_files_of_a_device_decide_where_one_has_other_columns():
    found = named(SEVERAL, lambda file: "odd" if file == "run1_imu.csv" else file.partition("_")[2])
    assert set(found.values()) == {(f"run{i}", device) for i in (1, 2, 3) for device in ("torque", "imu", "cart")}


def test_most_is_more_than_half():
    two = [file for file in SEVERAL if not file.startswith("run3")]
    found = named(two, lambda file: "odd" if file == "run1_imu.csv" else file.partition("_")[2])
    assert len({run for run, _ in found.values()}) == len(two), "of two files nobody knows which one is meant"


def test_loggers_are_no_runs_though_most_of_them_have_the_same_columns():
    """Of each manoeuvre there are files of two kinds; its loggers are alike by name alone, so nothing tells them apart."""
    found = named(LOGGERS, lambda file: "wheels" if file.startswith("gamma") else "imu")
    assert not {run for run, _ in found.values()} & {"alpha", "beta", "gamma"}
    assert len(set(found.values())) == len(LOGGERS)


def test_a_pattern_of_one_device_stands_where_headings_are_only_spelt_otherwise():
    files, odd = [f"run{i}.csv" for i in range(1, 5)], "run2.csv"
    kind = {file: int(file == odd) for file in files}
    assert {p.device for p in placed(files, kind, lambda one, other: True)} == {"csv"}
    assert len({p.device for p in placed(files, kind, lambda one, other: False)}) == 2, "as other columns are another logger's"


@pytest.mark.parametrize(
    ("header", "quantity", "axis", "side"),
    [
        ("Zeit [s]", "time", "", ""),
        ("temps", "time", "", ""),
        ("Beschl. X [g]", "acc", "x", ""),
        ("Acc. Y [m/s^2]", "acc", "y", ""),
        ("Ang. Vel. Z [deg/s]", "gyro", "z", ""),
        ("Geschw. links [m/s]", "speed", "", "l"),
        ("Moment Mz [Nm]", "torque", "z", ""),
        ("Drehmoment Mz links [Nm]", "torque", "z", "l"),
        ("Kraft Ft [N]", "force", "", ""),
        ("Gyroscope Z (deg/s)", "gyro", "z", ""),
        ("gyr_z", "gyro", "z", ""),
        ("GyroZ", "gyro", "z", ""),
        ("rec.data.omega_z", "gyro", "z", ""),
        ("Gierrate [deg/s]", "yaw_rate", "", ""),
        ("vitesse de lacet", "yaw_rate", "", ""),
        ("AccX", "acc", "x", ""),
        ("a längs [g]", "acc", "x", ""),
        ("Antriebsmoment links [N·m]", "torque", "", "l"),
        ("couple droit", "torque", "", "r"),
        ("Tz", "torque", "z", ""),
        ("v rechts [km/h]", "speed", "", "r"),
        ("vitesse roue gauche", "speed", "", "l"),
        ("Winkel", "wheel_angle", "", ""),
        ("wheelR_radps", "speed", "", "r"),
        ("FTan_L [N]", "force", "", "l"),
        ("F_rl [N]", "F_rl", "", ""),
        ("Left wheel.Torque", "torque", "", "l"),
        ("rec.right.M_Nm", "torque", "", "r"),
    ],
)
def test_headers_of_usual_loggers_are_understood(header, quantity, axis, side):
    from wheelchair_fmu.units import unit_of

    found = guess(header, unit_of(header))
    assert found is not None
    assert (found.quantity, found.axis, found.side) == (quantity, axis, side)


@pytest.mark.parametrize(
    "header", ["Fx", "Mx [N.m]", "Push Start", "Magnetometer X (uT)", "Barometer (hPa)", "Marke", "Comment"]
)
def test_what_pushes_nobody_is_no_channel(header):
    assert guess(header, None) is None or guess(header, None).quantity == "counter"


def chosen(folder, **more):
    found = find([folder], lab.RADIUS)
    return found, {(p.name, c.channel): c for p in found.plans for c in p.choices if c.settled and not c.beside}


def make(tmp_path, write, runs: int = 3, seed: int = 0):
    """Recordings of some runs, by a function of (folder, run's name, truth, generator)."""
    folder = tmp_path / "raw"
    folder.mkdir()
    rng = np.random.default_rng(seed)
    for i, s in enumerate(lab.rides(seed, runs), 1):
        write(folder, f"run{i:02d}", s, rng)
    return folder


def two_rims(folder, run, s, rng):
    lab.rim(folder / f"{run}_SWL.csv", s, 0.7, "l", rng)
    lab.rim(folder / f"{run}_SWR.csv", s, 0.2, "r", rng, mirrored=True)


def test_rims_and_markers(tmp_path):
    def write(folder, run, s, rng):
        two_rims(folder, run, s, rng)
        lab.markers(folder / f"{run}.trc", s, 0.4, rng, more=("HEAD",) if run == "run03" else ())

    raw = make(tmp_path, write)
    (raw / "run02_SWR.csv").unlink()
    found, by = chosen(raw)
    assert set(found.files["run02"]) == {"swl", "trc"} and set(found.files["run03"]) == {"swl", "swr", "trc"}
    assert found.runs == ["run01", "run02", "run03"]
    assert by["swl", "F_rl"].sign == 1 and by["swr", "F_rr"].sign == -1
    assert by["swl", "wheel_angle_l"].sign == 1 and by["swr", "wheel_angle_r"].sign == -1
    (trc,) = (p for p in found.plans if p.name == "trc")
    assert trc.markers == {"axle_l": "LHUB", "axle_r": "RHUB"} and trc.marker_axes == {"x": "-x", "y": "-z"}
    assert trc.body == {"sternum": "STERNUM"}, "the one that every recording has"
    files = {run: {d: f for d, (_, f) in of.items()} for run, of in found.files.items()}
    for wanted, mass in ((Wanted("it", mass=95.0), 75.0), (Wanted("it", mass=95.0, person=70.0), 70.0)):
        written = tomllib.loads(text(found.plans, found.runs, files, wanted))
        assert written["rider"] == {"m": mass}
        assert written["recording"][[p.name for p in found.plans].index("trc")]["markers"]["sternum"] == "STERNUM"
    assert not [d for p in found.plans for d in p.doubts]


@pytest.mark.parametrize(
    ("name", "place"),
    [
        ("LSHO", "shoulder_l"),
        ("R_ACROMION", "shoulder_r"),
        ("AcromionL", "shoulder_l"),
        ("subject1:RELB", "elbow_r"),
        ("shoulder right", "shoulder_r"),
        ("WristR", "wrist_r"),
        ("Hand_L", "hand_l"),
        ("LHIP", "hip_l"),
        ("CLAV", "sternum"),
        ("C7", "c7"),
        ("head", "head"),
        ("LHUB", ""),
        ("SHO", ""),
        ("frame3", ""),
    ],
)
def test_places_on_a_body_go_by_their_names(name, place):
    assert on_the_body_of(name) == place


def test_markers_with_the_names_of_the_other_side_are_said(tmp_path):
    found, _ = chosen(
        make(tmp_path, lambda f, run, s, rng: lab.markers(f / f"{run}.trc", s, 0.4, rng, left="RHUB", right="LHUB"))
    )
    (trc,) = found.plans
    assert trc.markers == {"axle_l": "RHUB", "axle_r": "LHUB"}
    assert any("backwards" in doubt for doubt in trc.doubts)


@pytest.mark.parametrize(
    ("axes", "ahead", "side", "frame"),
    [(lab.AS_ISO, ("X", 1), ("Y", 1), "ISO-8855"), (lab.BACKWARDS, ("Y", -1), ("X", 1), "SAE-J670")],
)
def test_sensors_on_spokes_and_on_the_frame_whichever_way_they_lie(tmp_path, axes, ahead, side, frame):
    def write(folder, run, s, rng):
        lab.spoke(folder / f"{run}_imu_left.csv", s, 0.5, "l", 1, rng)
        lab.spoke(folder / f"{run}_imu_right.csv", s, 0.1, "r", -1, rng)
        lab.frame(folder / f"{run}_imu_seat.csv", s, 0.3, rng, axes)

    found, by = chosen(make(tmp_path, write))
    assert by["imu_left", "wheel_speed_l"].header == "Gyroscope Y (deg/s)" and by["imu_left", "wheel_speed_l"].sign == 1
    assert by["imu_right", "wheel_speed_r"].sign == -1
    seat = next(p for p in found.plans if p.name == "imu_seat")
    assert seat.axes == frame
    assert by["imu_seat", "yaw_rate"].header == "Gyroscope Z (deg/s)" and by["imu_seat", "yaw_rate"].sign == 1
    for channel, (axis, sign) in (("a_x", ahead), ("a_y", side)):
        assert by["imu_seat", channel].header == f"Accelerometer {axis} (g)"
        assert by["imu_seat", channel].sign == sign
    assert not [d for p in found.plans for d in p.doubts]
    assert "correlation" in by["imu_seat", "yaw_rate"].why


def test_files_named_after_the_other_wheel_are_said(tmp_path):
    def write(folder, run, s, rng):
        lab.spoke(folder / f"{run}_left.csv", s, 0.5, "r", 1, rng)
        lab.spoke(folder / f"{run}_right.csv", s, 0.1, "l", -1, rng)
        lab.frame(folder / f"{run}_frame.csv", s, 0.3, rng)

    found, by = chosen(make(tmp_path, write))
    assert ("left", "wheel_speed_r") in by and ("right", "wheel_speed_l") in by
    doubts = [d for p in found.plans for d in p.doubts]
    assert len(doubts) == 2 and all("seems to be the" in d and "outer wheel" in d for d in doubts)


def test_sensors_without_names_are_told_by_what_they_saw(tmp_path):
    def write(folder, run, s, rng):
        lab.spoke(folder / f"{run}_imu1.csv", s, 0.5, "r", 1, rng)
        lab.frame(folder / f"{run}_imu2.csv", s, 0.3, rng)
        lab.spoke(folder / f"{run}_imu3.csv", s, 0.1, "l", 1, rng)

    found, by = chosen(make(tmp_path, write))
    assert ("imu1", "wheel_speed_r") in by and ("imu3", "wheel_speed_l") in by and ("imu2", "yaw_rate") in by
    assert not [d for p in found.plans for d in p.doubts]


def torques(folder, run, s, rng, names=("links [N·m]", "rechts [N·m]"), size=1.0):
    """A logger of both rims with three columns, and one of the chair's speed."""
    time, left, right = lab.seen(s, 100, 0.5, "F_rl", "F_rr")
    values = [size * lab.RADIUS * push + rng.normal(0, 0.1 * size, len(time)) for push in (left, right)]
    table = {"Zeit [s]": time} | {f"Antriebsmoment {n}": v for n, v in zip(names, values, strict=True)}
    pd.DataFrame(table).to_csv(folder / f"{run}_Moment.csv", index=False)
    time, left, right = lab.seen(s, 100, 0.2, "wheel_speed_l", "wheel_speed_r")
    pd.DataFrame({"Zeit [s]": time, "v links [m/s]": left, "v rechts [m/s]": right}).to_csv(folder / f"{run}.csv", index=False)


@pytest.mark.parametrize("odd", ["run01", "run02"])
@pytest.mark.parametrize(
    ("names", "size", "lost"),
    [
        (("link [N·m]", "rechts [N·m]"), 1.0, True),
        (("left [N·m]", "rechts [N·m]"), 1.0, True),
        (("links [kN·m]", "rechts [kN·m]"), 1e-3, False),
    ],
)
def test_a_heading_that_one_file_has_otherwise_takes_no_lab_apart(tmp_path, odd, names, size, lost):
    def write(folder, run, s, rng):
        torques(folder, run, s, rng, *((names, size) if run == odd else ()))

    found, by = chosen(make(tmp_path, write, 4))
    assert found.runs == ["run01", "run02", "run03", "run04"]
    assert [plan.name for plan in found.plans] == ["csv", "moment"] and all(len(of) == 2 for of in found.files.values())
    choice = by["moment", "F_rl"]
    assert choice.header == "Antriebsmoment links [N·m]", "as most files call it, also where the first one does not"
    series = {run: found.plans[1].series(run, choice) for run in found.runs}
    assert [run for run in found.runs if series[run] is None] == ([odd] if lost else [])
    peaks = [np.max(one[1]) for one in series.values() if one is not None]
    assert max(peaks) < 5 * min(peaks), "each file is read in its own unit"


def test_files_without_a_pattern_stay_one_device_s_where_one_is_spelt_otherwise(tmp_path):
    names = ("slalom-quick", "slalom-slow", "straight-quick", "straight-slow")
    for i, (name, s) in enumerate(zip(names, lab.rides(0, 4), strict=True)):
        time, left, right = lab.seen(s, 100, 0.2, "wheel_speed_l", "wheel_speed_r")
        table = {"Zeit [s]": time, "v wheel links [m/s]": left, "v wheel rechts [m/s]": right}
        table = {h.replace("rechts", "recht") if i == 1 else h: v for h, v in table.items()}
        pd.DataFrame(table).to_csv(tmp_path / f"{name}.csv", index=False)
    found = find([tmp_path], lab.RADIUS)
    assert len(found.plans) == 1 and len(found.runs) == len(names)


def test_loggers_of_two_wheels_that_differ_in_the_side_alone_stay_two(tmp_path):
    """Nothing in the names tells them apart, but each heading says its side."""
    for i, s in enumerate(lab.rides(0, 5)):
        time, push = lab.seen(s, 100, 0.2, "F_rl")
        side = "links" if i < 3 else "rechts"
        table = {"Zeit [s]": time, f"Antriebskraft {side} [N]": push}
        pd.DataFrame(table).to_csv(tmp_path / f"{('slalom', 'spin', 'coast', 'eight', 'start')[i]}.csv", index=False)
    assert len(find([tmp_path], lab.RADIUS).plans) == 2


def test_a_unit_that_no_file_gives_is_told_by_the_signals_and_marked(tmp_path):
    def write(folder, run, s, rng):
        time, left, right = lab.seen(s, 100, 0.6, "wheel_speed_l", "wheel_speed_r")
        left, right = (3.6 * (v + rng.normal(0, 0.003, len(time))) for v in (left, right))
        table = {"Zeit [ms]": 1000 * time, "v links [km/h]": left, "v rechts [km/h]": right}
        pd.DataFrame(table).to_csv(folder / f"{run}_rad.csv", index=False)
        lab.frame(folder / f"{run}_imu.csv", s, 0.3, rng, units=False)

    found, by = chosen(make(tmp_path, write))
    assert by["imu", "yaw_rate"].unit == "deg/s" and by["imu", "a_x"].unit == "g"
    content = text(
        found.plans, found.runs, {run: {d: f for d, (_, f) in of.items()} for run, of in found.files.items()}, Wanted("small")
    )
    assert "the file gives no unit" in content and "check it" in content
    read = tomllib.loads(content)
    assert read["recording"][0]["columns"]["yaw_rate"] == {"column": "Gyroscope Z", "unit": "deg/s"}


def test_a_unit_that_nothing_tells_is_left_to_the_user(tmp_path):
    def write(folder, run, s, rng):
        time, left = lab.seen(s, 100, 0.6, "wheel_speed_l")
        pd.DataFrame({"t": time, "speed left": left}).to_csv(folder / f"{run}.csv", index=False)

    found, by = chosen(make(tmp_path, write))
    assert not by
    content = text(
        found.plans, found.runs, {run: {d: f for d, (_, f) in of.items()} for run, of in found.files.items()}, Wanted("small")
    )
    assert "write the right one" in content
    assert tomllib.loads(content)["columns"]["wheel_speed_l"] == "speed left", "which the check asks the unit of"


def test_bad_input_is_said_in_one_sentence_each(tmp_path):
    folder = make(tmp_path, two_rims, runs=1)
    (folder / "photo.jpg").write_bytes(b"\xff\xd8\xff" + bytes(50))
    (folder / "broken.csv").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(500))
    (folder / "README.md").write_text("# What we did\n")
    (folder / "empty.csv").write_bytes(b"")
    (folder / "copy.csv").write_bytes((folder / "run01_SWL.csv").read_bytes())
    said = [str(f) for f in find([folder, folder], None).faults]
    for place, words in (
        ("warning: broken.csv", "HDF5"),
        ("note: README.md", "text"),
        ("warning: empty.csv", "empty"),
        ("warning: run01_SWL.csv", "the same as copy.csv"),
    ):
        assert len([line for line in said if line.startswith(place) and words in line]) == 1, (place, said)


def test_no_recording_and_no_file(tmp_path):
    (tmp_path / "empty").mkdir()
    with pytest.raises(Failure, match=r"there is no file in .*empty"):
        find([tmp_path / "empty"], None)
    with pytest.raises(UsageError, match="no file"):
        find([tmp_path / "nowhere"], None)
    (tmp_path / "empty" / "notes.txt").write_text("we met at nine\n")
    with pytest.raises(Failure, match="no recording was found"):
        find([tmp_path / "empty"], None)


@pytest.mark.parametrize(
    ("rows", "said"),
    [
        (["0,0.1", "0.01,0.2"], "2 rows are no recording, which has 20 or more; record for longer, or take the file away"),
        (["0,0.1"], "one row is no recording"),
        (["a,b"] * 30, "the file has no column of numbers; export it again"),
    ],
)
def test_a_file_that_is_no_recording_is_told_what_it_lacks(tmp_path, rows, said):
    (tmp_path / "a.csv").write_text("\n".join(["time [s],yaw_rate [rad/s]", *rows]))
    with pytest.raises(Failure) as told:
        find([tmp_path], None)
    assert said in str(told.value)


def test_a_thousand_columns_are_read(tmp_path):
    rng = np.random.default_rng(0)
    table = {"time [s]": np.arange(300) / 100} | {f"channel {i}": rng.normal(size=300) for i in range(1000)}
    table["Gyroscope Z (deg/s)"] = rng.normal(size=300)
    pd.DataFrame(table).to_csv(tmp_path / "wide.csv", index=False)
    (plan,) = find([tmp_path], None).plans
    assert [c.channel for c in plan.choices] == ["yaw_rate"]


def test_runs_are_held_out_by_default_and_by_name():
    runs = [f"run{i}" for i in range(1, 8)]
    assert held_out(runs, []) == ["run6", "run7"] and held_out(runs[:2], []) == [] and held_out(runs, ["run2"]) == ["run2"]
    assert held_out(["a", "holdout_b", "c"], []) == ["holdout_b"]
    with pytest.raises(UsageError, match="did you mean 'run7'"):
        held_out(runs, ["run77"])
