"""A heading that one file of a device spells otherwise, and a unit that one has otherwise: both are said with the file."""

from __future__ import annotations

import numpy as np
import pytest

from wheelchair_fmu.campaign import check, read
from wheelchair_fmu.campaign.spelling import alike, respelt

from .small import HEAD, NOISE, RUNS, SI, csv_text, motion, rows

FILES = ("a.csv", "b.csv", "c.csv", "d.csv")
RENAMED = HEAD + '[columns]\nF_rl = "Antriebskraft links [N]"\n'
GERMAN = [header.replace("F_rl", "Antriebskraft links") for header in SI]
SAID = NOISE.replace("F_rl = 0.4", 'F_rl = "0.4 N"')
EVERY = RUNS + "".join(
    f'[[run]]\nfile = "{file}"\nmanoeuvre = "slalom"\nrole = "fit"\nu0 = 1.0\n' for file in ("c.csv", "d.csv")
)


@pytest.fixture
def told(campaign):
    """What is said of four files with these headers, in the first of which one has been changed."""

    def said(old: str, new: str, headers=GERMAN, head: str = RENAMED, factor: float = 1.0) -> list[str]:
        files = {}
        for i, file in enumerate(FILES):
            data = motion(seed=i)
            data[:, 1] *= 1.0 if i else factor
            files[file] = csv_text([h.replace(old, new) if i == 0 else h for h in headers], rows(data))
        return [str(fault) for fault in check(campaign(head=head, noise=SAID, runs=EVERY, files=files))]

    return said


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("Antriebsmoment link [N·m]", "Antriebsmoment links [N·m]"),
        ("Antriebsmoment links [kN·m]", "Antriebsmoment links [N·m]"),
        ("antriebsmoment_links", "Antriebsmoment links [N·m]"),
        ("Gyroscpe X (deg/s)", "Gyroscope X (deg/s)"),
        ("Gyr X", "GyrX"),
        ("Zeti [s]", "Zeit [s]"),
    ],
)
def test_a_slip_in_spelling_is_the_same_heading(one, other):
    assert alike(one, other) and alike(other, one)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("Antriebsmoment links [N·m]", "Antriebsmoment rechts [N·m]"),
        ("Gyroscope X (deg/s)", "Gyroscope Y (deg/s)"),
        ("GyroscopeX", "GyroscopeY"),
        ("gyrx", "gyry"),
        ("F_rl [N]", "F_rr [N]"),
        ("wheelL_radps", "wheelR_radps"),
        ("LSHOULDER.x", "RSHOULDER.x"),
        ("channel 1", "channel 2"),
        ("channel 11", "channel 12"),
        ("", "%"),
    ],
)
def test_what_tells_columns_apart_is_no_slip(one, other):
    assert not alike(one, other) and not alike(other, one)


def test_each_heading_is_the_other_spelling_of_one_alone():
    assert respelt(["t", "speeed left", "sped left"], ["t", "speed left"]) == {"speeed left": "speed left"}
    assert respelt([f"channels {i} a" for i in range(30)], [f"channel {i} a" for i in range(30)]) == {}, "these are others"


def test_a_misspelt_heading_is_said_with_its_spelling_in_the_other_files(told):
    said = told("links", "link")
    cause = (
        "warning: run a.csv line 1 column 'Antriebskraft link [N]': it is called 'Antriebskraft links [N]' in 3 other files, "
        "and F_rl is not read from it; correct the header in this file"
    )
    assert said[0] == cause, "before what comes of it"
    assert any(line.startswith("run a.csv line 1: no push force F_rl; ") for line in said), "which stays an error"
    assert not any("no column for" in line for line in said), "one sentence for one cause"


def test_a_heading_of_other_words_alone_in_the_place_of_one_is_said(told):
    (cause,) = (line for line in told("Antriebskraft links", "Push") if "F_rl is not read" in line)
    assert "column 'Push [N]': it stands where 'Antriebskraft links [N]' stands in 3 other files" in cause


def test_a_column_that_a_file_lacks_is_said_as_before(campaign):
    short = [row[:1] + row[2:] for row in rows(motion())]
    files = {file: csv_text(GERMAN, rows(motion(seed=i))) for i, file in enumerate(FILES)}
    files["a.csv"] = csv_text(GERMAN[:1] + GERMAN[2:], short)
    said = [str(fault) for fault in check(campaign(head=RENAMED, runs=EVERY, files=files))]
    assert any("run a.csv line 1: no column for F_rl, which [columns] renames" in line for line in said)
    assert not any("it is called" in line or "it stands" in line for line in said)


@pytest.mark.parametrize(("headers", "head", "name"), [(GERMAN, RENAMED, "Antriebskraft links"), (SI, HEAD, "F_rl")])
def test_another_unit_in_one_file_is_read_as_it_says_and_said(told, tmp_path, headers, head, name):
    said = told(f"{name} [N]", f"{name} [kN]", headers, head, 1e-3)
    assert said == [
        f"warning: run a.csv line 1 column '{name} [kN]': it is in kN here and in N in 3 other files, and is read as each file "
        "says; correct the header in this file if its unit is wrong"
    ]
    runs = {run.name: run for run in read(tmp_path).runs}
    means = [np.mean(runs[file.removesuffix(".csv")].inputs["push.F_rl"]) for file in FILES]
    assert np.ptp(means) < 0.2 and min(means) > 1.0


def test_the_same_unit_written_otherwise_is_nothing_to_say(told):
    assert told("yaw_rate [rad/s]", "yaw_rate [rad / s]") == []


def test_a_unit_that_campaign_toml_settles_is_noted_where_one_file_has_another(told):
    said = told("links [N]", "links [kN]", head=HEAD + '[columns]\nF_rl = { column = "Antriebskraft links", unit = "N" }\n')
    assert said == [
        "note: run a.csv line 1 column 'Antriebskraft links [kN]': the file says [kN], and it is read in N, as [columns] says "
        "of F_rl; nothing is to be done"
    ]


def test_a_unit_that_no_file_has_stays_an_error(told):
    said = told("", "", head=HEAD + '[columns]\nF_rl = "Antriebskraft links [kN]"\n')
    wrong = [line for line in said if "[columns] F_rl says [kN], the file says [N]" in line]
    assert len(wrong) == len(FILES) and not any(line.startswith("warning") for line in wrong)
