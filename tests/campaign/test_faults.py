"""Every fault, its words, and all of them at once."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.campaign import check, read
from wheelchair_fmu.errors import CampaignError
from wheelchair_fmu.inference.subject import known_parameters

from .small import HEAD, NOISE, RUNS, SI, csv_text, motion, rows

IN_SI = "correct it; parameters are in SI units, angles in rad, pressures in bar"
KNOWN = {
    "chair.m": (1.0, 500.0),
    "chair.I_z": (0.0, 100.0),
    "tyre.C_lambda": (0.0, 1e6),
    "tyre.pressure": (0.5, 12.0),
    "wheel.R": (0.05, 1.0),
}


def lines(folder, **more):
    return [str(fault) for fault in check(folder, **more)]


def data_fault(campaign, change, separator=","):
    """The faults of a.csv after `change` has worked on its cells (headers in row 0)."""
    cells = [list(SI), *rows(motion())]
    change(cells)
    return lines(campaign(files={"a.csv": "\n".join(separator.join(row) for row in cells) + "\n"}))


def put(row, column, text):
    def change(cells):
        cells[row][column] = text

    return change


def put_twice(row, column, text):
    def change(cells):
        cells[row][column] = cells[row + 1][column] = text

    return change


# --- campaign.toml ---------------------------------------------------------------------------------------------------


def test_no_folder(tmp_path):
    assert lines(tmp_path / "none") == [f"{tmp_path}/none: no such folder or file; check the path"]


def test_no_campaign_toml(tmp_path):
    assert lines(tmp_path) == [f"{tmp_path}: no campaign.toml in this folder; write one that names the chair and the runs"]


def test_syntax_error(campaign):
    assert lines(campaign("[campaign]\nname = ]\n")) == [
        "campaign.toml line 2: not valid TOML at character 8: invalid value; correct this line"
    ]


def test_toml_not_utf8(campaign):
    folder = campaign()
    (folder / "campaign.toml").write_bytes(b'[campaign]\nname = "Rollst\xfchle"\n')
    assert lines(folder) == ["campaign.toml line 2: byte 25 (0xFC) is not UTF-8 text; save the file as UTF-8"]


TOML_FAULTS = [
    ("unknown table", lambda h, r: (h + "[tire]\nC = 1\n", r), "line 6: no table 'tire' in a campaign; did you mean 'tyre'?"),
    ("unknown key", lambda h, r: (h.replace("axes", "axis"), r), "line 3: no key 'axis' in [campaign]; did you mean 'axes'?"),
    (
        "unknown key of a run",
        lambda h, r: (h, r.replace("role", "rolle", 1)),
        "line 16: run 1 (a.csv) has no key 'rolle'; did you mean 'role'?",
    ),
    (
        "no role",
        lambda h, r: (h, r.replace("role", "rolle", 1)),
        """line 13: run 1 (a.csv) has no role; add role = "fit" or "holdout\"""",
    ),
    (
        "bad role",
        lambda h, r: (h, r.replace('"holdout"', '"test"')),
        """line 21: run 2 (b.csv) has the unknown role 'test'; use "fit" or "holdout\"""",
    ),
    (
        "no fit run",
        lambda h, r: (h, r.replace('"fit"', '"holdout"')),
        """no run has the role 'fit'; give role = "fit" to the runs to learn from""",
    ),
    (
        "missing file",
        lambda h, r: (h, r.replace("b.csv", "bb.csv")),
        "line 19: run 2 (bb.csv): no such file; did you mean 'b.csv' or 'a.csv'?",
    ),
    (
        "wrong type",
        lambda h, r: (h, r.replace("u0 = 1.0", 'u0 = "one"', 1)),
        "line 17: run 1 (a.csv) has u0 = 'one', which is no number; give a number",
    ),
    (
        "from after to",
        lambda h, r: (h, r + "from = 2.0\nto = 1.0\n"),
        "line 23: run 2 (b.csv) is cut from 2 to 1 s, which is no time; make from smaller than to",
    ),
    (
        "bad axes",
        lambda h, r: (h.replace("SAE-J670", "ISO8855"), r),
        """line 3: no axes 'ISO8855'; use "SAE-J670" (y right) or "ISO-8855" (y left)""",
    ),
    (
        "pressure of nothing",
        lambda h, r: (h + "[tyre]\npressure = 0\n", r),
        f"line 7: tyre.pressure = 0 is outside 0.5 to 12; {IN_SI}",
    ),
    (
        "parameter that is no number",
        lambda h, r: (h.replace("80.0", '"heavy"'), r),
        "line 5: chair.m = 'heavy' is not a finite number; give a number in SI units",
    ),
    (
        "unknown parameter",
        lambda h, r: (h + "mass = 80\n", r),
        "line 6: no parameter 'chair.mass'; did you mean 'chair.m' or 'chair.I_z'?",
    ),
    ("negative mass", lambda h, r: (h.replace("80.0", "-80.0"), r), f"line 5: chair.m = -80 is outside 1 to 500; {IN_SI}"),
    (
        "unknown set",
        lambda h, r: (h, r + 'set = { "chair.I_zz" = 3 }\n'),
        "line 23: run 2 (b.csv): no parameter 'chair.I_zz'; did you mean 'chair.I_z' or 'chair.m'?",
    ),
    (
        "impossible set",
        lambda h, r: (h, r + 'set = { "chair.m" = 900 }\n'),
        f"line 23: run 2 (b.csv): chair.m = 900 is outside 1 to 500; {IN_SI}",
    ),
    (
        "unknown prior",
        lambda h, r: (h + "[prior]\nchair.I = 0.1\n", r),
        "line 7: no parameter 'chair.I'; did you mean 'chair.I_z' or 'chair.m'?",
    ),
    (
        "prior not positive",
        lambda h, r: (h + "[prior]\nchair.m = 0\n", r),
        "line 7: the prior of chair.m is 0; give a standard deviation above 0 in the unit of the parameter",
    ),
    (
        "unknown constant",
        lambda h, r: (h, r + "constant = { F_l = 0.0 }\n"),
        "line 23: run 2 (b.csv): constant has no channel 'F_l'; did you mean 'F_rl' or 'M_rl' or 'F_rr'?",
    ),
    (
        "constant that is no number",
        lambda h, r: (h, r + "constant = { F_rl = true }\n"),
        "line 23: run 2 (b.csv): constant F_rl: True is not a number; write a number in N",
    ),
    (
        "unknown channel in columns",
        lambda h, r: (h + '[columns]\nyaw_rat = "z"\n', r),
        "line 7: [columns] has no channel 'yaw_rat'; did you mean 'yaw_rate' or 'yaw'?",
    ),
    (
        "renamed column that is not there",
        lambda h, r: (h + '[columns]\nu = "speed_l"\n', r),
        "line 7: no run has the column 'speed_l' that [columns] gives for u; did you mean 'wheel_speed_l [m/s]'?",
    ),
    (
        "a speed off the chair",
        lambda h, r: (h + "[sensor]\nu = { at = [-200, 0.0] }\n", r),
        "line 7: [sensor] u.at = [-200, 0.0] is more than 1.2 m from the centre of mass, off any chair; write it in m",
    ),
    (
        "a marker behind and beside the chair",
        lambda h, r: (h + "[sensor]\nx = { at = [-1.0, 0.9] }\n", r),
        "line 7: [sensor] x.at = [-1.0, 0.9] is more than 1.2 m from the centre of mass, off any chair; write it in m",
    ),
    (
        "radius not positive",
        lambda h, r: (h + '[columns]\nF_rl = { column = "F_rl [N]", radius = 0 }\n', r),
        "line 7: [columns] F_rl: radius = 0; give a radius above 0, in m",
    ),
    (
        "unknown format",
        lambda h, r: (h, r + 'format = "cvs"\n'),
        "line 23: run 2 (b.csv): no format 'cvs'; did you mean 'csv'?",
    ),
]


