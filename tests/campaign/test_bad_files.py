"""One sentence for each file that cannot be read, and for what is odd about one that can."""

from __future__ import annotations

import gzip
import io
import json
import sqlite3
import zipfile
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from wheelchair_fmu.campaign import check
from wheelchair_fmu.campaign.formats import _registry, bundled, formats, open_recording

from . import loggers
from .small import HEAD, RUNS, SI, csv_text, motion, rows
from .test_loggers import SAMPLE

MEASUREMENTS = Path(__file__).resolve().parents[3] / "shared" / "measurements"
CSV = "time [s],a [g]\n" + "".join(f"{i / 100},{i % 7}.5\n" for i in range(40))


def said(path: Path, **options) -> list[str]:
    table, faults = open_recording(path, path.name, options)
    assert table is None or not any(f.severity == "error" for f in faults)
    return [str(fault) for fault in faults]


def zipped(name: str = "a.csv") -> bytes:
    target = io.BytesIO()
    with zipfile.ZipFile(target, "w") as archive:
        archive.writestr(name, CSV)
    return target.getvalue()


def test_a_file_whose_columns_are_parted_in_two_ways_is_said(tmp_path):
    first, rest = CSV.split("0.2,", 1)
    later = ("0.2," + rest).replace(",", ";").replace(".", ",") * 5
    (tmp_path / "a.csv").write_text(first + later, encoding="utf-8")
    assert said(tmp_path / "a.csv") == [
        "run a.csv line 22: columns are parted by ',' up to line 21, and by ';' from line 22 on; "
        "write all of the file in one way"
    ]


BINARIES = [
    ("a.csv", zipped(), "the file is a ZIP archive, not a recording; unpack it and name the file that it holds"),
    (
        "a.xls",
        b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1" + bytes(600),
        "the file is an OLE2 file, such as an old .xls workbook, not a recording; save it as .xlsx or CSV",
    ),
    ("a.csv", b"\x89PNG\r\n\x1a\n" + bytes(600), "the file is a PNG picture, not a recording; name the recording instead"),
    (
        "a.csv",
        b"\x89HDF\r\n\x1a\n" + bytes(600),
        'the file is an HDF5 file, not a recording; if MATLAB wrote it, write format = "mat"; else export it as CSV',
    ),
    (
        "a.csv",
        gzip.compress(CSV.encode()),
        "the file is compressed by gzip, not a recording; let its name end in .gz, as in run.csv.gz",
    ),
    ("a.dat", b"%PDF-1.7\n" + bytes(600), "the file is a PDF document, not a recording; export the numbers as CSV"),
    ("a.csv", bytes(range(256)) * 4, "the file is binary, of no kind that is known; export it as CSV, or name its format"),
    ("a.csv", b"", "the file is empty; export it again, or leave it out"),
    ("a.trc", b"", "the file is empty; export it again, or leave it out"),
    ("a.parquet", b"", "the file is empty; export it again, or leave it out"),
]


@pytest.mark.parametrize(("name", "content", "sentence"), BINARIES, ids=[f"{n}-{s[12:30]}" for n, _, s in BINARIES])
def test_a_binary_file_is_named_for_what_it_is(name, content, sentence, tmp_path):
    (tmp_path / name).write_bytes(content)
    assert said(tmp_path / name) == [f"run {name}: {sentence}"]


def test_an_sqlite_database(tmp_path):
    with sqlite3.connect(tmp_path / "a.csv") as base:
        base.execute("create table t (x)")
    assert said(tmp_path / "a.csv") == ["run a.csv: the file is an SQLite database, not a recording; export the table as CSV"]


@pytest.mark.parametrize("name", ["a.xlsx", "a.ods", "v5.mat", "v73.mat", "a.parquet", "m.c3d", "a.mf4"])
@pytest.mark.parametrize("share", [0.97, 0.5, 0.02])
def test_a_file_cut_short(name, share, tmp_path):
    needed = {"a.xlsx": "openpyxl", "a.ods": "odf", "v73.mat": "h5py", "a.mf4": "asammdf", "m.c3d": "ezc3d"}
    if name in needed:
        pytest.importorskip(needed[name])
    path = tmp_path / name
    if name == "m.c3d":
        loggers.c3d(path, 100.0, {"A": np.ones((50, 3))})
    else:
        loggers.WRITERS[name](path, pd.read_csv(SAMPLE / "runs" / "slalom-quick.csv").iloc[:50])
    path.write_bytes(path.read_bytes()[: int(share * path.stat().st_size)])
    found = said(path)
    assert len(found) <= 1 and all("\n" not in sentence for sentence in found)
    if name not in ("a.mf4", "m.c3d") or share < 0.1:
        assert len(found) == 1


