"""What different loggers write of one campaign reads back as that campaign."""

from __future__ import annotations

import shutil
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from wheelchair_fmu.campaign import check, read
from wheelchair_fmu.campaign.angles import cleaned, glitches, unwrapped, wheel_speed
from wheelchair_fmu.campaign.formats import open_recording
from wheelchair_fmu.campaign.formats.mdf import FORMAT

from . import loggers

SAMPLE = Path(__file__).resolve().parents[2] / "examples" / "sample-campaign"
NEEDS = {"a.xlsx": "openpyxl", "a.ods": "odf", "v73.mat": "h5py", "a.mf4": "asammdf"}


@pytest.fixture(scope="module")
def frame():
    return pd.read_csv(SAMPLE / "runs" / "slalom-quick.csv").iloc[:600]


def whole(table):
    rows = table.rows([i for i, header in enumerate(table.headers) if header != "Bemerkung"])
    assert rows.faults == ()
    return rows.values


@pytest.mark.parametrize("name", loggers.WRITERS)
def test_each_logger_reads_back_with_its_units(name, frame, tmp_path):
    if name in NEEDS:
        pytest.importorskip(NEEDS[name])
    loggers.WRITERS[name](tmp_path / name, frame)
    table, faults = open_recording(tmp_path / name, name, {})
    assert faults == []
    values = whole(table)
    assert table.units[table.time] == (None if name == "v5.mat" else "s")
    np.testing.assert_allclose(values[table.time], frame.iloc[:, 0], atol=2e-6)
    for header, wanted in list(zip(frame.columns, frame.to_numpy().T, strict=True))[1:]:
        own, unit = header.split(" [")
        i = next(k for k, h in enumerate(table.headers) if own in h)
        assert table.units[i] == unit[:-1]
        np.testing.assert_allclose(values[i], wanted, rtol=1e-9, err_msg=header)


def test_the_sample_campaign_by_nine_loggers(tmp_path):
    """Every run in another format; what the campaign says of its columns is as before."""
    shutil.copytree(SAMPLE, tmp_path / "c")
    text = (SAMPLE / "campaign.toml").read_text()
    usable = [name for name in loggers.WRITERS if name not in ("a.mf4", "v5.mat")]
    runs = sorted((tmp_path / "c" / "runs").glob("*.csv"))
    for file, name in zip(runs, usable, strict=False):
        new = file.with_name(f"{file.stem}-{name}")
        loggers.WRITERS[name](new, pd.read_csv(file))
        text = text.replace(f"runs/{file.name}", f"runs/{new.name}")
        file.unlink()
    head = "[columns]\n" + "".join(
        f'{n} = "rec.{n}"\n' for n in ("time", "F_rl", "F_rr", "wheel_speed_l", "wheel_speed_r", "yaw_rate", "a_x", "a_y")
    )
    (tmp_path / "c" / "campaign.toml").write_text(text + head)
    new, old = read(tmp_path / "c"), read(SAMPLE)
    assert [f for f in check(tmp_path / "c") if f.severity == "error"] == []
    assert len({run.file.suffix for run in new.runs}) >= 6
    for was, run in zip(old.runs, new.runs, strict=True):
        np.testing.assert_allclose(run.time, was.time, atol=2e-6)
        for name in (*was.channels, *was.inputs):
            np.testing.assert_allclose({**run.channels, **run.inputs}[name], {**was.channels, **was.inputs}[name], rtol=1e-8)


def test_absolute_starts_relate_two_devices(frame, tmp_path):
    loggers.iso(tmp_path / "a.csv", frame)
    loggers.parquet(tmp_path / "a.parquet", frame)
    first, second = (open_recording(tmp_path / n, n, {})[0] for n in ("a.csv", "a.parquet"))
    assert first.started == datetime(2026, 11, 23, 13, 5, 7, 125000, tzinfo=UTC)
    assert second.started == datetime(2026, 11, 23, 14, 5, 7, 125000)


def test_notes_say_what_was_found(frame, tmp_path):
    loggers.german(tmp_path / "g.csv", frame)
    assert open_recording(tmp_path / "g.csv", "g.csv", {})[0].notes == (
        "encoding cp1252",
        "separator ';'",
        "decimal comma",
        "2 lines before the header skipped",
        "a row of units below the header",
    )