@pytest.mark.parametrize(("change", "line"), [case[1:] for case in TOML_FAULTS], ids=[case[0] for case in TOML_FAULTS])
def test_faults_of_campaign_toml(campaign, change, line):
    head, runs = change(HEAD, RUNS)
    noise = NOISE if head == HEAD or len(head.split("\n")) == len(HEAD.split("\n")) else ""
    found = [s for s in lines(campaign(head=head, noise=noise, runs=runs), known_parameters=KNOWN) if "warning" not in s]
    assert any(s in (f"campaign.toml {line}", f"campaign.toml: {line}") or s.endswith(": " + line) for s in found), found


def test_no_runs(campaign):
    assert lines(campaign(runs=""))[0] == (
        "campaign.toml: there are no runs; add a [[run]] with file, manoeuvre and role for each recording"
    )
    assert lines(campaign(runs='[run]\nfile = "a.csv"\n'))[0] == (
        "campaign.toml line 13: [run] is one table, but runs are a list; write [[run]] with two brackets"
    )


def test_warnings_of_campaign_toml(campaign):
    head, runs = HEAD.replace('axes = "SAE-J670"\n', ""), RUNS.replace("holdout", "fit").replace("u0 = 1.0\n", "", 1)
    found = lines(campaign(head=head, runs=runs))
    speed = read(campaign(head=head, runs=runs)).runs[0].u0
    assert speed == pytest.approx(1.0, abs=0.02)
    assert found == [
        'warning: campaign.toml line 1: no axes given, SAE-J670 assumed; write axes = "SAE-J670" (y right) or '
        '"ISO-8855" (y left) in [campaign]',
        "warning: campaign.toml: no run has the role 'holdout'; give role = \"holdout\" to a run, so that an effect "
        "can be proven on data it has not seen",
        f"warning: run a.csv: no u0, {speed:.3g} m/s is taken from the first measured speeds; "
        "write u0 in the run to say it yourself",
    ]