def text(tmp_path, content, **options):
    (tmp_path / "a.csv").write_text(content, encoding="utf-8")
    return said(tmp_path / "a.csv", **options)


def test_headers_that_contradict(tmp_path):
    found = text(tmp_path, "time [s];v [m/s]\ns;km/h\n0;1\n1;2\n2;3\n")
    assert found == [
        "run a.csv line 2 column 'v [m/s]': the header says [m/s], the row of units below it says 'km/h'; correct one of them"
    ]
    assert text(tmp_path, "time [s];M [Nm]\ns;N m\n0;1\n1;2\n2;3\n") == []


def test_separators_of_thousands(tmp_path):
    assert text(tmp_path, "time [s];F [N]\n0,0;1.234,5\n0,1;1.230,5\n") == [
        "run a.csv line 2: '1.234,5' has a separator of thousands; export the numbers without one"
    ]
    table, _ = (
        open_recording(tmp_path / "a.csv", "a.csv", {})
        if text(tmp_path, "time [s];F [N]\n" + "".join(f"0,{i:03d};12,5\n" for i in range(30)) + "0,031;1.234\n") == []
        else (None, [])
    )
    assert str(table.rows([1]).faults[0]).startswith("run a.csv line 32 column 'F [N]': '1.234' is not a number")


def test_no_header_and_no_time(tmp_path, campaign):
    assert text(tmp_path, "0,1\n1,2\n2,3\n")[0].startswith(
        "run a.csv line 1: line 1 already holds numbers: there is no header above it"
    )
    folder = campaign(files={"a.csv": csv_text(["moment [s]", *SI[1:]], rows(motion()))})
    assert any("no time column among" in str(f) for f in check(folder))


def test_dates_that_may_be_read_in_two_ways(tmp_path):
    content = "time,F [N]\n" + "".join(f"03/04/2026 10:00:{i:02d},{i}.5\n" for i in range(20))
    assert text(tmp_path, content) == [
        "run a.csv line 2 column 'time': the date 03/04/2026 may have its day or its month first; "
        'write dates = "day first" or dates = "month first" in the run'
    ]
    for dates, month in (("day first", 4), ("month first", 3)):
        table, _ = open_recording(tmp_path / "a.csv", "a.csv", {"dates": dates})
        assert table.started.month == month
    evident = content.replace("03/04", "23/04")
    (tmp_path / "a.csv").write_text(evident)
    assert open_recording(tmp_path / "a.csv", "a.csv", {})[0].started.day == 23


TIMES = [
    ("time", 1.7e9, 1.0, "s since 1970"),
    ("timestamp", 1.7e12, 1e3, "ms since 1970"),
    ("t", 1.7e15, 1e6, "µs since 1970"),
    ("time", 1.7e18, 1e9, "ns since 1970"),
    ("Zeit", 46349.5, 1 / 86400, "days of a spreadsheet"),
]


@pytest.mark.parametrize(("name", "start", "scale", "note"), TIMES)
def test_counts_since_a_known_moment(name, start, scale, note, tmp_path):
    lines = [f"{start + i * scale:.12f},{i}.5" if scale < 1e6 else f"{int(start) + i * int(scale)},{i}.5" for i in range(50)]
    assert text(tmp_path, f"{name},F [N]\n" + "\n".join(lines)) == []
    table, _ = open_recording(tmp_path / "a.csv", "a.csv", {})
    np.testing.assert_allclose(table.rows([0]).values[0], np.arange(50), atol=2e-6)
    assert note in table.notes[-1] and table.started is not None and table.units[0] == "s"


def test_a_rate_makes_the_time(tmp_path):
    content = "Frame#,F [N]\n" + "".join(f"{i},{i}.5\n" for i in range(7, 40) if i != 20)
    assert text(tmp_path, content, rate=240) == []
    table, _ = open_recording(tmp_path / "a.csv", "a.csv", {"rate": 240})
    np.testing.assert_allclose(table.rows([table.time]).values[table.time], np.delete(np.arange(33), 13) / 240)
    assert "own" in text(tmp_path, CSV, rate=240)[0]


