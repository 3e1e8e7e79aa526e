"""A run made of the files of several devices, each with its own clock, rate and columns."""

from __future__ import annotations

import re

import numpy as np
import pandas as pd
import pytest

from wheelchair_fmu.campaign import check, read
from wheelchair_fmu.campaign.angles import wheel_speed

TOML = """[campaign]
name = "lab"
axes = "SAE-J670"
[chair]
m = 80.0
b = 0.1
[wheel]
R = 0.3
[noise]
F_rl = 0.4
F_rr = 0.4
yaw_rate = 0.006
x = 0.001
y = 0.001
yaw = 0.01
[[recording]]
device = "rims"
columns.F_rl = { column = "torque left", unit = "N.m" }
columns.F_rr = { column = "torque right", unit = "N.m" }
columns.wheel_angle_l = { column = "angle", unit = "deg" }
[[recording]]
device = "imu"
axes = "ISO-8855"
at = [0.11, 0.04]
columns.yaw_rate = { column = "gyro z", unit = "deg/s" }
columns.a_x = { column = "acc", unit = "g", sign = -1 }
[[recording]]
device = "cameras"
markers = { axle_l = "LHUB", axle_r = "RHUB" }
axes = { x = "z", y = "-x" }
[[run]]
files = { rims = "one_rims.csv", imu = "one_imu.csv", cameras = "one_markers.csv" }
clocks = { imu = { offset = 0.3, sd = 0.002 }, cameras = -0.2 }
manoeuvre = "weaving"
role = "fit"
u0 = 1.0
"""
HEADS = {"rims": (0.0, 240.0), "imu": (0.3, 100.0), "cameras": (-0.2, 150.0)}


def moved(t: np.ndarray) -> dict[str, np.ndarray]:
    """A chair that weaves at 1 m/s: by the run's clock, in SI and SAE axes."""
    yaw = 0.2 * np.sin(2 * t)
    forward, right = np.stack([np.cos(yaw), np.sin(yaw)]), np.stack([-np.sin(yaw), np.cos(yaw)])
    axle = np.stack([t, 0.1 * np.sin(2 * t)])
    return {
        "yaw": yaw,
        "yaw_rate": 0.4 * np.cos(2 * t),
        "push": 10 + 5 * np.sin(3 * t),
        "turned": t / 0.3 + 5.0,
        "left": axle - 0.3 * right,
        "right": axle + 0.3 * right,
        "cm": axle + 0.1 * forward,
    }


@pytest.fixture
def lab(tmp_path):
    rng = np.random.default_rng(0)
    time = {device: np.arange(0, 5, 1 / rate) for device, (_, rate) in HEADS.items()}
    at = {device: moved(time[device] + HEADS[device][0]) for device in HEADS}

    def noise(device, sd):
        return rng.normal(0, sd, len(time[device]))

    rims, imu, seen = at["rims"], at["imu"], at["cameras"]
    tables = {
        "one_rims.csv": {
            "time [s]": time["rims"],
            "torque left": 0.3 * rims["push"] + noise("rims", 0.1),
            "torque right": 0.3 * rims["push"] + noise("rims", 0.1),
            "angle": (np.degrees(rims["turned"]) + noise("rims", 0.02)) % 360,
        },
        "one_imu.csv": {
            "time [s]": time["imu"],
            "gyro z": -np.degrees(imu["yaw_rate"]) + noise("imu", 0.3),
            "acc": -0.01 * imu["push"] + noise("imu", 0.01),
        },
        "one_markers.csv": {"time [s]": time["cameras"]}
        | {
            f"{marker}.{axis} [mm]": 1000 * sign * seen[side][i] + noise("cameras", 0.5)
            for marker, side in (("LHUB", "left"), ("RHUB", "right"))
            for axis, sign, i in (("z", 1, 0), ("x", -1, 1))
        },
    }
    for name, columns in tables.items():
        pd.DataFrame(columns).to_csv(tmp_path / name, index=False)
    (tmp_path / "campaign.toml").write_text(TOML, encoding="utf-8")
    return tmp_path


def edited(lab, old, new):
    text = (lab / "campaign.toml").read_text(encoding="utf-8")
    assert old in text
    (lab / "campaign.toml").write_text(text.replace(old, new), encoding="utf-8")
    return [str(fault) for fault in check(lab)]