def test_held_out_samples_that_are_fitted_too(campaign):
    assert lines(campaign(runs=RUNS.replace("b.csv", "a.csv"))) == [
        "warning: campaign.toml line 18: run 2 (a.csv) is held out but shares samples with run 1, which is fitted; "
        "separate them by from and to"
    ]


CASTERS = {"start.caster_l": (-3.2, 3.2), "start.caster_r": (-3.2, 3.2)}


@pytest.mark.parametrize(
    ("said", "told"),
    [
        ("180", [f"campaign.toml line 18: run 1 (a.csv): start.caster_l = 180 is outside -3.2 to 3.2; {IN_SI}"]),
        (
            '"0.5 turn"',
            [
                "campaign.toml line 18: run 1 (a.csv): start.caster_l = '0.5 turn' is not a finite number; write it in rad: "
                "3.1416"
            ],
        ),
        (
            '"270 deg"',  # a caster that is turned by more than half a turn is turned the other way
            [
                "campaign.toml line 18: run 1 (a.csv): start.caster_l = '270 deg' is not a finite number; write it in rad: "
                "-1.5708"
            ],
        ),
        (
            '"1e400 deg"',
            [
                "campaign.toml line 18: run 1 (a.csv): start.caster_l = '1e400 deg' is not a finite number; give a number in "
                "SI units"
            ],
        ),
        (
            '"left"',
            ["campaign.toml line 18: run 1 (a.csv): start.caster_l = 'left' is not a finite number; give a number in SI units"],
        ),
        (
            "0.5",
            [
                "note: campaign.toml line 18: run 1 (a.csv): start.caster_l = 0.5 is 29°, as it is in rad; if a share of a "
                "turn is meant, write 3.1416"
            ],
        ),
        (
            "-0.25",
            [
                "note: campaign.toml line 18: run 1 (a.csv): start.caster_l = -0.25 is -14°, as it is in rad; if a share of a "
                "turn is meant, write -1.5708"
            ],
        ),
        (
            "0.67",
            [
                "note: campaign.toml line 18: run 1 (a.csv): start.caster_l = 0.67 is 38°, as it is in rad; if a share of a "
                "turn is meant, write -2.0944"
            ],
        ),
        (
            "1.0",
            [
                "note: campaign.toml line 18: run 1 (a.csv): start.caster_l = 1 is 57°, as it is in rad; if a share of a "
                "turn is meant, write 0.0000"
            ],
        ),
        (
            "-1.0",
            [
                "note: campaign.toml line 18: run 1 (a.csv): start.caster_l = -1 is -57°, as it is in rad; if a share of a "
                "turn is meant, write 0.0000"
            ],
        ),
        ("0.48", []),
        ("0.12", []),
    ],
)
def test_an_angle_of_a_caster_in_another_unit(campaign, said, told):
    """Half a turn and 0.5 rad are one number: what a share of a turn would be written as is said to be an angle in rad."""
    runs = RUNS.replace("u0 = 1.0\n", f"u0 = 1.0\nset = {{ start.caster_l = {said} }}\n", 1)
    assert lines(campaign(runs=runs), known_parameters=KNOWN | CASTERS) == told