def test_a_column_of_ones_own_without_a_unit_is_never_guessed(campaign):
    data = motion()
    head = HEAD + '[columns]\nyaw_rate = "gyro"\n'
    content = csv_text([*SI[:5], "gyro", SI[6]], rows(data))
    files = dict.fromkeys(("a.csv", "b.csv"), content)
    found = [str(f) for f in check(campaign(head=head, files=files)) if f.severity == "error"]
    assert found[0] == (
        "run a.csv line 1 column 'gyro': the column that is yaw_rate gives no unit; "
        'write [columns] yaw_rate = { column = "gyro", unit = "rad/s" } with its unit'
    )
    head = HEAD + '[columns]\nyaw_rate = { column = "gyro", unit = "rad/s" }\n'
    assert [str(f) for f in check(campaign(head=head, files=files)) if f.severity == "error"] == []


def test_a_thousand_columns_and_duplicate_headers(tmp_path, campaign):
    wide = ",".join(["time [s]", *(f"c{i} [N]" for i in range(999))])
    content = wide + "\n" + "".join(",".join([f"{k / 100}", *["1.5"] * 999]) + "\n" for k in range(30))
    assert text(tmp_path, content) == []
    table, _ = open_recording(tmp_path / "a.csv", "a.csv", {})
    assert len(table.headers) == 1000 and table.rows([999]).values[999].tolist() == [1.5] * 30
    folder = campaign(files={"a.csv": csv_text([*SI[:6], SI[5]], rows(motion()))})
    assert sum("stands there 2 times" in str(f) for f in check(folder)) == 1


def test_comments_preambles_and_text_columns(tmp_path):
    lines = [f"key {i} = {i}" for i in range(300)] + [
        "# a remark",
        "time_ms\tname\tgyro_z_dps",
        *(f"{10 * i}\tleft\t{i}.25" for i in range(50)),
    ]
    lines.insert(330, "% paused here")
    assert text(tmp_path, "\n".join(lines)) == []
    table, _ = open_recording(tmp_path / "a.csv", "a.csv", {})
    assert (table.headers, table.units) == (("time_ms", "name", "gyro_z_dps"), ("ms", None, "deg/s"))
    read = table.rows([0, 2])
    assert read.faults == () and len(read.values[2]) == 50 and read.line(0) == 303 and read.line(49) == 353
    assert "301 lines before the header skipped" in table.notes[1] and "1 line of comment among the rows skipped" in table.notes


@pytest.mark.parametrize(
    ("options", "fact"),
    [
        ({"skip": -1}, "skip = -1 is no number of lines"),
        ({"skip": 0.5}, "skip = 0.5 is no number of lines"),
        ({"decimal": ";"}, "decimal = ';' is no decimal sign"),
        ({"separator": ""}, "separator = '' is no separator"),
        ({"separator": "tabs"}, "separator = 'tabs' is no separator"),
    ],
)
def test_how_a_file_is_written_may_not_be_said_anyhow(tmp_path, options, fact):
    (tmp_path / "a.csv").write_text(
        "time [s],speed [m/s]\n" + "".join(f"{i / 10},{i}.5\n" for i in range(30)), encoding="utf-8"
    )
    _, faults = open_recording(tmp_path / "a.csv", "a.csv", options)
    assert [f.fact for f in faults] == [fact] and "leave it out to have it found" in faults[0].cure


@pytest.mark.parametrize("options", [{"skip": "two"}, {"decimal": 5}, {"separator": 3}, {"encoding": True}])
def test_what_is_of_another_type_is_told_once_with_the_campaign_s_keys(campaign, options):
    (key, value), *_ = options.items()
    folder = campaign(runs=RUNS.replace("[[run]]\n", f"[[run]]\n{key} = {json.dumps(value)}\n", 1))
    assert [key in str(f) and "which is no" in str(f) for f in check(folder)] == [True]


def test_columns_between_spaces(tmp_path):
    assert text(tmp_path, "Time (s)   F_left (N)\n" + "".join(f"  {i / 10:.1f}   {i}.50\n" for i in range(30))) == []
    table, _ = open_recording(tmp_path / "a.csv", "a.csv", {})
    assert table.headers == ("Time (s)", "F_left (N)") and table.rows([1]).values[1][3] == 3.5


GROUPS = [
    ["", "Left wheel", "", "Right wheel", ""],
    ["Time", "Torque", "Speed", "Torque", "Speed"],
    ["s", "N m", "m/s", "N m", "m/s"],
]
APART = ("Time", "Left wheel.Torque", "Left wheel.Speed", "Right wheel.Torque", "Right wheel.Speed")