MARKERS = {"RHUB": np.arange(90.0).reshape(30, 3), "LHUB": np.arange(90.0).reshape(30, 3) * 2}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda text: text.replace("mm", ""), "line 5: the header names no units"),
        (lambda text: text.replace("\n150\n", "\n0\n", 1), "line 2: the header names no rate"),
        (lambda text: text.replace("P1:RHUB", "P1:LHUB"), "line 3: the marker P1:LHUB stands there 2 times"),
        (lambda text: text.replace("\n7,0,", "\n7,0,-", 1).replace("\n7,0,-", "\n7,0,-,", 1), "line 12: '-' is not a number"),
        (lambda text: text[: text.index("\n1,0,")] + "\n", "the file has a header but no frames"),
    ],
)
def test_what_is_odd_about_a_vicon_file_is_one_sentence(change, words, tmp_path):
    loggers.vicon(tmp_path / "m.csv", 150.0, MARKERS)
    text = (tmp_path / "m.csv").read_text()
    assert change(text) != text
    (tmp_path / "m.csv").write_text(change(text))
    table, (fault,) = open_recording(tmp_path / "m.csv", "m.csv", {})
    assert table is None and words in str(fault)


def test_vicons_frames_are_times_by_its_rate(tmp_path):
    markers = {name: series.copy() for name, series in MARKERS.items()}
    markers["LHUB"][5:8] = np.nan
    loggers.vicon(tmp_path / "m.csv", 150.0, markers)
    table, faults = open_recording(tmp_path / "m.csv", "m.csv", {})
    assert faults == [] and table.headers[:2] == ("time [s]", "P1:RHUB.x [mm]")
    values = whole(table)
    np.testing.assert_allclose(values[0], np.arange(30) / 150, atol=1e-12)
    np.testing.assert_allclose(values[6], markers["LHUB"][:, 2], atol=1e-3)
    assert "2 markers at 150 Hz" in table.notes and "hidden at times: P1:LHUB" in table.notes


@pytest.mark.parametrize("kind", ["trc", "c3d"])
def test_markers_and_hidden_ones(kind, tmp_path):
    if kind == "c3d":
        pytest.importorskip("ezc3d")
    markers = {name: series.copy() for name, series in MARKERS.items()}
    markers["LHUB"][5:8] = np.nan
    getattr(loggers, kind)(tmp_path / f"m.{kind}", 150.0, markers)
    table, faults = open_recording(tmp_path / f"m.{kind}", f"m.{kind}", {})
    assert faults == [] and table.time == 0
    assert table.headers[:3] == ("time [s]", "RHUB.x [mm]", "RHUB.y [mm]") and table.units[4] == "mm"
    values = whole(table)
    np.testing.assert_allclose(values[0], np.arange(30) / 150, atol=5e-5)
    np.testing.assert_allclose(values[6], markers["LHUB"][:, 2], atol=1e-3)
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(values[4])), [5, 6, 7])


def test_a_c3d_whose_rate_is_not_a_whole_number(tmp_path):
    pytest.importorskip("ezc3d")
    loggers.c3d(tmp_path / "m.c3d", 119.88, MARKERS)
    table, _ = open_recording(tmp_path / "m.c3d", "m.c3d", {})
    assert whole(table)[0][-1] == pytest.approx(29 / 119.88, rel=1e-6)


def test_push_rims_have_units_by_definition(tmp_path):
    moment, angle = np.linspace(0, 8, 300), np.linspace(0, 700, 300) % 360
    loggers.optipush(tmp_path / "o.txt", moment, angle)
    loggers.smartwheel(tmp_path / "s.csv", moment, angle)
    table, faults = open_recording(tmp_path / "o.txt", "o.txt", {})
    assert faults == []
    units = dict(zip(table.headers, table.units, strict=True))
    assert (units["Time(s)"], units["Tz"], units["Fx"], units["Angle"]) == ("s", "N.m", "N", "deg")
    np.testing.assert_allclose(whole(table)[table.headers.index("Tz")], moment, atol=1e-5)
    table, faults = open_recording(tmp_path / "s.csv", "s.csv", {})
    assert faults == []
    assert table.headers == (
        "time [s]",
        "counter",
        "angle [deg]",
        "Fx [N]",
        "Fy [N]",
        "Fz [N]",
        "Mx [N.m]",
        "My [N.m]",
        "Mz [N.m]",
    )
    np.testing.assert_allclose(whole(table)[8], moment, atol=1e-4)
    assert whole(table)[0][-1] == pytest.approx(299 / 240)