@pytest.mark.parametrize("effect", ["marker_offset", "accelerometer_offset"])
def test_what_reads_is_on_the_chair(campaign, effect):
    """The effects of where instruments sit go as far as a chair is long, as their places in [sensor] do."""
    head = HEAD + f"[effect.{effect}]\nx = 1.8\n"
    (line,) = (said for said in lines(campaign(head=head), known_parameters=known_parameters()) if "warning" not in said)
    assert f"effect.{effect}.x = 1.8 is outside -1.2 to 1.2" in line


def test_a_run_has_no_tyre_law_of_its_own_and_a_law_is_a_whole_number(campaign):
    known = KNOWN | {"tyre.law": (1.0, 3.0)}
    runs = RUNS.replace("u0 = 1.0\n", "u0 = 1.0\nset = { tyre.law = 3 }\n", 1)
    (line,) = lines(campaign(runs=runs), known_parameters=known)
    assert "run 1 (a.csv): tyre.law is one for all runs; choose the law in a variant" in line
    (line,) = lines(campaign(head=HEAD + "[tyre]\nlaw = 2.5\n"), known_parameters=known)
    assert line.endswith("tyre.law = 2.5 is no law; give a whole number from 1 to 3")
    (line,) = lines(campaign(head=HEAD + "[tyre]\nlaw = 2\n"), known_parameters=known)
    assert "tyre.law = 2 of a campaign chooses no law; choose the law in a variant" in line and "warning" in line


def test_a_place_that_changes_nothing_is_said(campaign):
    """A gyro and a wheel's sensor read the same wherever they sit; an accelerometer does not."""
    said = lines(campaign(head=HEAD + "[sensor]\nyaw_rate = { at = [0.1, 0] }\na_x = { at = [0.1, 0] }\n"))
    (line,) = [s for s in said if "[sensor]" in s]
    assert line.endswith("[sensor] yaw_rate.at changes nothing: yaw_rate reads the same wherever it sits; leave it out")


# --- recordings ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("content", "line"),
    [
        (b"", "run a.csv: the file is empty; export it again, or leave it out"),
        (b"time [s],F_rl [N]\n", "run a.csv: the file has a header but no rows; export it again, or leave it out"),
        ("time [s]\n".encode("utf-16"), "run a.csv: the file has a header but no rows; export it again, or leave it out"),
        (bytes(range(256)), "run a.csv: the file is binary, of no kind that is known; export it as CSV, or name its format"),
    ],
)
def test_files_that_are_no_tables(campaign, content, line):
    assert lines(campaign(files={"a.csv": content})) == [line]