@pytest.mark.parametrize("kind", ["csv", "xlsx"])
def test_names_that_stand_twice_are_told_apart_by_the_groups_above(kind, tmp_path):
    numbers = [[i / 100, 1.5, 0.5 + i, 2.5, 0.7 + i] for i in range(30)]
    path = tmp_path / f"a.{kind}"
    if kind == "csv":
        lines = [["Subject", "P07"], *GROUPS, *numbers]
        path.write_text("\n".join(";".join(map(str, row)) for row in lines))
    else:
        pytest.importorskip("openpyxl")
        pd.DataFrame([*GROUPS, *numbers]).to_excel(path, header=False, index=False)
    table, faults = open_recording(path, path.name, {})
    assert faults == [] and table.headers == APART and table.units == ("s", "N m", "m/s", "N m", "m/s")
    assert table.rows([3]).values[3].tolist() == [2.5] * 30
    assert [note for note in table.notes if "told apart by the row above" in note]


def test_a_row_above_that_tells_no_names_apart_is_none_of_groups(tmp_path):
    assert text(tmp_path, "Subject;P07;\ntime [s];F [N];F [N]\n" + "".join(f"{i};1;2\n" for i in range(30))) == []
    table, _ = open_recording(tmp_path / "a.csv", "a.csv", {})
    assert table.headers == ("time [s]", "F [N]", "F [N]")


def marked(tmp_path, change):
    loggers.trc(tmp_path / "m.trc", 100.0, {"A": np.ones((20, 3)), "B": np.ones((20, 3))})
    lines = (tmp_path / "m.trc").read_text().split("\n")
    change(lines)
    (tmp_path / "m.trc").write_text("\n".join(lines))
    return said(tmp_path / "m.trc")


def test_markers_renamed(tmp_path):
    assert marked(tmp_path, lambda lines: lines.insert(12, lines[3].replace("B", "C"))) == [
        "run m.trc line 13: a second header begins here: a marker was renamed or added half-way; "
        "export each part as a file of its own"
    ]
    assert marked(tmp_path, lambda lines: lines.__setitem__(3, lines[3].replace("B", "A"))) == [
        "run m.trc line 4: the marker A stands there 2 times; rename one of them"
    ]


@pytest.mark.parametrize("kind", ["trc", "c3d"])
def test_a_marker_renamed_half_way(kind, tmp_path):
    if kind == "c3d":
        pytest.importorskip("ezc3d")
    path, way = tmp_path / f"m.{kind}", np.linspace([0.0, 300, 0], [900, 300, 100], 90)
    before, after, far = way.copy(), way.copy(), way + 400
    before[40:], after[:42], far[:42] = np.nan, np.nan, np.nan
    getattr(loggers, kind)(path, 100.0, {"RHUB": before, "LHUB": way + 560, "STERNUM": far, "RHUB_2": after})
    assert said(path) == [
        f"warning: run m.{kind}: RHUB ends at 0.39 s, where RHUB_2 begins: a marker renamed half-way; "
        "give both one name, or only the first part is read"
    ]
    after[:60] = np.nan
    getattr(loggers, kind)(path, 100.0, {"RHUB": before, "LHUB": way + 560, "RHUB_2": after[:, ::-1] * [1, 1, -1]})
    assert said(path) == [], "another one, elsewhere"


def sheets(tmp_path, **more):
    pytest.importorskip("openpyxl")
    frame = pd.DataFrame({"time [s]": np.arange(30) / 10, "F [N]": np.arange(30.0)})
    with pd.ExcelWriter(tmp_path / "a.xlsx", engine="openpyxl") as book:
        for name in more.get("names", ("one",)):
            frame.to_excel(book, sheet_name=name, index=False)
        if "merge" in more:
            book.sheets["one"].insert_rows(1)
            book.sheets["one"].merge_cells(more["merge"])
    return tmp_path / "a.xlsx"


def test_sheets(tmp_path):
    assert said(sheets(tmp_path, names=("one", "two"))) == [
        """run a.xlsx: the sheets 'one', 'two' have numbers; write sheet = "one" or another one in the run"""
    ]
    assert said(tmp_path / "a.xlsx", sheet="two") == []
    assert said(tmp_path / "a.xlsx", sheet="three") == ["run a.xlsx: there is no sheet 'three'; the sheets are 'one', 'two'"]
    assert said(sheets(tmp_path, merge="A1:B1")) == []  # a title
    assert said(sheets(tmp_path, merge="A5:A6")) == [
        "run a.xlsx line 5: merged cells in the header or among the rows; unmerge them in the spreadsheet"
    ]


def saved(tmp_path, **variables):
    import scipy.io

    scipy.io.savemat(tmp_path / "a.mat", variables)
    return tmp_path / "a.mat"