def test_imu_exports(tmp_path):
    (tmp_path / "n.csv").write_text(
        "Time (s),Gyroscope X (deg/s),Accelerometer X (g)\n" + "".join(f"{i / 100},1.5,0.1\n" for i in range(20))
    )
    (tmp_path / "x.txt").write_text(
        "// Start Time: Unknown\n// Update Rate: 100.0Hz\n"
        "PacketCounter\tSampleTimeFine\tAcc_X\tGyr_X\n"
        + "".join(f"{(65530 + i) % 65536}\t\t9.8\t0.5\n" for i in range(20) if i != 3)
    )
    (tmp_path / "d.csv").write_text(
        "sep=,\nDeviceTag:,left\nPacketCounter,SampleTimeFine,Euler_X,Acc_X,Gyr_X\n"
        + "".join(f"{i},{(2**32 - 50000 + i * 16667) % 2**32},1.5,9.8,30.5\n" for i in range(20))
    )
    tables = {}
    for name in ("n.csv", "x.txt", "d.csv"):
        tables[name], faults = open_recording(tmp_path / name, name, {})
        assert faults == [], name
    units = {name: dict(zip(t.headers, t.units, strict=True)) for name, t in tables.items()}
    assert units["n.csv"]["Gyroscope X (deg/s)"] == "deg/s" and tables["n.csv"].time == 0
    assert (units["x.txt"]["Gyr_X"], units["d.csv"]["Gyr_X"], units["d.csv"]["Acc_X"]) == ("rad/s", "deg/s", "m/s2")
    time = whole(tables["x.txt"])[tables["x.txt"].time]
    np.testing.assert_allclose(time, np.delete(np.arange(20), 3) / 100, atol=1e-12)
    np.testing.assert_allclose(whole(tables["d.csv"])[tables["d.csv"].time], np.arange(20) * 16667e-6, atol=1e-9)


def test_wheel_speed_from_a_wrapped_angle_with_a_glitch_at_its_index():
    time, rng = np.arange(0, 10, 1 / 240), np.random.default_rng(3)
    speed = 1.0 + 0.3 * np.sin(2 * time)
    way = np.concatenate([[0], np.cumsum((speed[1:] + speed[:-1]) / 2 / 240)])
    angle = np.round(np.degrees(way / 0.3) % 360 / 0.044) * 0.044
    at = np.flatnonzero(np.diff(angle) < -180) + 1
    angle[at] = rng.uniform(50, 310, at.size)
    assert glitches(angle, 360.0).tolist() == at.tolist() and at.size >= 4
    clean, bad = cleaned(angle, 360.0)
    assert bad.tolist() == at.tolist()
    found, sd = wheel_speed(time, np.radians(clean), 0.3)
    error = (found - speed)[np.isfinite(found)]
    assert error.std() == pytest.approx(sd, rel=0.2) and len(error) > 150
    signed = (angle + 180) % 360 - 180
    np.testing.assert_allclose(
        np.diff(unwrapped(np.delete(signed, at), 360.0)), np.diff(unwrapped(np.delete(angle, at), 360.0)), atol=1e-9
    )


def test_channels_of_two_rates_are_not_interpolated(tmp_path):
    """An MDF file with pushes at 100 Hz and a gyro at 40 Hz: each has the readings it was written with, and gaps between."""
    asammdf = pytest.importorskip("asammdf")
    quick, slow = np.arange(200) / 100, np.arange(80) / 40 + 0.0013
    with asammdf.MDF() as mdf:
        mdf.append([asammdf.Signal(np.sin(quick), quick, name="F_rl", unit="N")])
        mdf.append([asammdf.Signal(np.cos(slow), slow, name="yaw_rate", unit="rad/s")])
        mdf.save(tmp_path / "two.mf4", overwrite=True)
    table, faults = FORMAT.read(tmp_path / "two.mf4", "two.mf4", {})
    assert not faults
    time, push, rate = (
        np.array(table.frame.iloc[:, table.headers.index(name)], float) for name in ("time [s]", *table.headers[1:])
    )
    np.testing.assert_allclose(time[np.isfinite(push)], quick, atol=1e-9)
    np.testing.assert_allclose(push[np.isfinite(push)], np.sin(quick))
    np.testing.assert_allclose(time[np.isfinite(rate)], slow, atol=1e-9)
    np.testing.assert_allclose(rate[np.isfinite(rate)], np.cos(slow))