CELL_FAULTS = [
    (
        "text",
        put(5, 6, "n/a"),
        "run a.csv line 6 column 'a_y [m/s2]': 'n/a' is not a number; write a number, or leave the cell empty for a gap",
    ),
    (
        "infinite",
        put(5, 6, "-inf"),
        "run a.csv line 6 column 'a_y [m/s2]': the value is infinite; leave the cell empty where the sensor gave nothing",
    ),
    ("time goes back", put(100, 0, "0.95"), "run a.csv line 101: time goes back from 0.98 to 0.95 s; remove or sort the rows"),
    ("time twice", put(100, 0, "0.98"), "run a.csv line 101: time 0.98 s is there twice; remove one of the rows"),
    (
        "a row that was set back by less than a sample",
        put(100, 0, "0.979"),
        "note: run a.csv line 101: a row stands behind a later one, by 0.001 s, and is read in turn; nothing is to be done",
    ),
    ("time empty", put(100, 0, ""), "run a.csv line 101: the time is empty; fill it in, or remove the row"),
    (
        "unknown unit",
        put(0, 5, "yaw_rate [rad/sek]"),
        "run a.csv line 1 column 'yaw_rate [rad/sek]': unit 'rad/sek' is unknown; write it as, for example, rad/s or deg/s",
    ),
    (
        "wrong dimension",
        put(0, 1, "F_rl [kg]"),
        "run a.csv line 1 column 'F_rl [kg]': unit 'kg' measures a mass, but 'N' is needed, which measures a force; "
        "give a unit such as N or lbf",
    ),
    (
        "torque without a radius",
        put(0, 1, "F_rl [N.m]"),
        "run a.csv line 1 column 'F_rl [N.m]': F_rl is given in N.m, which needs the wheel's radius to become N; "
        "write [columns] F_rl = { column = ..., radius = ... } or [wheel] R, in m",
    ),
    (
        "duplicate header",
        put(0, 6, "yaw_rate [rad/s]"),
        "run a.csv line 1: the header 'yaw_rate [rad/s]' stands there 2 times; rename or remove all but one",
    ),
    (
        "ambiguous",
        put(0, 6, "yaw_rate [deg/s]"),
        "run a.csv line 1: yaw_rate could be 'yaw_rate [rad/s]' and 'yaw_rate [deg/s]'; "
        "remove one, or choose one by its whole header in [columns] yaw_rate",
    ),
    (
        "no time",
        put(0, 0, "moment [s]"),
        "run a.csv line 1: no time column among 'moment [s]', 'F_rl [N]', 'F_rr [N]', 'wheel_speed_l [m/s]', "
        "'wheel_speed_r [m/s]', 'yaw_rate [rad/s]', 'a_y [m/s2]'; "
        "name it 'time [s]', give its header in [columns] time, or write rate = ... in Hz",
    ),
    ("no push", put(0, 1, "left [N]"), "run a.csv line 1: no push force F_rl; name it in [columns], if it is 'left [N]'"),
    (
        "input gap at the end",
        put(200, 1, ""),
        "run a.csv line 201 column 'F_rl [N]': F_rl is missing at the end of the run; "
        "fill it in, or cut the run by from and to",
    ),
    (
        "row too long",
        lambda cells: cells[7].append("3"),
        "run a.csv line 8: 8 cells, but the header has 7; write one cell for each column",
    ),
    (
        "row too short",
        lambda cells: cells[7].pop(),
        "run a.csv line 8: 6 cells, but the header has 7; write one cell for each column",
    ),
    (
        "unused column",
        put(0, 6, "temperature [degC]"),
        "warning: run a.csv line 1: column 'temperature [degC]' not used; name them in [columns] if they measure something",
    ),
    (
        "misspelt column",
        put(0, 6, "ay [m/s2]"),
        "warning: run a.csv line 1 column 'ay [m/s2]': it looks like a_y, but is not used; "
        "correct the header, or name it in [columns]",
    ),
    (
        "no unit",
        put(0, 6, "a_y"),
        "warning: run a.csv line 1 column 'a_y': no unit given, m/s2 assumed; write the header as 'a_y [m/s2]'",
    ),
    (
        "implausible push",
        put(9, 2, "2500"),
        "warning: run a.csv line 10 column 'F_rr [N]': F_rr reaches 2500 N, above any plausible 2000 N; "
        "check its unit (is it lbf or N.m?)",
    ),
    (
        "implausible speed",
        put_twice(9, 3, "-16"),
        "warning: run a.csv line 10 column 'wheel_speed_l [m/s]': wheel_speed_l reaches -16 m/s, "
        "below any plausible -15 m/s; check its unit (is it km/h?)",
    ),
    (
        "implausible yaw rate",
        put_twice(9, 5, "57.3"),
        "warning: run a.csv line 10 column 'yaw_rate [rad/s]': yaw_rate reaches 57.3 rad/s, "
        "above any plausible 20 rad/s; check its unit (is it deg/s?)",
    ),
    (
        "a reading that stands alone",
        put(9, 3, "-16"),
        "warning: run a.csv line 10 column 'wheel_speed_l [m/s]': wheel_speed_l reads -16 m/s at 0.08 s, alone between "
        "readings that agree, and is left out there; check the sensor and its cable; no chair moves so",
    ),
]