def test_structures(tmp_path):
    v = np.arange(30.0)
    table, faults = open_recording(saved(tmp_path, rec={"left": {"t_s": v, "M_Nm": v}, "fs": 100.0, "who": "A"}), "a.mat", {})
    assert (table.headers, table.units, faults) == (("rec.left.t_s", "rec.left.M_Nm"), ("s", "N.m"), [])
    assert said(saved(tmp_path, a={"b": {"c": {"d": {"e": v}}}})) == [
        "run a.mat: structures in structures in structures, deeper than 3 names: a.b.c.d.e; "
        'write variable = "..." in the run with a path that leads nearer'
    ]
    assert said(tmp_path / "a.mat", variable="a.b.c") == []
    assert said(tmp_path / "a.mat", variable="a.x") == ["run a.mat: there is no variable 'a.x'; the file has a.b.c"]
    assert said(saved(tmp_path, a={"time": v, "F": v}, b={"time": v[:20], "F": v[:20]}))[0].startswith(
        "run a.mat: several recordings of different length: a.time (30), b.time (20)"
    )
    table, _ = open_recording(
        saved(tmp_path, s=np.array([(1.0, 2.0), (2.0, 3.0), (3.0, 4.0)], dtype=[("time_s", "O"), ("F_N", "O")])), "a.mat", {}
    )
    assert table.headers == ("s.time_s", "s.F_N") and table.rows([1]).values[1].tolist() == [2.0, 3.0, 4.0]


def test_every_format_says_what_it_is():
    assert set(bundled()) >= {
        "csv",
        "parquet",
        "mdf",
        "smartwheel",
        "optipush",
        "trc",
        "c3d",
        "mat",
        "xlsx",
        "ods",
        "ngimu",
        "xsens",
        "movella",
    }
    for record in bundled().values():
        assert record.title and record.meaning.endswith(".")
        assert all(o.kind in ("text", "number") and o.meaning and o.default for o in record.options)


OWN = """
from wheelchair_fmu.campaign.formats import Format
from wheelchair_fmu.tables import read_csv

FORMAT = Format("mine", "Mine", (".mine",), "A format of my own.", (), None,
                lambda path, head: head.startswith(b"MINE"),
                lambda path, file, options: read_csv(file, path.read_bytes().partition(b"MINE\\n")[2]))
"""


def test_a_user_adds_a_format_and_a_broken_one_is_a_sentence(tmp_path, monkeypatch, campaign):
    own = tmp_path / "config" / "formats"
    own.mkdir(parents=True)
    (own / "mine.py").write_text(OWN)
    (own / "broken.py").write_text("import nothing_of_this_name\n")
    monkeypatch.setattr(_registry, "user_folder", lambda: own)
    formats.cache_clear()
    try:
        (tmp_path / "a.bin").write_text("MINE\n" + CSV)
        assert said(tmp_path / "a.bin") == []
        folder = campaign(runs=RUNS)
        assert [str(f) for f in check(folder)] == [
            f"warning: {own / 'broken.py'}: cannot be read as a format: "
            "ModuleNotFoundError: No module named 'nothing_of_this_name'; "
            "correct or remove it"
        ]
    finally:
        formats.cache_clear()


LAB = {
    "lab-00": {"run01.trc": ("RHUB.x [mm]", "mm"), "run01_SWL.csv": ("Mz [N.m]", "N.m")},
    "lab-01": {
        "run01_optipush_right.txt": ("Tz", "N.m"),
        "run01_smartwheel_left.csv": ("angle [deg]", "deg"),
        "run01_frame_sensors.csv": ("Gyroscope Z (deg/s)", "deg/s"),
        "run01_left_sensors.csv": ("Accelerometer X (g)", "g"),
    },
    "lab-02": {
        "m01.xlsx": ("v links [km/h]", "km/h"),
        "m01_Moment.csv": ("Antriebsmoment links [N·m]", "N·m"),
        "m01_imu.mat": ("rec.data.omega_z", None),
    },
}


@pytest.mark.parametrize("lab", LAB)
def test_raw_lab_folders(lab):
    folder = MEASUREMENTS / lab
    if not folder.exists():
        pytest.skip(f"{lab} is not there: the measurements are no part of the project")
    for path in sorted(p for p in folder.iterdir() if p.name != "README.md"):
        table, faults = open_recording(path, path.name, {})
        assert faults == [] and table.time is not None, path.name
        assert np.isfinite(table.rows([table.time]).values[table.time]).all(), path.name
        kind = path.name.replace(path.name[:3] if lab == "lab-02" else path.name[:5], "m01" if lab == "lab-02" else "run01")
        if kind in LAB[lab]:
            header, unit = LAB[lab][kind]
            assert table.units[table.headers.index(header)] == unit, path.name