def test_every_sample_stands_at_its_own_time(lab):
    (run,) = read(lab).runs
    assert run.name == "one"
    for channel, device, sd in (("yaw_rate", "imu", 0.006), ("x", "cameras", 0.001), ("yaw", "cameras", 0.003)):
        there = np.isfinite(run.channels[channel])
        offset, rate = HEADS[device]
        in_file = (run.time[there] - offset) * rate
        np.testing.assert_allclose(in_file, np.round(in_file), atol=1e-3)
        assert there.sum() == pytest.approx(5 * rate, abs=0.4 * rate)
        true = moved(run.time[there])
        expected = true["cm"][0] if channel == "x" else true[channel]
        assert np.std(run.channels[channel][there] - expected) < 1.5 * sd
    assert run.time[0] >= 0 and run.time[-1] < 5, "pushes are known from the first row to the last"
    assert np.isfinite(run.inputs["push.F_rl"]).all()
    assert run.steps["push.F_rl"] == pytest.approx(1 / 240, rel=1e-3)
    assert [(c.device, c.sd, set(c.channels)) for c in run.clocks] == [("imu", 0.002, {"yaw_rate", "a_x"})]


def test_an_offset_is_less_sure_at_a_clock_s_own_zero_where_nobody_knows_its_rate(lab):
    """The middle of a file of 5 s is 2.5 s from there; two crystals differ by 50 µs in a second (ppm: 50)."""
    assert [c.at_zero for c in read(lab).runs[0].clocks] == [pytest.approx(50e-6 * 2.5, rel=0.01)]
    edited(lab, "sd = 0.002", "sd = 0.002, drift = 3e-5")
    assert [c.at_zero for c in read(lab).runs[0].clocks] == [0.0]


def test_markers_on_the_axle_say_nothing_of_the_centre_of_mass(lab):
    """How far it is before them is estimated: readings that held what was given would vouch for it."""
    campaigns = [read(lab)]
    edited(lab, "b = 0.1", "b = 0.13")
    campaigns.append(read(lab))
    for campaign in campaigns:
        (run,) = campaign.runs
        there = np.isfinite(run.channels["x"])
        axle = moved(run.time[there])["cm"] - 0.1 * np.stack([part(moved(run.time[there])["yaw"]) for part in (np.cos, np.sin)])
        for channel, true in zip("xy", axle, strict=True):
            np.testing.assert_allclose(run.channels[channel][there], true, atol=0.003)
        assert campaign.known["effect.marker_offset.from_axle"] == 1.0 and "marker_offset" in campaign.effects


def test_each_channel_may_be_read_at_a_point_of_its_own(lab):
    """What is said of a channel holds before what is said of its device; the rest of a group is where the first is."""
    text = (lab / "campaign.toml").read_text(encoding="utf-8")
    at = "[sensor]\nx = { at = [-0.2, 0.1] }\nu = { at = [0.3, 0.0] }\na_y = { at = [0.2, 0.04] }\n"
    (lab / "campaign.toml").write_text(text.replace("[[recording]]", at + "\n[[recording]]", 1), encoding="utf-8")
    known = {n: v for n, v in read(lab).known.items() if "_offset." in n and n != "effect.marker_offset.from_axle"}
    assert known == pytest.approx(
        {
            "effect.marker_offset.x": -0.2,
            "effect.marker_offset.y": 0.1,
            "effect.marker_offset.u_ahead": 0.5,
            "effect.marker_offset.u_right": -0.1,
            "effect.accelerometer_offset.x": 0.11,
            "effect.accelerometer_offset.y": 0.04,
            "effect.accelerometer_offset.a_y_ahead": 0.09,
            "effect.accelerometer_offset.a_y_right": 0.0,
        }
    )


def test_units_signs_axes_and_radius_are_each_devices_own(lab):
    campaign = read(lab)
    (run,) = campaign.runs
    there = np.isfinite(run.channels["a_x"])
    assert np.mean(run.channels["a_x"][there]) == pytest.approx(0.01 * 9.80665 * np.mean(moved(run.time)["push"]), rel=0.05)
    assert np.mean(run.inputs["push.F_rl"]) == pytest.approx(np.mean(moved(run.time)["push"]), rel=0.02)
    assert campaign.known["effect.accelerometer_offset.x"] == 0.11
    assert campaign.known["effect.accelerometer_offset.y"] == 0.04


def test_a_wheels_speed_is_made_from_its_angle(lab):
    campaign = read(lab)
    speed = campaign.runs[0].channels["wheel_speed_l"]
    there = np.isfinite(speed)
    np.testing.assert_allclose(speed[there], 1.0, atol=0.02)
    assert there.sum() == pytest.approx(5 / 0.05, rel=0.1)