@pytest.mark.parametrize(("change", "line"), [case[1:] for case in CELL_FAULTS], ids=[case[0] for case in CELL_FAULTS])
def test_faults_of_a_recording(campaign, change, line):
    found = data_fault(campaign, change)
    assert line in found
    assert len([s for s in found if not s.startswith("warning")]) <= 1


def test_a_clock_that_runs_backwards_is_said_once(campaign):
    def back(cells):
        cells[1:] = [[first[0], *row[1:]] for first, row in zip(cells[:0:-1], cells[1:], strict=True)]

    said = [line for line in data_fault(campaign, back) if "a.csv" in line and not line.startswith("warning")]
    assert said == ["run a.csv line 3: time runs backwards, from 1.99 to 0 s; sort the rows, the earliest first"]


def test_of_a_thousand_columns_without_a_time_some_are_named(campaign):
    cells = [[f"c{i} [N]" for i in range(1000)], *[["1.5"] * 1000] * 30]
    (said,) = [line for line in lines(campaign(files={"a.csv": csv_text(*cells[:1], cells[1:])})) if "no time column" in line]
    assert "'c9 [N]' and 990 more; name it" in said


def test_long_gap_of_an_input(campaign):
    def change(cells):
        for row in cells[21:41]:
            row[1] = ""

    assert data_fault(campaign, change) == [
        "run a.csv line 22 column 'F_rl [N]': F_rl is missing for 0.21 s, too long for a straight line; "
        "fill it in, or cut the run by from and to"
    ]


def test_stuck_and_empty_channels(campaign):
    def change(cells):
        for row in cells[1:]:
            row[5], row[6] = "", "0.25"

    folder_faults = data_fault(campaign, change)
    assert folder_faults == [
        "warning: run a.csv column 'yaw_rate [rad/s]': yaw_rate holds only gaps and is left out; remove the column",
        "warning: run a.csv column 'a_y [m/s2]': a_y never changes from 0.25 m/s2 and is left out; "
        "check the sensor, or remove the column",
    ]


def test_uneven_and_coarse_sampling(campaign):
    data = motion()
    coarse = data[::10].copy()
    found = lines(
        campaign(
            files={"a.csv": csv_text(SI, rows(np.delete(data, [50, 51, 52], axis=0))), "b.csv": csv_text(SI, rows(coarse))}
        )
    )
    assert found[:2] == [
        "warning: run a.csv line 52 column 'time [s]': 1 time step far from the usual 0.01 s; "
        "the largest is 0.04 s after 0.49 s; check the logger for lost samples",
        "warning: run b.csv line 1 column 'time [s]': one sample each 0.1 s is too coarse for the chair's yaw motion; "
        "log at 50 Hz or more; check the unit of time",
    ]


def test_cut_that_leaves_too_little(campaign):
    assert lines(campaign(runs=RUNS + "from = 1.95\n")) == [
        "run b.csv: the cut from 1.95 s leaves 5 samples, at least 10 are needed; widen it; the file runs from 0 to 1.99 s"
    ]


def test_start_speed_that_cannot_be(campaign):
    speed = read(campaign(runs=RUNS.replace("u0 = 1.0", "u0 = 3.6", 1))).warnings
    assert len(speed) == 1
    assert str(speed[0]).startswith("warning: run a.csv: u0 = 3.6 m/s, but the first measured speeds are 0.999 m/s")


def test_a_constant_over_a_column_is_said(campaign):
    assert lines(campaign(runs=RUNS + "constant = { F_rl = 0.0 }\n")) == [
        "warning: run b.csv line 1 column 'F_rl [N]': the constant F_rl = 0 replaces this column; remove one of them"
    ]


def test_radius_without_use_and_contradicting_units(campaign):
    head = HEAD + '[columns]\nF_rl = { column = "F_rl", radius = 0.3 }\nyaw_rate = "yaw_rate [deg/s]"\n'
    found = lines(campaign(head=head))
    assert (
        "warning: run a.csv line 1 column 'F_rl [N]': [columns] gives a radius, but 'N' needs none; "
        "remove the radius, or correct the unit"
    ) in found
    assert (
        "run a.csv line 1 column 'yaw_rate [rad/s]': [columns] yaw_rate says [deg/s], the file says [rad/s]; "
        "correct one of them, or settle it by unit = ..."
    ) in found


def test_a_flood_is_counted(campaign):
    def change(cells):
        for row in cells[1:]:
            row[6] = "x"

    found = data_fault(campaign, change)
    assert found[10] == (
        "run a.csv line 12 column 'a_y [m/s2]': 190 more cells like these; write a number, or leave the cell empty for a gap"
    )


def test_text_in_an_unused_column_is_nobodys_business(campaign):
    cells = [[*row, 'said "stop", then left' if i else "remark"] for i, row in enumerate([list(SI), *rows(motion())])]
    quoted = [[*row[:-1], '"' + row[-1].replace('"', '""') + '"'] for row in cells]
    found = lines(campaign(files={"a.csv": "\n".join(",".join(row) for row in quoted)}))
    assert found == ["warning: run a.csv line 1: column 'remark' not used; name them in [columns] if they measure something"]


def test_a_file_used_twice_reports_its_faults_once(campaign):
    cells = [list(SI), *rows(motion())]
    cells[30][6] = "x"
    runs = RUNS.replace("b.csv", "a.csv").replace("u0 = 1.0\n", "u0 = 1.0\nto = 1.0\n", 1) + "from = 1.0\n"
    assert len(lines(campaign(runs=runs, files={"a.csv": "\n".join(map(",".join, cells))}))) == 1


# --- together --------------------------------------------------------------------------------------------------------