def test_the_noise_of_a_speed_made_from_an_angle_is_known():
    rng, time = np.random.default_rng(1), np.arange(0, 100, 1 / 240)
    speed, sd = wheel_speed(time, time / 0.3 + rng.normal(0, 1e-3, len(time)), 0.3)
    assert np.nanstd(speed) == pytest.approx(sd, rel=0.1)
    assert np.nanmean(speed) == pytest.approx(1, abs=1e-3)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('device = "imu"\n', 'device = "gyro"\n', "run 1: no device 'imu'; did you mean 'rims'?"),
        ('device = "imu"\n', 'device = "rims"\n', "recording 2 describes the device 'rims' again, as recording 1 does"),
        ('device = "imu"\n', "", 'recording 2 has no device; add device = "..."'),
        ('imu = "one_imu.csv"', 'imu = "imu.csv"', "run 1: no such file as 'imu.csv' of imu; did you mean 'one_imu.csv' or"),
        ("at = [0.11, 0.04]", "at = 0.11", "recording 2 (imu) has at = 0.11, which is no point; give two numbers, [x, y] in m"),
        (
            "at = [0.11, 0.04]",
            "at = [110, 40]",
            "recording 2 (imu): at = [110, 40] is more than 1.2 m from the centre of mass, off any chair; write it in m",
        ),
        ("cameras = -0.2 }", "camera = -0.2 }", "run 1: clocks has 'camera', of which it has no file; did you mean 'cameras'?"),
        (
            "sd = 0.002",
            "drift = 40",
            "run 1: the clock of imu has drift = 40, but no clock gains so much; give it in s per s: 40e-6 for 40 parts per m",
        ),
        ("sd = 0.002", "drift = true", "run 1: the clock of imu has drift = True; give a number"),
        ("sd = 0.002", "sdev = 0.002", "run 1: the clock of imu has no key 'sdev'; did you mean 'sd'?"),
        ("sign = -1", "sign = 2", "[columns] a_x: sign = 2; give 1 or -1"),
        ('"LHUB"', '"LHIP"', "no column 'LHIP.z' (nor 'LHIP_z') for the marker axle_l"),
        (
            "offset = 0.3",
            "offset = 30",
            "imu recorded from 30 to 34.99 s, the pushes from 0 to 4.996 s: they have no time in common",
        ),
        ("columns.a_x", 'columns.wheel_speed_l = "acc"\ncolumns.a_x', "wheel_speed_l comes from rims and imu"),
        ('[[recording]]\ndevice = "cameras"', '[recordings]\n[[recording]]\ndevice = "cameras"', "no table 'recordings'"),
    ],
)
def test_faults(lab, old, new, expected):
    found = edited(lab, old, new)
    assert any(expected in fault for fault in found), found


@pytest.mark.parametrize("drift", [-3, 40])
def test_a_drift_that_no_clock_has_is_one_fault(lab, drift):
    """It is left out, so that the device is not also said to have recorded at another time."""
    edited(lab, "sd = 0.002", f"drift = {drift}")
    said = [fault.fact for fault in check(lab) if fault.severity == "error"]
    assert said == [f"run 1: the clock of imu has drift = {drift}, but no clock gains so much"]


def test_of_a_devices_other_columns_only_a_misspelt_one_is_worth_a_word(lab):
    frame = pd.read_csv(lab / "one_imu.csv")
    frame.assign(**{"yawrate [deg/s]": 1.0, "a_y [g]": 0.0, "gyro x": 0.0}).to_csv(lab / "one_imu.csv", index=False)
    edited(lab, 'columns.yaw_rate = { column = "gyro z", unit = "deg/s" }\n', 'columns.a_y = ""\n')
    said = [str(fault) for fault in check(lab) if "is not used" in fault.fact]
    assert said == [
        "warning: run one_imu.csv line 1 column 'yawrate [deg/s]': it looks like yaw_rate, but is not used; "
        "correct the header, or name it in [columns]"
    ]


def test_markers_without_a_unit_are_not_taken_as_metres(lab):
    file = lab / "one_markers.csv"
    file.write_text(file.read_text(encoding="utf-8").replace("LHUB.z [mm]", "LHUB.z"), encoding="utf-8")
    assert [str(fault) for fault in check(lab) if fault.severity == "error"] == [
        "run one_markers.csv line 1 column 'LHUB.z': the marker axle_l is read from it, but it gives no unit; "
        "write the header as 'LHUB.z [mm]', or with the unit it has"
    ]


def test_markers_may_have_their_axes_behind_an_underline(lab):
    before = read(lab).runs[0].channels
    file = lab / "one_markers.csv"
    head, rest = file.read_text(encoding="utf-8").split("\n", 1)
    file.write_text(re.sub(r"\.([xyz])", lambda axis: f"_{axis[1].upper()}", head) + "\n" + rest, encoding="utf-8")
    for name, series in read(lab).runs[0].channels.items():
        np.testing.assert_array_equal(series, before[name])


def test_two_devices_that_see_the_same_are_told_apart(lab):
    """One of them is silenced by an empty header."""
    found = edited(lab, "columns.a_x", 'columns.wheel_speed_l = { column = "acc", unit = "m/s" }\ncolumns.a_x')
    assert sum("comes from" in fault for fault in found) == 1