def test_ten_faults_at_once_give_ten_lines(campaign):
    a, b = [list(SI), *rows(motion())], [list(SI), *rows(motion(seed=1))]
    a[10][6] = "abc"  # 1
    a[20][5] = "inf"  # 2
    a[100][0] = a[99][0]  # 3
    a[150][0] = "0.1"  # 4
    b[0][1] = "F_rl [m]"  # 5
    b[0][5] = "yaw_rate [rad/sek]"  # 6
    b[0][2] = "F_right [N]"  # 7
    head = HEAD.replace("m = 80.0", "m = -80.0\nI_x = 3.0")  # 8, 9
    runs = RUNS + '[[run]]\nfile = "c.csv"\nmanoeuvre = "x"\nrole = "fit"\n'  # 10
    folder = campaign(
        head=head, noise=NOISE, runs=runs, files={n: "\n".join(map(",".join, c)) for n, c in (("a.csv", a), ("b.csv", b))}
    )
    with pytest.raises(CampaignError) as caught:
        read(folder, KNOWN)
    assert str(caught.value).split("\n") == [
        f"campaign.toml line 5: chair.m = -80 is outside 1 to 500; {IN_SI}",
        "campaign.toml line 6: no parameter 'chair.I_x'; did you mean 'chair.I_z' or 'chair.m'?",
        "campaign.toml line 25: run 3 (c.csv): no such file; did you mean 'b.csv' or 'a.csv'?",
        "run a.csv line 11 column 'a_y [m/s2]': 'abc' is not a number; write a number, or leave the cell empty for a gap",
        "run a.csv line 21 column 'yaw_rate [rad/s]': the value is infinite; "
        "leave the cell empty where the sensor gave nothing",
        "run a.csv line 101: time 0.98 s is there twice; remove one of the rows",
        "run a.csv line 151: time goes back from 1.48 to 0.1 s; remove or sort the rows",
        "run b.csv line 1 column 'yaw_rate [rad/sek]': unit 'rad/sek' is unknown; write it as, for example, rad/s or deg/s",
        "run b.csv line 1 column 'F_rl [m]': unit 'm' measures a length, but 'N' is needed, which measures a force; "
        "give a unit such as N or lbf",
        "run b.csv line 1: no push force F_rr; name it in [columns], if it is 'F_right [N]'",
    ]
    assert len(caught.value.faults) == 10


@pytest.mark.parametrize("seed", range(40))
def test_no_damage_causes_anything_but_faults(campaign, seed):
    """Random bytes anywhere: read gives a campaign or CampaignError, whatever they are."""
    rng = np.random.default_rng(seed)
    folder = campaign()
    for name in ("a.csv", "campaign.toml") if seed % 2 else ("a.csv",):
        raw = bytearray((folder / name).read_bytes())
        alphabet = b'",;\n\r\t[]{}=.-+eE019xNaF_ \x00\xff#'
        for _ in range(rng.integers(1, 12)):
            raw[rng.integers(len(raw) if seed % 3 else 120)] = alphabet[rng.integers(len(alphabet))]
        (folder / name).write_bytes(bytes(raw))
    faults = check(folder)
    assert all("\n" not in str(fault) for fault in faults)
    if any(fault.severity == "error" for fault in faults):
        with pytest.raises(CampaignError):
            read(folder)
    else:
        read(folder)


def test_rows_that_a_logger_sent_twice_are_left_out_and_said(campaign):
    def twice(cells):
        cells[30:30] = [list(cells[29]), list(cells[29])]

    once = data_fault(campaign, lambda cells: None)
    assert sorted(set(data_fault(campaign, twice)) - set(once)) == [
        "note: run a.csv line 31: 2 rows are copies of the one before, with its time, and left out; nothing is to be done"
    ]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("m = 80.0", "m = 80,0", "line 5: 80,0 has a decimal comma; write 80.0"),
        ("m = 80.0", "m = 80,0  # kg", "line 5: 80,0 has a decimal comma; write 80.0"),
        ("m = 80.0", "m = 80.0\nm = 81.0", "line 6: m of [chair] is there twice, first in line 5; remove one of them"),
        (
            "m = 80.0",
            "m = 80.0\n[chair]\na = 0.2",
            "line 6: the table [chair] is there twice, first in line 4; put both into one",
        ),
        ('name = "small"', "name = small", 'line 2: the text small has no quotes; write "small"'),
        ("m = 80.0", "m = 80.0\n[nuisance]\na_y = True", "line 7: True is no value of TOML; write true"),
    ],
)
def test_slips_of_syntax_are_said_in_plain_words(campaign, old, new, said):
    assert lines(campaign((HEAD + NOISE + RUNS).replace(old, new, 1))) == [f"campaign.toml {said}"]


def test_a_key_of_another_run_is_not_there_twice(campaign):
    text = (HEAD + NOISE + RUNS).replace('role = "holdout"', 'role = "holdout"\nrole = "fit"')
    (said,) = lines(campaign(text))
    assert "role of [run] is there twice, first in line 2" in said and said.endswith("remove one of them")
